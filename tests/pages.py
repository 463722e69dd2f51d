# SPDX-License-Identifier: GPL-2.0-or-later
"""What stands in a page of HTML, for tests of pages, reports and the site."""

import html.parser

#: Attributes by which a page loads something when it is opened. A link that a reader follows is
#: none.
LOADED = {
    "script": "src",
    "link": "href",
    "img": "src",
    "iframe": "src",
    "source": "src",
    "object": "data",
    "embed": "src",
}
#: Texts that break out of a page, turn its reading round or steer a terminal, if they are not
#: escaped.
HOSTILE = "</script><script>alert(1)</script><!-- \"' & <b>\u202e\x1b"
SHOWN = HOSTILE.replace("\u202e", "\\u202e").replace("\x1b", "\\x1b")


class Page(html.parser.HTMLParser):
    """The elements of a page, each with its attributes and its own text; texts in turn; and cells
    of all rows of tables."""

    def __init__(self, text):
        super().__init__()
        self.elements, self.rows, self.data, self._open = [], [], [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.elements.append([tag, dict(attributes), ""])
        self._open.append(self.elements[-1])
        if tag == "tr":
            self.rows.append([])
        if tag in ("td", "th") and self.rows:
            self.rows[-1].append("")

    def handle_endtag(self, tag):
        while self._open and self._open.pop()[0] != tag:
            pass

    def handle_data(self, text):
        names = [tag for tag, *_ in self._open]
        if {"td", "th"} & {*names}:
            self.rows[-1][-1] += text
        if names:
            self._open[-1][2] += text
            if names[-1] not in ("style", "script"):
                self.data.append(text)

    def names(self):
        return [tag for tag, *_ in self.elements]

    def of(self, *tags):
        """The texts of all elements with these names, in turn."""
        return [text for tag, _, text in self.elements if tag in tags]

    def loads(self):
        """What the page loads when it is opened."""
        found = (known.get(LOADED.get(tag)) for tag, known, _ in self.elements)
        return list(filter(None, found))

    def said(self):
        """All that is read, in one text."""
        return " ".join(self.data).replace("\u00a0", " ")

    def row(self, head, count=None):
        """The cells of the only row that begins with a text, and has so many cells."""
        (found,) = [r for r in self.rows if r[0] == head and count in (None, len(r))]
        return [cell.replace("\u00a0", " ") for cell in found]
