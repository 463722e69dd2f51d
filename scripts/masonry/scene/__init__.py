"""A scene: what is built, how it is held and loaded, and the stages of its test.

- :mod:`masonry.scene.scene`: ``Scene``
- :mod:`masonry.scene.materials`: published parameter sets, and properties that vary from place to place
- :mod:`masonry.scene.fields`: random fields; :mod:`masonry.scene.history`: displacements there and back;
  :mod:`masonry.scene.ground`: ground motion and Rayleigh damping
- :mod:`masonry.scene.options`: the options of the command line
- :mod:`masonry.scene.bounds`: limit analysis beside a run
"""
