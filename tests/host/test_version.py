# SPDX-License-Identifier: GPL-2.0-or-later
"""The plugin carries the version and the commit that it was built from."""

import pydoc

import masonry
from masonry import _masonry, options


def test_the_plugin_was_built_from_the_version_of_the_package():
    assert _masonry.version == masonry.__version__


def test_help_shows_the_version():
    assert masonry.__version__ in pydoc.render_doc(masonry, renderer=pydoc.plaintext)


def test_the_help_of_a_scene_ends_with_version_and_commit():
    last = options.parser("a wall", until=12).format_help().splitlines()[-1]
    assert last == f"masonry {masonry.__version__}, commit {masonry.commit}"
