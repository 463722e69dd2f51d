# SPDX-License-Identifier: GPL-2.0-or-later
"""Numbers that documents quote are those of the tables that programs of validation/ have made. A
row is a sentence with {} for each number, and the cells that the numbers are from."""

from usual import *
from dataclasses import dataclass

import studies
from masonry.run.presets import PROMISE


@dataclass(frozen=True)
class Cell:
    """A number of a table: the document below validation/ that has the table, the beginning of the
    row, the beginning of the head of the column, and which number of the cell."""

    path: str
    row: str
    column: str
    number: int = 0

    def value(self):
        found = [row[self.column] for name, row in rowsOf(self.path) if name.startswith(self.row)]
        if not found and isEmpty(self.path):
            pytest.skip(f"{self.path} is to be made by validation/remake.py")
        assert found, f"{self.path} has no row {self.row}"
        return numbersOf(found[0])[self.number]


class Row(dict):
    """Cells of a row by the heads of their columns; a column may be named by its beginning."""

    def __missing__(self, name):
        return self[next(head for head in self if head.startswith(name))]


def isEmpty(path):
    """Whether a document has marks with no table between them."""
    with open(os.path.join(studies.HERE, path), encoding="utf-8") as file:
        return re.search(r"(<!-- [\w./]+): begin -->\n\1: end -->", file.read())


def rowsOf(path):
    """Rows of all tables of a document below validation/, each with its beginning."""
    with open(os.path.join(studies.HERE, path), encoding="utf-8") as file:
        lines = [line.strip() for line in file]
    heads = None
    for line, after in zip(lines, [*lines[1:], ""]):
        cells = [cell.strip(" *`") for cell in line.strip("|").split("|")]
        if not line.startswith("|"):
            heads = None
        elif heads is None:
            heads = cells
        elif not set(line) <= set("|- "):
            yield " | ".join(cells), Row(zip(heads, cells))


def numbersOf(text):
    plain = text.replace("−", "-").replace(",", " ")
    return [float(n) for n in re.findall(r"(?<![\w.])[-+]?\d+\.?\d*(?:e[-+]\d+)?", plain)]


WALL = "wall_comp{}/README.md"
ALL, BRICKS, OPEN, RECORDS = (
    "README.md",
    "brick_walls/README.md",
    "open_tests/README.md",
    "records/README.md",
)
STONES = "stone_walls/table.md", "stone_walls/opened.md"
FIELDS, TRADE, HELD = "random_fields/README.md", "trade/README.md", "accuracy/README.md"
MODEL = "this model: peak"


RULES = MODEL, "EN 1998-3:2005: peak", "prEN 1998-3: peak"

#: Document below the root, sentence, cells.
QUOTED = [
    (
        "validation/README.md",
        "39 known: peaks {} of the test, coefficient of variation {} %; 57 blind: {} and {} %",
        [Cell(path, MODEL, "all", n) for path in STONES for n in (0, 1)],
    ),
    (
        "validation/README.md",
        "failure type right in {} and {};",
        [Cell(path, "failure type right", "all") for path in STONES],
    ),
    (
        "validation/stone_walls/README.md",
        "| all (39) | {} ({} %) | {} ({} %) | {} ({} %) |",
        [Cell(STONES[0], rule, "all", n) for rule in RULES for n in (0, 1)],
    ),
    (
        "validation/stone_walls/README.md",
        "| E1 ashlar, dry (14) | {} ({} %) | {} ({} %) | {} ({} %) |",
        [Cell(STONES[0], rule, "E1", n) for rule in RULES for n in (0, 1)],
    ),
    (
        "validation/stone_walls/README.md",
        "| C cut stone (12) | {} ({} %) | {} ({} %) | {} ({} %) |",
        [Cell(STONES[0], rule, "C (", n) for rule in RULES for n in (0, 1)],
    ),
    (
        "validation/stone_walls/README.md",
        "| peak, this model | {} ({} %) | {} ({} %) | {} ({} %)",
        [Cell(STONES[1], MODEL, typology, n) for typology in ("A", "B", "C") for n in (0, 1)],
    ),
    (
        "validation/README.md",
        "17 known: peaks {} of the test, coefficient of variation {} %, as codes;"
        " failure type right in {};",
        [Cell(BRICKS, "chosen", head, n) for head, n in (("peak", 0), ("peak", 1), ("modes", 0))],
    ),
    (
        "validation/README.md",
        "panel {} (hinged edges) to {} (clamped) of the test",
        [Cell(OPEN, f"{edges}, as it is", "over test") for edges in ("hinged", "clamped")],
    ),
    (
        "validation/README.md",
        "medians of PGA at collapse {}, {}, {} g, dispersions {} to {}",
        [
            *(
                Cell(RECORDS, f"{name}, falls | PGA", "median")
                for name in ("parapet", "gable", "facade")
            ),
            *(Cell(RECORDS, f"{name}, falls | PGA", "dispersion") for name in ("gable", "parapet")),
        ],
    ),
    (
        "validation/README.md",
        "`--accuracy 2`: {} of 40 intervals contain the peak, {} the work",
        [Cell(HELD, quantity, "intervals") for quantity in ("peak", "work")],
    ),
    (
        "validation/README.md",
        "peak {} ± {} kN over a metre, {} ± {} kN from brick to brick",
        [Cell(FIELDS, row, head) for head in ("1 m", "one brick") for row in ("mean", "standard")],
    ),
    (
        "validation/README.md",
        "preset fast: peak within {} %, work {} %, initial stiffness {} %",
        [Cell(TRADE, "rigid, 100 mm/s", head) for head in ("peak", "work", "stiffness")],
    ),
    (
        "validation/README.md",
        "preset accurate: peak within {} %, work {} %, initial stiffness {} %",
        [
            Cell(TRADE, "two by two cells, 50 mm/s: preset", head)
            for head in ("peak", "work", "stiffness")
        ],
    ),
    (
        "validation/README.md",
        "| peak of a run, rigid units | {} | {} | {} | {} |",
        [Cell(WALL.format(n), "peak_at_both_ends_kN", "rigid") for n in ("0a", "1", "4", "6")],
    ),
    (
        "validation/README.md",
        "the diagonal has {} of the energy, limit 0.5",
        [Cell(WALL.format(4), "diagonal_energy_share", "rigid")],
    ),
    (
        "validation/README.md",
        "a band of {} courses, limit 6",
        [Cell(WALL.format(4), "diagonal_band_courses", "deformable")],
    ),
    (
        "validation/README.md",
        "the reach of the diagonal crack: {}, limit 25",
        [Cell(WALL.format(6), "diagonal_reach", "deformable")],
    ),
    (
        "validation/README.md",
        "deformable ones, within 2 %, because the joints share the shear of the units"
        " ([how](../yade_plugin/law/README.md#rigid-units)): {} and {} kN/mm in COMP-4",
        [Cell(WALL.format(4), "initial_stiffness", head) for head in ("rigid", "deformable")],
    ),
]


def matched(document, sentence):
    """The numbers that a document has in place of the {} of a sentence."""
    with open(os.path.join(studies.ROOT, document), encoding="utf-8") as file:
        text = " ".join(file.read().split())
    pattern = r"([-+−]?\d+\.?\d*)".join(map(re.escape, sentence.split("{}")))
    found = re.search(pattern, text)
    assert found, f"{document} does not say: {sentence}"
    return [one.replace("−", "-") for one in found.groups()]


@mark.parametrize("document, sentence, cells", QUOTED, ids=[f"{q[0]}-{q[1][:30]}" for q in QUOTED])
def test_a_document_quotes_what_a_program_has_made(document, sentence, cells):
    for text, cell in zip(matched(document, sentence), cells, strict=True):
        half = 0.5 * 10.0 ** -len(text.partition(".")[2])
        assert abs(cell.value()) == approx(abs(float(text)), abs=1.001 * half), cell


def test_what_the_preset_fast_promises_was_measured():
    with open(os.path.join(studies.HERE, "accuracy", "accuracy.json")) as file:
        rows = json.load(file)
    if "fast_percent" not in rows[0]:
        pytest.skip("made by validation/remake.py accuracy")
    bounds = {"peak": 100 * PROMISE["peak_error"], "work": 100 * PROMISE["work_error"]}
    missed = {r["wall"] for r in rows if abs(r["fast_percent"]) > bounds[r["quantity"]]}
    assert len(missed) == PROMISE["missed"] and len(rows) / 2 + 4 == PROMISE["walls"]
    assert all(r["fast_sudden_loss"] for r in rows if r["wall"] in missed)
