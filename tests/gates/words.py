# SPDX-License-Identifier: GPL-2.0-or-later
"""Words that this code uses with private meanings, and what to write in their place.

    /usr/bin/python3 tests/gates/words.py            every place in the tree
    /usr/bin/python3 tests/gates/words.py FILE ...   every place in these files

Two rules hold. A name of the code (C++ and Python) has none of the words in ``NAMES`` as a part:
``stepsLeft`` and ``steps_left`` both have the part ``left``. And comments, docstrings and documents
have none of the words in ``PROSE``; the other words are ordinary English there. Names of tests are
sentences, so the second rule holds for them.
"""

import functools
import io
import os
import re
import sys
import tokenize

import tree

#: Parts of names, and standard words in their place.
NAMES = {
    "told": "text, message, entries, record",
    "way": "direction, path, method, travelled distance",
    "haste": "dynamic imbalance, fall speed ratio",
    "hung": "dependent point, attached node",
    "home": "columns, group, owner",
    "homes": "columns, groups, owners",
    "stranger": "foreign process, other engine",
    "strangers": "foreign processes, other engines",
    "strayed": "moved out of the plane, beyond the limit",
    "waits": "pending, skipped",
    "asks": "requests, queries",
    "left": "remaining (the direction: see ALLOWED)",
    "room": "capacity, free space, size",
    "leave": "exit, keep, skip",
    "weak": "low strength (say which)",
    "capable": "supported, available",
    "go on": "continued, resume",
    "goes on": "continued, resumed",
}

#: Whole names in which such a part is harmless, and why.
ALLOWED = {
    "left": "the direction, beside `right`; also a keyword of matplotlib and numpy",
    "isLeft": "the direction",
    "top_left": "the direction",
    "lower_left": "the direction",
    "upper_left": "the direction",
    "leftOf": "the direction",
    "turnsLeft": "the direction",
    "CorrectedLeaveOneOut": "of OpenTURNS",
    "Room": "a room of a house, in masonry.bricks",
    "weak_ptr": "of the C++ library",
    "weak": "the attribute of a symbol, of the compiler",
    "weakref": "of the Python library",
    "HOME": "the variable of the environment",
    "NAMES": "this list",
}

#: Words that comments and documents do not use, and standard words in their place.
PROSE = {
    "told": "reported, printed, named, given, distinguished",
    "haste": "dynamic imbalance, fall speed ratio",
    "hung": "attached, dependent",
    "strayed": "moved out of the plane, beyond the limit",
    "strangers": "foreign processes, other engines, other users",
    "home": "place, owner (of state: where it is stored)",
    "homes": "places, owners",
}

BEFORE_DOCSTRING = (tokenize.NEWLINE, tokenize.INDENT)
ENDINGS = tree.CPP + (".py", ".md")
ABOUT_WORDS = "tests/gates/"  # these files name the words

_PARTS = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+")
_CPP = re.compile(
    r"(?P<comment>//[^\n]*|/\*.*?\*/)"
    r'|(?P<text>R"\((?:.*?)\)"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\')'
    r"|(?P<name>[A-Za-z_]\w*)|(?P<number>\d[\w.']*)",
    re.DOTALL,
)


@functools.lru_cache(maxsize=None)
def inName(name):
    """Banned words that a name has as parts."""
    if name in ALLOWED:
        return []
    parts = [p.lower() for p in _PARTS.findall(name)]
    pairs = [" ".join(pair) for pair in zip(parts, parts[1:])]
    return [word for word in parts + pairs if word in NAMES]


def inProse(text):
    """Banned words in a comment or document. Names of the code between backticks are left to the
    other rule."""
    plain = re.sub(r"`+[^`\n]*`+", "", text)
    return [w for w in re.findall(r"[a-z]+", plain.lower()) if w in PROSE]


def ofCpp(source):
    """``(line, word, where)`` for each banned word of a C++ file."""
    found = []
    for match in _CPP.finditer(source):
        words, where = [], "comment"
        if match["comment"]:
            words = inProse(match["comment"])
        elif match["name"]:
            words, where = inName(match["name"]), match["name"]
        if words:  # to count lines takes longer than all else
            line = source.count("\n", 0, match.start()) + 1
            found += [(line, word, where) for word in words]
    return found


def ofPython(source):
    """The same of a Python file. A text that stands alone is a docstring."""
    found = []
    before = tokenize.NEWLINE  # type of the token before
    # of texts with braces, which are one token before Python 3.12; what stands in them is not
    # looked at
    depth = 0
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        kind = tokenize.tok_name[token.type]
        depth += (kind == "FSTRING_START") - (kind == "FSTRING_END")
        if depth:
            before = token.type
            continue
        line, _ = token.start
        if token.type == tokenize.COMMENT:
            found += [(line, w, "comment") for w in inProse(token.string)]
        elif token.type == tokenize.NAME:
            if token.string.startswith("test_"):
                words = [w for w in token.string.split("_") if w in PROSE]
            else:
                words = inName(token.string)
            found += [(line, w, token.string) for w in words]
        elif token.type == tokenize.STRING and before in BEFORE_DOCSTRING:
            found += [(line, w, "docstring") for w in inProse(token.string)]
        if token.type not in (tokenize.NL, tokenize.COMMENT, tokenize.DEDENT):
            before = token.type
    return found


def ofDocument(source):
    lines = enumerate(source.splitlines(), 1)
    return [(n, word, "document") for n, line in lines for word in inProse(line)]


def violations(path, root=tree.ROOT):
    """A sentence for each place of a file."""
    source = tree.read(path, root)
    if path.endswith(".py"):
        found = ofPython(source)
    else:
        found = ofDocument(source) if path.endswith(".md") else ofCpp(source)
    for line, word, where in found:
        prose = where in ("comment", "docstring", "document")
        instead = PROSE[word] if prose else {**PROSE, **NAMES}[word]
        yield f"{path}:{line}: {word} in {where}; rather: {instead}"


def all():
    """The same of the tree."""
    paths = [p for p in tree.files(ENDINGS) if not p.startswith(ABOUT_WORDS)]
    return [line for path in paths for line in violations(path)]


if __name__ == "__main__":
    here = [line for path in sys.argv[1:] for line in violations(path, os.getcwd())]
    print("\n".join(here if sys.argv[1:] else all()))
