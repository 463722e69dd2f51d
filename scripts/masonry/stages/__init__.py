# SPDX-License-Identifier: GPL-2.0-or-later
"""The stages of a test. Each is a function of the scene with its traits on it
(:func:`masonry.stages.stage.stage`), in a file of its family, and has a place in :data:`STAGES`.

- :mod:`masonry.stages.rest`: ``settle``
- :mod:`masonry.stages.push`: ``push``, ``cycle`` and ``follow``, whose drive is in
  :mod:`masonry.stages.pushing`
- :mod:`masonry.stages.supports`: ``drive``, ``pressJoint``, ``release`` and ``move``
- :mod:`masonry.stages.gravity`: ``tilt``, ``accelerate``, ``lean`` and ``bracket``
- :mod:`masonry.stages.forces`: ``load``, ``wind``, ``press``, ``pressure`` and ``hold``
  after the first stage, and ``grow``; :mod:`masonry.stages.travelling`: ``travel``
- :mod:`masonry.stages.growing`: how a load grows, and the search for that which is held
- :mod:`masonry.stages.shake`: ``shake``, ``run``, ``period`` and ``shakeAgain``
- :mod:`masonry.stages.falling`: ``fall``, which follows a collapse
- :mod:`masonry.stages.bounding`: the commands that ask for limit analysis;
  :mod:`masonry.stages.bounds`: what stages and a run ask of it
- :mod:`masonry.stages.ahead`: files that the script names in stages to come
- :mod:`masonry.stages.answers`: how stages end, and what they answer;
  :mod:`masonry.stages.stage`: what all share
"""

from .gravity import accelerate, lean, tilt

from .forces import grow, hold, load, prepare, press, pressure, wind
from .push import cycle, follow, push
from .rest import settle
from .shake import period, run, shake, shakeAgain
from .answers import AT_REST, COLLAPSED, DONE, MOVING
from .supports import drive, move, pressJoint, release
from .travelling import travel

#: All stages. Each is a method of :class:`masonry.scene.scene.Scene`.
STAGES = [settle, push, cycle, follow, drive, pressJoint, release, move, tilt]
STAGES += [accelerate, lean, shake, run, grow, travel, period]
#: Stages whose names are those of words that describe: they are meant after the first stage.
LATER = (load, wind, press, pressure, hold)
