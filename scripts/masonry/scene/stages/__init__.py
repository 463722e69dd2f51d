"""The stages of a test. Each is a function of the scene, in a file with those of its family, with its traits on it.

A new stage is such a function (:func:`masonry.scene.stages.stage.stage`) and its place in :data:`STAGES`.
"""

from .drive import drive, pressJoint
from .gravity import accelerate, lean, tilt
from .push import cycle, follow, push
from .rest import settle
from .shake import run, shake
from .stage import AT_REST, COLLAPSED, DONE, MOVING
from .supports import move, release

#: All stages. Each is a method of :class:`masonry.scene.scene.Scene`.
STAGES = (
    settle,
    push,
    cycle,
    follow,
    drive,
    pressJoint,
    release,
    move,
    tilt,
    accelerate,
    lean,
    shake,
    run,
)
