# SPDX-License-Identifier: GPL-2.0-or-later
"""Notebooks as pages: they are run, and their cells and outputs are written as Markdown.

They run in a folder of their own, with the kernel of ``/usr/bin/python3``. What came out is kept under the contents of the
notebook and the version of the package, so that a site that is made again does not run them again.
"""

import base64
import hashlib
import json
import os
import re

#: How long a notebook may take [s].
LONGEST = 300
#: Kinds of an output, the best one first, and the ending of a file where it becomes one.
KINDS = {
    "text/html": None,
    "image/svg+xml": "svg",
    "image/png": "png",
    "text/plain": None,
}

_COLOURS = re.compile(r"\x1b\[[0-9;]*[A-Za-z]")


def run(path, kept, version):
    """A notebook with its outputs, as a dict: from the folder of what is kept, or run.

    :param path: of the notebook; ``kept``: the folder; ``version``: of what it runs, a text
    """
    with open(path, "rb") as file:
        contents = file.read()
    name = hashlib.sha256(contents + version.encode()).hexdigest()[:16] + ".ipynb"
    there = os.path.join(kept, name)
    if not os.path.exists(there):
        import nbclient
        import nbformat

        work = os.path.join(kept, "work")
        os.makedirs(work, exist_ok=True)
        notebook = nbformat.reads(contents.decode(), as_version=4)
        client = nbclient.NotebookClient(notebook, timeout=LONGEST, kernel_name="python3", resources={"metadata": {"path": work}})  # fmt: skip
        client.execute()
        with open(there, "w", encoding="utf-8") as file:
            nbformat.write(notebook, file)
    with open(there, encoding="utf-8") as file:
        return json.load(file)


def load(path):
    """A notebook as it is stored, as a dict."""
    with open(path, encoding="utf-8") as file:
        return json.load(file)


def title(notebook):
    """The first heading of a notebook."""
    for cell in notebook["cells"]:
        found = re.search(r"^# (.+)$", "".join(cell["source"]), re.M)
        if cell["cell_type"] == "markdown" and found:
            return found[1]
    raise ValueError("a notebook without a heading")


def _fenced(text, language):
    """A block of code, whose fence is longer than any in the text."""
    longest = max(map(len, re.findall("`+", text)), default=0)
    fence = "`" * max(3, longest + 1)
    return f"{fence}{language}\n{text.rstrip()}\n{fence}\n\n"


def _said(text):
    """What a program said: without colours, and of lines that replace each other the last."""
    lines = [line.rstrip("\r").rpartition("\r")[2] for line in text.split("\n")]
    return _COLOURS.sub("", "\n".join(lines)).strip("\n")


def markdown(notebook, name, write):
    """A notebook as Markdown.

    :param name: begins the names of its pictures
    :param write: function of a name and bytes that keeps a picture beside the page
    """
    page, pictures = "", 0
    for cell in notebook["cells"]:
        source = "".join(cell["source"])
        if cell["cell_type"] == "markdown":
            page += source + "\n\n"
            continue
        if cell["cell_type"] != "code" or not source.strip():
            continue
        page += _fenced(source, "python")
        spoken = "".join("".join(out["text"]) for out in cell.get("outputs", ()) if out["output_type"] == "stream")  # fmt: skip
        if _said(spoken):
            page += _fenced(_said(spoken), "text")
        for out in cell.get("outputs", ()):
            if out["output_type"] == "error":
                raise ValueError(f"{name}: {out['ename']}: {out['evalue']}")
            data = out.get("data", {})
            kind = next((k for k in KINDS if k in data), None)
            if kind is None:
                continue
            text = "".join(data[kind])
            if kind == "text/html":
                page += _fenced(text, "{raw} html")
            elif KINDS[kind]:
                pictures += 1
                file = f"{name}_{pictures}.{KINDS[kind]}"
                write(file, base64.b64decode(text) if kind == "image/png" else text.encode())  # fmt: skip
                page += f"![]({file})\n\n"
            else:
                page += _fenced(_said(text), "text")
    return page
