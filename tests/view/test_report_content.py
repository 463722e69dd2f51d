# SPDX-License-Identifier: GPL-2.0-or-later
"""What a report says of folders that are made up: numbers with units and sources, and a sentence
for everything that is missing."""

from usual import *
import itertools
from masonry_view import report
from masonry_view.page import library
from masonry_view.report import __main__ as program
from masonry_view.report.pieces import written
from made_runs import axis
from pages import HOSTILE, SHOWN, Page

PARTS = [
    "What was built",
    "How it was held and loaded",
    "The curve",
    "Drifts and other numbers",
    "The bound by limit analysis",
    "Where the work went",
    "Equivalent damping of cycles",
    "Forces at the base",
    "The structure in 3-D",
    "How far to trust it",
]
#: A push along straight lines: from 0 to 100 kN at 1 mm, and down to 40 kN at 4 mm, so 80 kN are
#: reached at 2 mm.
MOVED = np.linspace(0, 4, 401)
FORCE = np.interp(MOVED, [0, 1, 4], [0, 100, 40])
COLUMNS = {
    "time_s": MOVED / 10,
    "displacement_mm": MOVED,
    "base_shear_kN": FORCE,
    "top_shear_kN": FORCE,
    "external_J": np.append(0, np.cumsum(0.5 * (FORCE[1:] + FORCE[:-1]) * np.diff(MOVED))) + 7,
    "gravity_J": 0 * MOVED + 2,
    "refining_J": 0 * MOVED,
    "kinetic_J": 0 * MOVED,
    "damping_J": MOVED,
    "elastic_compression_J": 5 * MOVED,
    **{f"elastic_{part}_J": 0 * MOVED for part in ("tension", "shear", "units")},
    "dissipated_tension_J": np.where(MOVED < 0.495, 0, 2 * MOVED),
    "dissipated_shear_J": np.where(MOVED < 0.495, 0, 0.25 * MOVED**2),
}
MEANINGS = {
    "time_s": "time since the scene was built [s]",
    "base_shear_kN": "force on what is held [kN]",
    "external_J": "work of the loads since the scene was built [J]",
    "damping_J": "energy taken by damping since the scene was built [J]",
    "dissipated_tension_J": (
        "energy that joints dissipated in tension since the scene was built [J]"
    ),
}
JOINT = {
    "name": "bed",
    "law": "softening",
    "elastic": False,
    "cap": True,
    "normalStiffness": 3.352e11,
    "tensileStrength": 1e5,
    "friction": 0.43,
    "modeIFractureEnergy": 16.0,
    "compressiveStrength": 7.55e6,
}
#: Units of the numbers among its properties.
NUMBERS = {
    "normalStiffness": "Pa/m",
    "tensileStrength": "Pa",
    "friction": "-",
    "modeIFractureEnergy": "J/m²",
    "compressiveStrength": "Pa",
}


def answer(stage, number, name, value, unit, uncertainty=None):
    found = dict(stage=stage, number=number, name=name, value=value, unit=unit)
    return {**found, "uncertainty": uncertainty, "how": "as it is found"}


RUN = {
    "scene": "made_up",
    "title": "A wall that is made up",
    "date": "2026-05-31T12:00:00Z",
    "options": {"until": 4.0, "rate": 20.0, "set": [], "preset": None},
    "option_units": {"until": "mm", "rate": "mm/s"},
    "preset": None,
    "columns": MEANINGS,
    "joints": {
        "bed": JOINT,
        "support": {**JOINT, "elastic": True},
        "crack": {**JOINT, "cap": False},
    },
    "effective_properties": {
        "bed": [*NUMBERS],
        "support": ["normalStiffness"],
        "crack": [*NUMBERS][:-1],
    },
    "joint_units": NUMBERS,
    "joint_meanings": {
        "normalStiffness": (
            "Normal stiffness kn. A joint takes its elastic stiffness from it when it is made"
        )
    },
    "unit_material": {"young_Pa": 4.8e9, "poisson": 0.16, "density_kg_per_m3": 1800.0},
    "assumed": [
        {
            "name": "bed.modeIFractureEnergy",
            "value": 16.0,
            "unit": "J/m²",
            "source": "the paper gives no value",
        },
        {"name": "bed.friction", "value": 0.43, "unit": "-", "source": "the paper gives no value"},
        {"name": "unit.young", "value": 4.8e9, "unit": "Pa", "source": "default"},
        {
            "name": "unit.density",
            "value": 1800.0,
            "unit": "kg/m³",
            "source": "by a code: table C8.5.I",
            "by_code": True,
        },
    ],
    "versions": {"yade": "2023.02a", "python": "3.11.2", "masonry": "3.0.0"},
    "commit": "abc1234",
    "built": [["size", "4 × 0.1 × 2 m (x × y × z), 0.8 m³"]],
    "held_and_loaded": [
        ["base", "platen, held"],
        ["top", "platen, held about y; pressed by 0.5 MPa"],
    ],
    "script": [["platen", {"where": "bottom", "rotation": None}], ["push", {"target": "top"}]],
    "stages": [
        {"stage": "settle", "steps": 100, "seconds": 1.0, "first_row": 0, "load": None},
        {
            "stage": "push",
            "steps": 4000,
            "seconds": 1.0,
            "first_row": 0,
            "load": ["push", "top along x", ""],
        },
    ],
    "held": ["base"],
    "figure": {
        "x": axis("displacement_mm", "displacement of top [mm]"),
        "y": [axis("base_shear_kN", "supports"), axis("top_shear_kN", "loaded point")],
        "y_label": "force along the push [kN]",
        "marks": [{"x": 1.0, "y": 100.0, "text": "100.0 kN at 1.00 mm"}],
        "bounds": [{"y": 125.0, "text": "limit analysis: 125 kN at most"}],
    },
    "bounds": [
        {
            "load": "top along x",
            "unit": "kN",
            "factor": 125.0,
            "exact": False,
            "open_joints_slip": None,
            "joints": {"opens": 2, "slides": 3, "crushes": 0},
        }
    ],
    "bound_base_shear_kN": 125.0,
    "peak_base_shear_kN": 100.0,
    "displacement_at_peak_mm": 1.0,
    "peak_at_both_ends_kN": 100.0,
    "base_shear_end_kN": 40.0,
    "displacement_end_mm": 4.0,
    "initial_stiffness_kN_per_mm": 100.0,
    "displacement_at_first_crack_mm": 0.5,
    "drift_at_first_crack_mrad": 0.25,
    "recorded_height_m": 2.0,
    "collapse_displacement_mm": None,
    "largest_crack_mm": 3.25,
    "dynamic_imbalance": 0.0125,
    "energy_balance_error": 2e-10,
    "answers": [answer("push", 2, "peak", 100.0, "kN", 1.5)],
    "warnings": [],
    "notes": [],
    "recorded_drifts": [],
    "recorded_sections": [],
    "ended": "done",
    "collapsed": False,
    "interrupted": False,
    "steps": 4100,
    "time_step_s": 2e-5,
    "time_step_limit_s": 2.5e-5,
}


def folder(path, run=RUN, columns=COLUMNS, **changed):
    """A folder with curve.csv and run.json; ... takes an entry of run.json out."""
    path.mkdir(exist_ok=True)
    run = {k: v for k, v in {**run, **changed}.items() if v is not ...}
    (path / "run.json").write_text(json.dumps(run))
    if columns is not None:
        lines = [",".join(columns)] + [
            ",".join("%.9g" % v for v in row) for row in zip(*columns.values())
        ]
        (path / "curve.csv").write_text("\r\n".join(lines) + "\r\n")
    return str(path)


def page(path):
    """The page of a folder, which must be whole."""
    found = Page(report.page(report.read(path)))
    assert found.of("h2") == PARTS
    return found


@pytest.fixture(scope="module")
def pushed(tmp_path_factory):
    return page(folder(tmp_path_factory.mktemp("pushed")))


# -- what it says ----------------------------------------------------------------------------------

#: Of the bilinear curve: up to 2 mm the area is 50 + 90 J, so with K = 100 kN/mm: Vy (2 - Vy/200) =
#: 140.
YIELD = 200 * (1 - math.sqrt(1 - 0.7))
#: Cells of rows after their first one; None: any.
ROWS = {
    "Normal stiffness kn": ["N/mm³", "335.2", "335.2", "335.2"],
    "tensileStrength": ["MPa", "0.1", "–", "0.1"],
    "friction": ["-", "0.43assumed", "–", "0.43"],
    "modeIFractureEnergy": ["N/mm", "0.016assumed"],
    "compressiveStrength": ["MPa", "7.55", "–", "–"],
    "law": [None, "softening", "elastic: no strength is reached", "softening, cannot crush"],
    "Young's modulus of the unitsassumed": ["4,800 MPa"],
    "density of the unitsby a code": ["1,800 kg/m³"],
    "bed": ["modeIFractureEnergy 0.016 N/mm, friction 0.43", "the paper gives no value"],
    "top": ["platen, held about y; pressed by 0.5 MPa"],
    "2": ["push", "top along x", "4,000", "peak 100 ± 1.5 kN"],
    "first crack": ["0.5 mm", "0.25 mrad", "50 kN"],
    "0.8 of the peak": ["2 mm", "1 mrad", "80 kN"],
    "collapse": ["none", "none", "none"],
    "stiffness K": ["100 kN/mm"],
    "yield force Vy": [written(YIELD) + " kN"],
    "yield displacement dy": [written(YIELD / 100) + " mm"],
    "ultimate displacement du": ["2 mm"],
    "ductility µ = du/dy": [written(200 / YIELD)],
    "top along x": ["125 kN", "2 open, 3 slide"],
    "peak over bound": ["0.8"],
    "work of the loads": ["260 J", "100 %"],
    "energy taken by damping": ["4 J", "1.5 %"],
    "elastic energy of all parts": ["20 J", "7.7 %"],
    "energy that joints dissipated in tension": ["8 J", "3.1 %"],
    "what is missing in the balance": ["220 J", "86 %"],
    "largest error of the energy balance": ["2\u202f·\u202f10⁻⁸ %"],
    "dynamic imbalance": ["1.25 %"],
    "time step": ["20 µs", "80 % of the largest stable one."],
}
#: Sentences that are somewhere on the page, and texts of its chart.
SAID = """Peak 100 kN at 1 mm; limit analysis: at most 125 kN.
until: 4 mm; rate: 20 mm/s; set: –; preset: –
The run has no warnings.
one run does not tell
no error of peak or work is promised
the push did not end in a collapse
an upper bound"""
CHART = (
    "supports;loaded point;bilinear;100.0 kN at 1.00 mm;limit analysis: 125 kN at most;displacement"
    " of top [mm];force along the push [kN]"
)


@mark.parametrize("head", ROWS)
def test_each_number_has_its_unit_and_stands_where_it_belongs(pushed, head):
    found = pushed.row(head)[1:]
    assert all(cell in (None, there) for cell, there in zip(ROWS[head], found))


def test_the_head_the_sentences_and_the_chart(pushed):
    assert pushed.of("h1") == ["A wall that is made up"]
    facts = pushed.of("dt", "dd")
    assert facts == [
        "scene",
        "made_up",
        "run ended",
        "2026-05-31 12:00:00 UTC",
        "versions",
        "masonry 3.0.0, YADE 2023.02a, Python 3.11.2",
        "commit",
        "abc1234",
    ]
    assert ["property", "unit", "bed", "support", "crack"] in pushed.rows
    assert pushed.row("peak", 6)[1:4] == ["1 mm", "0.5 mrad", "100 kN"]
    assert pushed.of("code") == ["platen(where='bottom')", "push(target='top')"]
    assert not [r for r in pushed.rows if "refining" in r[-1]]  # no joint got points
    said = pushed.said()
    assert all(text in said for text in SAID.splitlines())
    assert "is not whole" not in said
    assert set(CHART.split(";")) <= {text.strip() for text in pushed.of("text")}


def test_piers_that_codes_have_checked_are_a_table(tmp_path):
    where = folder(tmp_path)
    (tmp_path / "piers.csv").write_text("pier,code,nu\r\nleft,NTC 2018,0.065\r\n")
    found = page(where)
    assert ["pier", "code", "nu"] in found.rows
    assert found.row("left") == ["left", "NTC 2018", "0.065"]


#: A run with dry joints, in which an energy of softening has no effect.
DRY = dict(
    joints={"bed": JOINT, "dry": {**JOINT, "tensileStrength": 0.0}},
    effective_properties={"bed": [*NUMBERS], "dry": ["tensileStrength", "friction"]},
)
#: What changes a run, the beginning of a row, and cells of it.
CHANGED = [
    (
        DRY,
        {},
        "modeIFractureEnergy",
        ["0.016assumed", "–"],
    ),
    (
        DRY,
        {},
        "friction",
        ["0.43assumed", "0.43"],
    ),
    (
        dict(joints_by_kind={"bed": 3, "support": 1}),
        {},
        "law",
        ["", "softening", "elastic: no strength is reached"],
    ),
    (
        dict(
            ties=[
                {
                    "name": "rod",
                    "ends_m": [[0, 0, 1.5], [2, 0, 1.5]],
                    "stiffness_N_per_m": 1e7,
                    "prestress_N": 3e4,
                    "state": "yielded",
                    "breaking_strain": None,
                }
            ]
        ),
        {},
        "rod",
        [
            "ends ((0, 0, 1.5), (2, 0, 1.5)) m; stiffness 1\u202f·\u202f10⁷ N/m; prestress 30,000"
            " N; state yielded; breaking strain –"
        ],
    ),
    (
        dict(recorded_drifts=["storey_x_mrad"]),
        {
            "storey_x_mrad": (
                "displacement of b along x less that of a, over the height between them [mrad]",
                -MOVED,
            )
        },
        "largest storey_x",
        ["−4 mrad"],
    ),
    (
        {},
        {"base_force_z_kN": ("force of the structure on base along z [kN]", 0 * MOVED - 20)},
        "base_force_z",
        ["−20 kN"] * 3,
    ),
]


@mark.parametrize("changed, columns, head, cells", CHANGED)
def test_what_a_run_has_beside(tmp_path, changed, columns, head, cells):
    meanings = {**MEANINGS, **{n: meaning for n, (meaning, _) in columns.items()}}
    more = {n: values for n, (_, values) in columns.items()}
    run = {**RUN, **changed, "columns": meanings}
    found = page(folder(tmp_path, columns={**COLUMNS, **more}, run=run))
    row = found.row(head)
    assert any(row[at : at + len(cells)] == cells for at in range(1, len(row)))
    assert "The moment at the base is not known" in found.said()


def test_a_warning_stands_at_the_head(tmp_path):
    said = page(folder(tmp_path, warnings=["the push is too fast", "it is damped"])).said()
    assert said.index("the push is too fast") < said.index(PARTS[0])
    assert "and 1 more" in said and said.count("it is damped") == 1


def test_a_curve_that_never_falls_to_its_ultimate_displacement_is_marked(tmp_path):
    columns = {name: values[:151] for name, values in COLUMNS.items()}
    found = page(folder(tmp_path, columns=columns))
    assert found.row("ultimate displacement du")[1] == "1.5 mmnot reached"
    assert found.row("ductility µ = du/dy")[1].endswith("not reached")
    assert found.row("0.8 of the peak")[1] == "none"
    assert "the force never falls to 0.8 of its peak" in found.row("0.8 of the peak")[4]


def test_every_number_has_a_definition_and_a_source(pushed):
    heads = ["quantity", "value", "what it is", "source"]
    starts = [n for n, row in enumerate(pushed.rows) if row == heads]
    assert len(starts) >= 4
    for start in starts:
        for row in pushed.rows[start + 1 :]:
            if len(row) != 4 or row[0] in ("energy", "quantity"):
                break
            assert row[2].rstrip().endswith(".") and row[3], row
            assert row[3].partition(":")[0] in ("run.json", "curve.csv", "source"), row


def test_the_promise_of_a_preset_and_the_width_of_an_accuracy_are_said(tmp_path):
    about = "preset fast: promises the peak within 3 % and more"
    found = page(folder(tmp_path, preset={"name": "fast"}, preset_note=about))
    assert f"The {about}." in found.said()
    accuracy = {
        "asked_percent": 2,
        "reached": False,
        "fidelity": "rigid units",
        "companions": [{}, {}],
        "not_covered": "the crack pattern",
        "quantities": [
            {
                "name": "peak",
                "unit": "kN",
                "value": 100.0,
                "half_width": 3.1,
                "half_width_percent": 3.1,
                "parts_percent": {"rate": 1.25},
                "how": "",
            }
        ],
    }
    found = page(folder(tmp_path, accuracy=accuracy))
    assert ["peak", "100 ± 3.1 kN", "3.1 %", "rate: 1.2 %"] in [
        [c.replace("\u00a0", " ") for c in r] for r in found.rows
    ]
    said = found.said()
    assert "The 2 % are not reached" in said and "does not cover the crack pattern" in said
    assert "one run does not tell" not in said


# -- runs of all kinds -----------------------------------------------------------------------------


NO_PUSH = {
    k: ... for k in RUN if k.endswith(("_mm", "_kN", "_mrad", "_kN_per_mm")) or k == "bounds"
}


@mark.parametrize("columns", [{n: [] for n in COLUMNS}, None])
def test_without_rows_there_is_a_page_of_the_bound(tmp_path, columns):
    found = page(
        folder(tmp_path, columns=columns, **{**NO_PUSH, "ended": ..., "bounds": RUN["bounds"]})
    )
    said = found.said()
    assert "The run has no rows" in said and "There is no curve" in said
    assert found.row("top along x")[1] == "125 kN"
    assert "There is no energy balance" in said


#: Displacements of many points, beside which their values at the end stand.
MANY = [
    (f"{what}_{n}", value / (1 + (what != "largest_displacement")))
    for n, value in enumerate((-4.0, 3.0, -7.0, 1.0))
    for what in ("largest_displacement", "displacement")
]


def test_a_run_without_a_push_says_so(tmp_path):
    figure = {
        "x": axis("time_s", "time [s]"),
        "y": [axis("displacement_mm", "top")],
        "y_label": "displacement [mm]",
    }
    answers = [answer("shake", 2, "largest_displacement_of_top_x", -4.0, "mm")]
    stages = [
        {"stage": "settle", "steps": 1, "first_row": 0},
        {"stage": "shake", "steps": 1, "first_row": 0, "load": None},
    ]
    found = page(folder(tmp_path, figure=figure, answers=answers, stages=stages, **NO_PUSH))
    said = found.said()
    assert "The run has no push, so there is no bilinear curve." in said
    assert "The run has no push, so there are no drifts" in said
    assert "There is no bound" in said
    assert "Largest displacement of top x −4 mm." in said
    many = [answer("shake", 2, f"{n}_of_top_x", v, "mm") for n, v in MANY]
    found = page(folder(tmp_path / "many", figure=figure, answers=many, stages=stages, **NO_PUSH))
    assert "Largest displacement 2 of top x −7 mm." in found.said()
    assert "Displacement 3 of top x" not in found.said()


def test_a_push_whose_force_still_grows_has_no_peak_at_the_head(tmp_path):
    n = np.linspace(0, 4, 401)
    columns = {**COLUMNS, "displacement_mm": n, "base_shear_kN": 20 * n, "top_shear_kN": 20 * n}
    found = dict(peak_at_both_ends_kN=80.0, displacement_at_peak_mm=4.0)
    said = page(folder(tmp_path, columns=columns, **found)).said()
    assert "No peak: the force grows to 80 kN at 4 mm" in " ".join(said.split())


def test_the_search_for_a_load_leads_with_what_was_held_and_what_was_not(tmp_path):
    found = [
        (2, "factor_held", 0.2),
        (2, "factor_not_held", None),
        (3, "factor_not_held", 0.4),
        (4, "factor_held", 0.3),
        (5, "factor_not_held", 0.35),
    ]
    answers = [answer("lean", *one, "g") for one in found]
    found = page(folder(tmp_path, stages=[], answers=answers, **NO_PUSH))
    assert (
        "Largest load that was held 0.3 g; smallest load that was not held 0.35 g" in found.said()
    )


def test_several_pushes_are_named(tmp_path):
    push = RUN["stages"][1]
    found = page(
        folder(tmp_path, stages=[*RUN["stages"], {**push, "load": ["push", "top along y", ""]}])
    )
    assert "The run has 2 pushes, the stages 2, 3." in found.said()
    found = page(folder(tmp_path, figure={**RUN["figure"], "rows": [[0, 100]]}))
    assert "from 0 kN to 99 kN" in found.said()


@mark.parametrize(
    "changed, text",
    [
        (
            {
                "collapsed": True,
                "collapse": "brick 5 falls",
                "ended": "collapsed",
                "collapse_displacement_mm": 4.0,
            },
            "Collapsed: brick 5 falls",
        ),
        ({"interrupted": True}, "The run was interrupted."),
        ({"error": "half \ud800 a character"}, "The run ended by an error: half ? a character"),
        (
            {"error": "the run has left finite numbers"},
            "The run ended by an error: the run has left finite numbers",
        ),
        ({"warnings": ["the push is too fast"]}, "the push is too fast"),
        ({"warnings": ...}, "is not whole: a file of the run is damaged or of another version"),
        (
            {"options": {"history": [1.0, 2.5], "set": ["bed.friction=0.5"], "no_vtk": False}},
            "history: 1, 2.5; set: bed.friction=0.5; no vtk: no.",
        ),
        ({"assumed": []}, "Nothing was assumed"),
        (
            {"recorded_height_m": None, "drift_at_first_crack_mrad": None},
            "The height of the recorded point is not known",
        ),
        (
            {
                "bounds": [
                    {"load": "top along x", "unit": "kN", "note": "it was not solved in time"}
                ],
                "bound_base_shear_kN": ...,
            },
            "it was not solved in time",
        ),
        ({"figure": ...}, "There is no curve: the curve is not drawn: run.json has no entry"),
        ({"options": {"no_vtk": True}}, "its run was started with --no-vtk"),
        ({"options": {"lean": True}}, "its run was started with --lean"),
    ],
)
def test_what_ended_a_run_and_what_it_lacks_is_said(tmp_path, changed, text):
    assert text in " ".join(page(folder(tmp_path, **changed)).said().split())


@mark.filterwarnings("error")
def test_numbers_that_are_not_finite_and_torn_lines_are_named_and_drawn_around(tmp_path):
    columns = {n: v.copy() for n, v in COLUMNS.items()}
    columns["base_shear_kN"][7] = math.nan
    columns["damping_J"][3:5] = math.inf
    columns["top_shear_kN"][:] = math.nan
    path = folder(tmp_path, columns=columns)
    with open(os.path.join(path, "curve.csv"), "a") as file:
        file.write("1,2,3\r\n4,5")
    said = page(path).said()
    assert "2 lines do not have a number for every column" in said
    assert "1 of 401 values of base_shear_kN are no finite numbers" in said
    assert "2 of 401 values of damping_J" in said
    assert "There is no bilinear curve" in said and "not finite" in said
    text = report.page(report.read(path))
    assert not re.search(r"\b(nan|inf)\b", re.sub(r"<(script|style).*?</\1>", "", text, flags=re.S))


def test_cycles_have_their_damping_and_what_took_their_work(tmp_path):
    t = np.linspace(0, 2 * np.pi, 400)
    columns = {
        **{n: np.resize(v, 400) for n, v in COLUMNS.items()},
        "displacement_mm": 2 * np.sin(t),
        "base_shear_kN": 10 * np.sin(t),
    }
    cycle = {
        "rows": [0, 399],
        "largest_mm": 2.0,
        "smallest_mm": -2.0,
        "amplitude_mm": 2.0,
        "work_J": 12.5,
        "largest_kN": 10.0,
        "smallest_kN": -10.0,
        "stiffness_kN_per_mm": 5.0,
        "damping": 12.5 / (40 * np.pi),
        "residual_positive_mm": None,
        "residual_negative_mm": 0.1,
        "dissipated_J": 11.0,
        "damped_J": 1.5,
    }
    found = page(
        folder(
            tmp_path,
            columns=columns,
            figure={**RUN["figure"], "looped": True},
            cycles=[cycle, {**cycle, "damping": None}],
            history={},
            damped_share=0.12,
        )
    )
    assert found.row("1", 10) == ["1", "−2", "2", "−10", "10", "12.5", "5", "9.947", "11", "1.5"]
    assert [r for r in found.rows if r and r[0] == "2"][-1][7] == "not known"
    said = found.said()
    assert "ξ = W/(4π·½·K·A²)" in said and "goes along a history" in said
    assert "envelope" in [text.strip() for text in found.of("text")]


def test_sections_have_normal_force_shear_and_moment(tmp_path):
    names = {"foot_N_kN": -50 + 0 * MOVED, "foot_V_x_kN": FORCE, "foot_M_y_kNm": 2 * FORCE}
    meanings = {n: f"a force on the section at z = 0 m [{n.rpartition('_')[2]}]" for n in names}
    run = {**RUN, "columns": {**MEANINGS, **meanings}, "recorded_sections": list(names)}
    found = page(folder(tmp_path, run, {**COLUMNS, **names}))
    assert found.row("foot_N")[1:6] == ["−50 kN"] * 5
    assert found.row("foot_M_y")[1:6] == ["≈ 0", "200 kNm", "80 kNm", "≈ 0", "200 kNm"]
    assert "no section was recorded" not in found.said()


# -- damaged and hostile files ---------------------------------------------------------------------


@mark.filterwarnings("error")
def test_what_stands_in_files_is_text_in_the_report(tmp_path):
    plain = report.page(report.read(folder(tmp_path)))

    def hostile(value, key=None):
        if isinstance(value, dict):
            return {n if n != "bed" else HOSTILE: hostile(v, n) for n, v in value.items()}
        if isinstance(value, list):
            return [hostile(v) for v in value]
        keep = ("column", "where", "law", "date", "stage", "name", "load", "unit")
        return HOSTILE if isinstance(value, str) and key not in keep else value

    text = report.page(report.read(folder(tmp_path, hostile(RUN))))
    before, after = Page(plain), Page(text)
    scripts = [page.names().count("script") for page in (before, after)]
    assert "alert(1)</script>" not in text and scripts[0] == scripts[1]
    assert "b" not in after.names() and after.of("h2") == PARTS
    assert after.of("h1") == [SHOWN] and SHOWN in after.said()


def test_whatever_stands_in_an_entry_there_is_a_page(tmp_path):
    values = itertools.cycle([..., None, HOSTILE, [], [None], {"a": [{"b": HOSTILE}]}, 7])
    for key, value in zip(RUN, values):
        text = report.page(report.read(folder(tmp_path, {**RUN, key: value})))
        assert Page(text).of("h2") == PARTS, key
        assert "alert(1)</script>" not in text, key


# -- size, picture, program ------------------------------------------------------------------------


def test_a_report_asks_nobody_and_forbids_it(tmp_path):
    found = page(folder(tmp_path))
    assert all(one.startswith("data:") for one in found.loads())
    links = [known["href"] for tag, known, _ in found.elements if tag == "a"]
    assert links and all(link.startswith("#") for link in links)
    named = {known.get("http-equiv"): known for _, known, _ in found.elements}
    policy = named["Content-Security-Policy"]["content"]
    assert policy.startswith("default-src 'none'")


def test_figures_of_the_folder_go_in_only_if_they_are_pictures(tmp_path):
    path = folder(tmp_path)
    (tmp_path / "cracks.png").write_bytes(b"\x89PNG\r\n\x1a\n" + bytes(40))
    (tmp_path / "mechanism.png").write_bytes(b"<svg onload=alert(1)>")
    images = [known for tag, known, _ in page(path).elements if tag == "img"]
    assert len(images) == 1 and images[0]["src"].startswith("data:image/png;base64,")
    assert "Cracks" in images[0]["alt"]


def test_without_three_a_sentence_names_the_package(tmp_path, monkeypatch):
    monkeypatch.setattr(library, "PLACES", ("/nowhere",))
    record = report.read(folder(tmp_path))
    record.picture = ({}, "")
    assert "apt-get install --no-install-recommends libjs-three" in report.page(record)


def test_the_program_writes_a_report_into_the_folder_or_elsewhere(tmp_path, capsys):
    path = folder(tmp_path / "run")
    assert program.main([path]) == 0
    assert "report.html: 0.0" in capsys.readouterr().out
    other = str(tmp_path / "wall.html")
    assert program.main([path, "-o", other]) == 0
    assert open(other).read() == (tmp_path / "run" / "report.html").read_text()


@mark.parametrize(
    "words, message",
    [
        (["nowhere"], "cannot read nowhere/run.json"),
        (["RUN", "-o", "no/a.html"], "cannot write no/a.html: there is no folder no"),
        (["RUN", "-o", "link.html"], "cannot write link.html: it is a symbolic link"),
    ],
)
def test_what_cannot_be_written_is_refused_and_nothing_is(
    tmp_path, monkeypatch, capsys, words, message
):
    run = folder(tmp_path / "run")
    here = tmp_path / "here"
    here.mkdir()
    monkeypatch.chdir(here)
    (here / "link.html").symlink_to("elsewhere")
    assert program.main([run if w == "RUN" else w for w in words]) == 2
    assert message in capsys.readouterr().err
    assert os.listdir(here) == ["link.html"]
    (tmp_path / "run" / "report.html").symlink_to("elsewhere")
    assert program.main([run]) == 2
    assert "report.html, a symbolic link" in capsys.readouterr().err


@mark.parametrize(
    "value, text",
    [
        (0, "0"),
        (0.0, "0"),
        (116.4789, "116.5"),
        (115.9697, "116.0"),
        (0.5, "0.5"),
        (-34.5, "−34.5"),
        (1224, "1,224"),
        (4800.0, "4,800"),
        (1.0678e-10, "1.068\u202f·\u202f10⁻¹⁰"),
        (2.0e11, "2\u202f·\u202f10¹¹"),
        (9.99996, "10.00"),
        (math.nan, "not known"),
        (math.inf, "not known"),
        (None, "not known"),
        ("7", "not known"),
        (True, "not known"),
    ],
)
def test_numbers_are_written_as_people_write_them(value, text):
    assert written(value) == text
