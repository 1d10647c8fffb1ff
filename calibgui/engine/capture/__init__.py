"""Capture: live images, the board followed in them, and what to do with it until enough is known.

`open_source` opens a camera, a video or a folder that is being filled; `PairedFrames` reads one or
several; a `JointSession` looks at their frames, says what to do, and takes those that are worth it,
with a `CaptureSession` for each camera.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from calibgui.engine.faces import load_on_demand

if TYPE_CHECKING:
    from calibgui.engine.capture.board_tracking import track_corners as track_corners
    from calibgui.engine.capture.camera_settings import CameraSettings as CameraSettings
    from calibgui.engine.capture.cameras import list_cameras as list_cameras
    from calibgui.engine.capture.frame_sources import (
        Frame as Frame,
        FrameSource as FrameSource,
        Opened as Opened,
        open_source as open_source,
    )
    from calibgui.engine.capture.guidance import Guidance as Guidance, guide_board as guide_board
    from calibgui.engine.capture.joint_session import (
        JointSession as JointSession,
        JointState as JointState,
    )
    from calibgui.engine.capture.latest_frames import (
        Instant as Instant,
        PairedFrames as PairedFrames,
    )
    from calibgui.engine.capture.session import (
        CaptureSession as CaptureSession,
        CaptureState as CaptureState,
        Picture as Picture,
    )

load_on_demand(
    __name__,
    {
        "board_tracking": ["track_corners"],
        "camera_settings": ["CameraSettings"],
        "cameras": ["list_cameras"],
        "frame_sources": ["Frame", "FrameSource", "Opened", "open_source"],
        "guidance": ["Guidance", "guide_board"],
        "joint_session": ["JointSession", "JointState"],
        "latest_frames": ["Instant", "PairedFrames"],
        "session": ["CaptureSession", "CaptureState", "Picture"],
    },
)
