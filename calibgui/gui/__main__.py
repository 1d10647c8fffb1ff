"""python -m calibgui.gui [FOLDER | IMAGES | PROJECT]: open the window."""

from __future__ import annotations

import sys

from calibgui.gui.app import run

if __name__ == "__main__":
    sys.exit(run(sys.argv[1:]))
