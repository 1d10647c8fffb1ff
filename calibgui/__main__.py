"""``python -m calibgui``."""

from __future__ import annotations

import sys

from calibgui.cli.main import main

if __name__ == "__main__":
    sys.exit(main())
