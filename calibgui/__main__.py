"""``python -m calibgui``."""

from __future__ import annotations

import sys
from multiprocessing import freeze_support

from calibgui.cli.main import main

if __name__ == "__main__":
    freeze_support()  # lets workers start from a frozen program
    sys.exit(main())
