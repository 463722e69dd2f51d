# SPDX-License-Identifier: GPL-2.0-or-later
"""three.js, as the Debian package libjs-three has it, and its licence."""

import os
from pathlib import Path

from masonry.errors import Refused

#: Where the package puts it; and where it can be unpacked by those who cannot install packages.
PLACES = ("/", os.path.expanduser("~/.local/share/masonry/three"))
HERE = "usr/share/javascript/three/"
#: The library, and of its examples: turning and zooming, and lines of any width.
CODE = (
    "three.min.js",
    "examples/js/controls/OrbitControls.js",
    *(
        f"examples/js/lines/{n}.js"
        for n in ("LineSegmentsGeometry", "LineMaterial", "LineSegments2")
    ),
)
COPYRIGHT = "usr/share/doc/libjs-three/copyright"

MISSING = f"""pictures in a browser need three.js, once. As root:
  apt-get install --no-install-recommends libjs-three
or as yourself:
  cd /tmp && apt-get download libjs-three && dpkg -x libjs-three_*.deb {PLACES[1]}"""


def three():
    """The files of the library, a list of texts, and its licences. Raises Refused."""
    paths = [*(HERE + name for name in CODE), COPYRIGHT]
    for place in PLACES:
        try:
            *code, copyright = [Path(place, p).read_text("utf-8") for p in paths]
        except OSError:
            continue
        return code, copyright
    raise Refused(MISSING)
