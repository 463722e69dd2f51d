# SPDX-License-Identifier: GPL-2.0-or-later
"""Parts of the output of a cell in a notebook: pictures and tables as HTML."""

import base64
import html
import io

COLOURS = 64  # of a picture


def picture(figure, dpi):
    """A figure of matplotlib as an image that stands in the HTML itself. It has a palette of
    :data:`COLOURS` colours, which makes it a third as large."""
    from PIL import Image

    drawn, small = io.BytesIO(), io.BytesIO()
    figure.savefig(drawn, dpi=dpi, format="png")
    Image.open(drawn).convert("RGB").quantize(COLOURS).save(small, "png", optimize=True)
    data = base64.b64encode(small.getvalue()).decode()
    return f'<img src="data:image/png;base64,{data}"/>'


def table(rows, heads=()):
    """Rows of texts as a table; the first of each row is its head."""
    cell = (
        lambda text, kind="td": f'<{kind} style="text-align:left">{html.escape(str(text))}</{kind}>'
    )
    lines = ["".join(cell(head, "th") for head in heads)] * bool(heads)
    lines += [cell(first, "th") + "".join(map(cell, others)) for first, *others in rows]
    return f"<table>{''.join(f'<tr>{line}</tr>' for line in lines)}</table>"


def folded(title, inside):
    """What is seen after a click on its title."""
    return f"<details><summary>{html.escape(title)}</summary>{inside}</details>"


def titled(title, *parts):
    """Parts below a title."""
    return f"<div><b>{html.escape(title)}</b>{''.join(parts)}</div>"
