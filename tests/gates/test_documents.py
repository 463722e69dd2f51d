# SPDX-License-Identifier: GPL-2.0-or-later
"""Links, commands and paths of all documents lead somewhere."""

import os

import documents
import sizes
import tree


def test_links_commands_and_paths_of_the_documents_lead_somewhere():
    assert len(tree.files((".md",))) > 15
    assert documents.all() == []


def test_pictures_of_the_documents_are_there_and_small():
    paths = tree.files((".md",))
    assert [problem for path in paths for problem in documents.largePictures(path)] == []
    shown = {picture for path in paths for picture in documents.pictures(path)}
    drawn = {p for p in tree.files((".png",)) if p.startswith("scripts/docs/pictures/")}
    assert len(drawn) > 10 and drawn - shown == set()


def test_each_package_has_a_readme_with_a_picture_that_names_its_modules():
    for package in sizes.PACKAGES.values():
        folder = f"scripts/{package}"
        text = tree.read(f"{folder}/README.md")
        assert len(documents.pictures(f"{folder}/README.md")) == 1
        names = [n.removesuffix(".py") for n in os.listdir(os.path.join(tree.ROOT, folder))]
        isRoom = lambda name: os.path.isdir(os.path.join(tree.ROOT, folder, name))
        if package == "masonry":
            names = filter(isRoom, names)
        names = [n for n in names if n.isidentifier() and not n.startswith("_")]
        assert names and [n for n in names if f"`{n}`" not in text and f"`{n}/`" not in text] == []


def test_pictures_that_are_missing_or_large_are_found(tmp_path):
    (tmp_path / "large.png").write_bytes(b"0" * documents.LARGEST_PICTURE)
    (tmp_path / "small.png").write_bytes(b"0")
    (tmp_path / "a.md").write_text("![a](large.png) ![b](small.png) ![c](gone.png)\n")
    assert documents.largePictures("a.md", tmp_path) == [
        "a.md: large.png is too large",
        "a.md: gone.png is missing",
    ]


def planted(tmp_path, text):
    (tmp_path / "scripts" / "masonry").mkdir(parents=True)
    (tmp_path / "scripts" / "wall.py").write_text("")
    (tmp_path / "scripts" / "run.sh").write_text("")
    (tmp_path / "scripts" / "masonry" / "measure.py").write_text("def peak(): ...\n")
    (tmp_path / "other.md").write_text("# A heading, with `code`\n\n# Twice\n\n# Twice\n")
    (tmp_path / "document.md").write_text(text)
    found = documents.problems("document.md", tmp_path)
    return [line.split(": ", 1)[1] for line in found]


def test_what_leads_somewhere_is_left_alone(tmp_path):
    good = """# Here

[a](other.md) [b](other.md#a-heading-with-code) [c](#here) [d](https://example.org/x)
[e](other.md#twice-1)

    bash scripts/run.sh wall
    yade -n -x scripts/wall.py --until 3
    yade -n -x my_scene.py

`scripts/wall`, `scripts/wall.py`, `masonry/measure`, `results/wall/` and `N/mm` are paths or none.
`/usr/bin/python3 -m masonry.measure results/wall` has `masonry.measure.peak`.
"""
    assert planted(tmp_path, good) == []


def test_each_kind_of_false_promise_is_found(tmp_path):
    bad = """# Here

[a](gone.md) [b](other.md#gone) [c](#gone)

    bash scripts/gone.sh
    yade -n -x scripts/gone.py
    /usr/bin/python3 -m masonry.gone
    /usr/bin/python3 scripts/gone.py

`scripts/gone.hpp` and `masonry.measure.gone`
"""
    assert planted(tmp_path, bad) == [
        "gone.md leads to no file",
        "other.md#gone leads to no heading",
        "#gone leads to no heading",
        "no script scripts/gone.sh",
        "no scene scripts/gone.py",
        "no module masonry.gone",
        "no script scripts/gone.py",
        "no module masonry.measure.gone",
        "no file scripts/gone.hpp",
    ]
