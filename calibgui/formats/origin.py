"""Marks by which the files that this program wrote are known, and so may be replaced by their like.

A mark stands near the beginning of a file, or near the end of a figure. Files that somebody else
made have none, and those that hold something else have another one.
"""

from __future__ import annotations

import os
import re
from collections.abc import Mapping

from calibgui.engine.files import open_regular

RESULT, CORNERS, CORNERS_CSV, BOARD_SHAPE = "result", "corners", "corners-csv", "board-shape"
FIGURE, LENS_COMPARISON, METHOD_COMPARISON = "figure", "lens-comparison", "method-comparison"
PAPER_PAGE, SERIES_CSV = "paper-page", "series-csv"
FLEET_TABLE, FLEET_PAGE, REPORT = "fleet-table", "fleet-page", "report"
EXPORT_PAGE, MANUAL = "export-page", "manual"
POSES, POSES_CSV, RAYS_CSV = "poses", "poses-csv", "rays-csv"
HAND_EYE, HAND_EYE_ROS, HAND_EYE_OPENCV = "hand-eye", "hand-eye-ros", "hand-eye-opencv"
RIG, SPACE_POINTS_CSV = "rig", "space-points-csv"
"""Kinds of files; those of exporters are the exporters' names."""
_LENGTH = 4096
"""Number of bytes at either end of a file in which its mark is."""
_OWN_WORDS: Mapping[str, re.Pattern[bytes]] = {
    RESULT: re.compile(rb'\A\s*\{\s*"format"\s*:\s*"calibgui-result"'),
    BOARD_SHAPE: re.compile(rb'\A\s*\{\s*"format"\s*:\s*"calibgui-plate"'),
    CORNERS_CSV: re.compile(rb"\Aimage,row,col,u_px,v_px,x_mm,y_mm"),
    FLEET_TABLE: re.compile(
        rb"\Aid,serial,date,temperature_c,|" + re.escape(b"Written by calibgui as fleet-table.")
    ),
    SERIES_CSV: re.compile(rb"\Avalue,file,model,fx,sigma_fx,"),
    POSES: re.compile(rb'\A\s*\{\s*"format"\s*:\s*"calibgui-poses"'),
    POSES_CSV: re.compile(rb"\Aimage,corners,rms_px,x_mm,y_mm,z_mm,"),
    HAND_EYE: re.compile(rb'\A\s*\{\s*"format"\s*:\s*"calibgui-hand-eye"'),
    RAYS_CSV: re.compile(rb"\Au_px,v_px,ray_x,ray_y,ray_z,"),
    RIG: re.compile(rb'\A\s*\{\s*"format"\s*:\s*"calibgui-rig"'),
    SPACE_POINTS_CSV: re.compile(rb"\Apoint,cameras,x_mm,y_mm,z_mm,"),
}
"""Patterns of the files that say in words of their own what they are."""


_TITLES: Mapping[str, str] = {
    RESULT: "a result.json",
    CORNERS: "a corners.json",
    CORNERS_CSV: "a table of corners",
    BOARD_SHAPE: "a board shape",
    FIGURE: "a figure",
    LENS_COMPARISON: "a comparison of lens models",
    METHOD_COMPARISON: "a comparison of methods",
    PAPER_PAGE: "a page on the paper",
    SERIES_CSV: "a table of settings",
    FLEET_TABLE: "a table of a fleet",
    POSES: "a file of poses",
    POSES_CSV: "a table of poses",
    RAYS_CSV: "a table of rays",
    RIG: "a rig",
    SPACE_POINTS_CSV: "a table of points",
    FLEET_PAGE: "a page on a fleet",
    EXPORT_PAGE: "a page on exports",
    MANUAL: "a manual",
    HAND_EYE: "a file of hand and eye",
    HAND_EYE_ROS: "a file for easy_handeye2",
    HAND_EYE_OPENCV: "a file of hand and eye for OpenCV",
    REPORT: "a report",
}


def describe_kind(kind: str) -> str:
    """Describe what a file of a kind is, as "a figure"; an exporter's as "an export to ros"."""
    return _TITLES.get(kind, f"an export to {kind}")


def make_mark(kind: str) -> str:
    """Return the sentence that marks a file of a kind, for a comment or a note in it."""
    return f"Written by calibgui as {kind}."


def is_own(path: str | os.PathLike[str], kind: str) -> bool:
    """Return whether this program wrote the file `path`, as a file of a kind.

    An empty file, which holds nothing that could be lost, counts as its own.

    Raises:
        CalibrationError: if `path` is a device or a pipe.
        OSError: if it cannot be read.
    """
    with open_regular(path) as file:
        size = os.fstat(file.fileno()).st_size
        ends = file.read(_LENGTH)
        file.seek(max(size - _LENGTH, 0))
        ends += file.read(_LENGTH)
    mark = _OWN_WORDS.get(kind) or re.compile(re.escape(make_mark(kind).encode()))
    return size == 0 or mark.search(ends) is not None
