"""Frames, rotations, poses and homographies: the geometry that cameras and boards share.

Names read ``b_from_a`` for a conversion from a to b; see ``frames`` for all frames in use.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from calibgui.engine.faces import load_on_demand

if TYPE_CHECKING:
    from calibgui.engine.geometry.frames import (
        PAPER_NAMES as PAPER_NAMES,
        PaperPose as PaperPose,
        array_from_paper as array_from_paper,
        centre_of_array as centre_of_array,
        corner_from_array as corner_from_array,
        paper_from_array as paper_from_array,
        paper_from_pose as paper_from_pose,
        pose_from_paper as pose_from_paper,
    )
    from calibgui.engine.geometry.homography import (
        apply_homography as apply_homography,
        fit_homography as fit_homography,
        invert_homography as invert_homography,
    )
    from calibgui.engine.geometry.planar_pose import (
        mirror_planar_poses as mirror_planar_poses,
        poses_from_homographies as poses_from_homographies,
    )
    from calibgui.engine.geometry.pose import Pose as Pose
    from calibgui.engine.geometry.rotations import (
        rotation_from_vector as rotation_from_vector,
        vector_from_rotation as vector_from_rotation,
    )

load_on_demand(
    __name__,
    {
        "frames": [
            "PAPER_NAMES",
            "PaperPose",
            "array_from_paper",
            "centre_of_array",
            "corner_from_array",
            "paper_from_array",
            "paper_from_pose",
            "pose_from_paper",
        ],
        "homography": ["apply_homography", "fit_homography", "invert_homography"],
        "planar_pose": ["mirror_planar_poses", "poses_from_homographies"],
        "pose": ["Pose"],
        "rotations": ["rotation_from_vector", "vector_from_rotation"],
    },
)
