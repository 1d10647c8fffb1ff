"""The data of one camera: photographs, what was found in them, and the calibration that answers.

`View` is one photograph with its corners, or with the reason why there are none. `CornerSet` is
what a calibration is made from: the views of one camera, and the board that they show. `Result` is
what it leads to: the calibration, with the views that it was made from; `LeftOut` is one that a
series of them cannot use. `PoseSet` holds the board's poses under a camera that is known
(`KnownCamera`), `HandEyeSet` where a robot has its camera. The records know no file format
(``calibgui.formats``) and no window.
"""

from __future__ import annotations

from calibgui.dataset.corner_set import DEFAULT_SQUARE, CornerSet
from calibgui.dataset.hand_eye_set import HandEyeSet
from calibgui.dataset.hardware import LENS_TYPES, UNKNOWN_HARDWARE, Hardware
from calibgui.dataset.known_camera import KnownCamera
from calibgui.dataset.left_out_result import LeftOut
from calibgui.dataset.pose_set import LocatedView, PoseSet
from calibgui.dataset.result import Result, list_installed_versions
from calibgui.dataset.rig_pairing import CameraPhotographs, RigPairing
from calibgui.dataset.rig_result import RigResult, relate_cameras
from calibgui.dataset.stereo_rectification import StereoRectification
from calibgui.dataset.view import View, ViewStatus, find_orientation

__all__ = [
    "DEFAULT_SQUARE",
    "LENS_TYPES",
    "UNKNOWN_HARDWARE",
    "CameraPhotographs",
    "CornerSet",
    "HandEyeSet",
    "Hardware",
    "KnownCamera",
    "LeftOut",
    "LocatedView",
    "PoseSet",
    "Result",
    "RigPairing",
    "RigResult",
    "StereoRectification",
    "View",
    "ViewStatus",
    "find_orientation",
    "list_installed_versions",
    "relate_cameras",
]
