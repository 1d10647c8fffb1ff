"""Geometric camera calibration through multi-view rectification.

``from calibgui import engine`` is the interface for programs: arrays in, frozen records out.
``calibgui.dataset`` keeps photographs with what was found in them, ``calibgui.formats`` reads and
writes the files of other programs, and ``python -m calibgui`` is the command line, whose arguments
may be photographs to open in the window.
"""

__version__ = "0.1.0"
