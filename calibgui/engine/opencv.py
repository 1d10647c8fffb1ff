"""The one place that imports OpenCV: its shapes and names differ between 4.x and 5.x.

Points come back as (n, 2) float64 whatever the version.
"""

from __future__ import annotations

import cv2

VERSION: str = cv2.__version__
