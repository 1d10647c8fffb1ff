"""Hand and eye: where a camera is in a robot's hand, or beside the robot, and how certain that is.

`calibrate_hand_eye` takes a camera, views of a board and a pose of the robot for each, in whatever
convention, and returns a `HandEye`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from calibgui.engine.faces import load_on_demand

if TYPE_CHECKING:
    from calibgui.engine.hand_eye.hand_eye import (
        HandEye as HandEye,
        ToolError as ToolError,
        calibrate_hand_eye as calibrate_hand_eye,
    )

load_on_demand(__name__, {"hand_eye": ["HandEye", "ToolError", "calibrate_hand_eye"]})
