"""Masonry for YADE: joint laws on polyhedral blocks.

Import it from a YADE script (or after ``import yade``)::

    from masonry import MasonryMat, MasonryJoint, connect

The classes that it registers in YADE (``masonry.classes``) are also in ``yade.wrapper``; ``help()`` is their manual.
Without YADE only the modules work that read results: :mod:`masonry.results`, :mod:`masonry.figures`,
:mod:`masonry.measure`, :mod:`masonry.loops`, and :mod:`masonry.presets`.
"""

import sys

if "yade" in sys.modules:
    try:
        from ._masonry import classes, commit, criticalTimeStep, touchingPairs
    except ImportError as error:
        if "undefined symbol" not in str(error):
            raise
        raise ImportError(
            "this YADE does not fit the masonry plugin, which knows YADE 2023.02a (Debian 12, double precision): "
            "expected a function or table of that version, found none: " + str(error)
        ) from None
    import yade.wrapper as _wrapper

    globals().update({_name: getattr(_wrapper, _name) for _name in classes})
    from . import options
    from .checkpoints import loadCheckpoint, readCheckpoint, saveCheckpoint
    from .scene import addBlock, connect, engines
