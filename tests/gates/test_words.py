# SPDX-License-Identifier: GPL-2.0-or-later
"""No file has the words that this code used with private meanings."""

import subprocess
import sys

import words


def test_no_file_has_private_words():
    assert words.all() == []


def test_every_word_has_another_in_its_place_and_every_exception_a_reason():
    assert all((words.NAMES | words.PROSE | words.ALLOWED).values())


# -- the gate sees what it is for ------------------------------------------------------------------


def test_a_word_is_found_as_part_of_a_name_however_it_is_written():
    for name in ("stepsLeft", "steps_left", "left_", "LEFT", "isLeftOver", "Left"):
        assert words.inName(name) == ["left"], name
    assert words.inName("mayGoOn") == ["go on"] == words.inName("go_on")
    assert words.inName("JointHome") == ["home"]
    for name in "top_left left leftover wayward goOne always towards".split():
        assert words.inName(name) == [], name


def test_names_and_comments_of_cpp_are_looked_at_and_texts_are_not():
    source = """// One is told once.
int wayLength = 1; /* in its
home */
const char* text = "the way is told // told"; // fine
const char* raw = R"(told way)"; char c = '"'; int room = 0;
"""
    assert words.ofCpp(source) == [
        (1, "told", "comment"),
        (2, "way", "wayLength"),
        (2, "home", "comment"),
        (5, "room", "room"),
    ]


def test_names_comments_and_docstrings_of_python_are_looked_at_and_texts_are_not():
    source = '''"""What is told."""
import os  # told, too

def one(way):
    """It has no home."""
    text = "this is told"  # `told` is a name here
    print(f"told {way}", os)

def test_what_is_told_in_a_way():
    pass
'''
    assert words.ofPython(source) == [
        (1, "told", "docstring"),
        (2, "told", "comment"),
        (4, "way", "way"),
        (5, "home", "docstring"),
        (9, "told", "test_what_is_told_in_a_way"),
    ]


def test_a_document_may_say_way_and_may_not_say_told():
    found = words.ofDocument("The way of the data\nis told, unlike `told`.\n")
    assert found == [(2, "told", "document")]


def test_the_command_shows_each_place_and_a_word_for_it(tmp_path):
    (tmp_path / "bad.py").write_text("way = 1\n")
    run = [sys.executable, words.__file__, "bad.py"]
    shown = subprocess.run(run, cwd=tmp_path, capture_output=True, text=True).stdout
    assert shown == "bad.py:1: way in way; rather: " + words.NAMES["way"] + "\n"
