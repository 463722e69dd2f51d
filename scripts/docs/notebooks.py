# SPDX-License-Identifier: GPL-2.0-or-later
"""Notebooks as pages: they are run, and their cells and outputs are written as Markdown.

They run in a folder of their own, with the kernel of ``/usr/bin/python3``. What came out is kept
under the contents of the notebook and the version of the package, so that a site that is made again
does not run them again.
"""

import base64
import hashlib
import json
import os
import re

#: How long a notebook may take [s].
LONGEST = 300
#: Kinds of an output, the best one first, and the ending of a file where it becomes one.
KINDS = {"text/html": "", "image/svg+xml": "svg", "image/png": "png", "text/plain": ""}

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
        # the kernel has no debugger, which would warn of that
        os.environ["PYDEVD_DISABLE_FILE_VALIDATION"] = "1"
        notebook = nbformat.reads(contents.decode(), as_version=4)
        client = nbclient.NotebookClient(
            notebook, timeout=LONGEST, kernel_name="python3", resources={"metadata": {"path": work}}
        )
        client.execute()
        with open(there, "w", encoding="utf-8") as file:
            nbformat.write(notebook, file)
    return load(there)


def load(path):
    """A notebook as it is stored, as a dict."""
    with open(path, encoding="utf-8") as file:
        return json.load(file)


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
        source, outputs = "".join(cell["source"]), cell.get("outputs", ())
        if cell["cell_type"] == "markdown":
            page += source + "\n\n"
        elif cell["cell_type"] == "code" and source.strip():
            page += _fenced(source, "python")
        spoken = _said(
            "".join("".join(out["text"]) for out in outputs if out["output_type"] == "stream")
        )
        if spoken:
            page += _fenced(spoken, "text")
        for out in outputs:
            if out["output_type"] == "error":
                raise ValueError(f"{name}: {out['ename']}: {out['evalue']}")
            data = out.get("data", {})
            kind = next((k for k in KINDS if k in data), None)
            text = "".join(data.get(kind, ""))
            if kind == "text/html":
                page += _fenced(text, "{raw} html")
            elif kind == "text/plain":
                page += _fenced(_said(text), "text")
            elif kind:
                pictures += 1
                file = f"{name}_{pictures}.{KINDS[kind]}"
                write(file, base64.b64decode(text) if kind == "image/png" else text.encode())
                page += f"![]({file})\n\n"
    return page
