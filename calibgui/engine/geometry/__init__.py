"""Frames, rotations, poses and homographies: the geometry that cameras and boards share.

Names read ``b_from_a`` for a conversion from a to b; see ``frames`` for all frames in use.
"""

from __future__ import annotations

from calibgui.engine.geometry.frames import (
    PAPER_NAMES,
    PaperPose,
    array_from_paper,
    centre_of_array,
    corner_from_array,
    paper_from_array,
    paper_from_pose,
    pose_from_paper,
)
from calibgui.engine.geometry.homography import (
    apply_homography,
    fit_homography,
    invert_homography,
)
from calibgui.engine.geometry.planar_pose import mirror_planar_poses, poses_from_homographies
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.geometry.rotations import rotation_from_vector, vector_from_rotation

__all__ = [
    "PAPER_NAMES",
    "PaperPose",
    "Pose",
    "apply_homography",
    "array_from_paper",
    "centre_of_array",
    "corner_from_array",
    "fit_homography",
    "invert_homography",
    "mirror_planar_poses",
    "paper_from_array",
    "paper_from_pose",
    "pose_from_paper",
    "poses_from_homographies",
    "rotation_from_vector",
    "vector_from_rotation",
]
