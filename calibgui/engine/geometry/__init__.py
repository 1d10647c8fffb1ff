"""Frames, rotations, poses and homographies: what a camera and a board have in common."""

from __future__ import annotations

from calibgui.engine.geometry.frames import (
    PAPER_NAMES,
    PaperPose,
    centre_of_array,
    corner_from_array,
    paper_from_pose,
)
from calibgui.engine.geometry.homography import fit_homography
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.geometry.rotations import rotation, rotation_vector

__all__ = [
    "PAPER_NAMES",
    "PaperPose",
    "Pose",
    "centre_of_array",
    "corner_from_array",
    "fit_homography",
    "paper_from_pose",
    "rotation",
    "rotation_vector",
]
