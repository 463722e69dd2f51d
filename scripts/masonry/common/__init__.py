# SPDX-License-Identifier: GPL-2.0-or-later
"""What all parts of the package share: checks of arguments, and what they need of the machine. None
of it needs YADE.

- :mod:`masonry.common.folders`: what is written in folders that others may have packed, and how
- :mod:`masonry.common.background`: tasks in other processes, and programs, several at a time
- :mod:`masonry.common.auxiliary`: what is computed beside a run, which never ends it
- :mod:`masonry.common.memory`: what numerical libraries take of the memory
- :mod:`masonry.common.packages`: libraries that come when they are first needed, and the Debian
  packages that have them
- :mod:`masonry.common.host`: how YADE is found and started in plain Python
- :mod:`masonry.common.notebook`: what is different in a notebook
- :mod:`masonry.common.arguments`: how every word checks what it is given
"""
