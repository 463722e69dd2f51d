# SPDX-License-Identifier: GPL-2.0-or-later
"""Texts and numbers of files of a run in a page: nothing of them becomes a tag or a script. This module needs no YADE."""

from __future__ import annotations

import html
import json
from typing import Any

from ..basics import plain


class Html(str):
    """HTML that may stand in a page as it is. All other texts are escaped."""


def escaped(text: Any) -> Html:
    """A text of a file of a run as HTML, with control characters written out; :class:`Html` stays as it is."""
    return text if isinstance(text, Html) else Html(html.escape(plain(text)))


def asJson(value: Any) -> str:
    """JSON that can stand in any element: what HTML could take for a tag is written as an escape. Raises ValueError for numbers that
    are not finite."""
    text = json.dumps(value, allow_nan=False, separators=(",", ":"))
    for letter in "<>&":
        text = text.replace(letter, f"\\u{ord(letter):04x}")
    return text


def tag(name: str, *inside: Any, **attributes: Any) -> Html:
    """An element with what is inside it. ``class_`` is the attribute ``class``, and ``_`` in other names is ``-``; None leaves an
    attribute out."""
    said = "".join(
        f' {key.rstrip("_").replace("_", "-")}="{escaped(value)}"'
        for key, value in attributes.items()
        if value is not None
    )
    return Html(f"<{name}{said}>{joined(*inside)}</{name}>")


def joined(*parts: Any) -> Html:
    """Parts one after the other; None is nothing."""
    return Html("".join(escaped(part) for part in parts if part is not None))
