"""The corners that a subcommand works on: searched in photographs, or read from a file."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import replace
from fnmatch import fnmatchcase
from pathlib import Path

from calibgui.app.photographs.paths import describe_unread_folders, describe_unread_photographs
from calibgui.app.photographs.videos import FrameChoice
from calibgui.app.rig.camera_names import find_named_cameras, list_cameras
from calibgui.cli.arguments import (
    add_image_paths,
    add_scale_option,
    add_search_options,
    is_corners_file,
    open_input,
    require_board,
    search_images,
)
from calibgui.cli.boards import add_board_options, is_pattern_open, read_pattern_options
from calibgui.cli.camera import add_size_option
from calibgui.cli.console import Console
from calibgui.dataset import CornerSet
from calibgui.engine.errors import CalibrationError
from calibgui.engine.features import METHODS
from calibgui.engine.images import is_video
from calibgui.formats.corner_import import read_corner_file
from calibgui.report.boards import describe_recognised_board
from calibgui.report.tables import fill_lines


def add_photograph_options(parser: argparse.ArgumentParser, need: str, nargs: str = "+") -> None:
    """Add the paths of photographs, and the options on board and search.

    Args:
        parser: the parser to add them to.
        need: what the help says of the side of a square: what depends on it.
        nargs: number of paths, as argparse has it.
    """
    add_image_paths(parser, nargs)
    add_search_options(parser)
    add_board_options(parser)
    add_scale_option(parser, need)


def add_corner_options(parser: argparse.ArgumentParser, need: str) -> None:
    """Add the options on photographs, whose paths may name a file of corners instead.

    Args:
        parser, need: as for `add_photograph_options`.
    """
    add_photograph_options(parser, need)
    add_size_option(parser)
    parser.add_argument(
        "--exclude",
        nargs="+",
        default=(),
        metavar="IMAGE",
        help="images to leave out, by names, paths or 'patter*ns'",
    )


def check_corner_options(options: argparse.Namespace) -> None:
    """End the program if the options on board and search do not fit the paths."""
    if is_corners_file(options.paths):
        searched = (options.roi, options.target, options.layout, options.field)
        if any(searched) or options.corners != METHODS[0]:
            options.usage_error(
                "--roi, --target, --layout, --field and --corners are for photographs, not for a "
                "corners file"
            )
    elif any(is_corners_file([path]) for path in options.paths):
        options.usage_error("a corners file is calibrated by itself")


def read_or_search(options: argparse.Namespace, console: Console) -> CornerSet:
    """Return the views that the options of `add_corner_options` name.

    Args:
        options: the options; --square replaces the side of the squares in a corners.json.
        console: shows progress, and what is recognised of the board.

    Raises:
        CalibrationError: if the corners or photographs cannot be read.
    """
    if is_corners_file(options.paths):
        return _exclude_images(_read_corners_file(options), options.exclude)
    corner_set, remarks = search_board(options, console)
    for remark in remarks:
        console.print_text(fill_lines(remark, "", "  ") + "\n")
    return _exclude_images(corner_set, options.exclude)


def search_board(options: argparse.Namespace, console: Console) -> tuple[CornerSet, list[str]]:
    """Search photographs for the board that the options describe.

    Args:
        options: those of `add_photograph_options`.
        console: shows progress, and what is wrong with the images if none shows the board.

    Returns:
        The views, and sentences on what is recognised of the board, and on what was not searched.

    Raises:
        CalibrationError: if no photograph can be read, or none shows the board.
    """
    pattern = read_pattern_options(options)
    is_open = is_pattern_open(options)
    detection = search_images(
        console,
        options.paths,
        options.board,
        options.roi,
        options.corners,
        None if is_open else pattern,
        FrameChoice(options.frames, _choose_frames_folder(options)),
        options.field,
    )
    require_board(detection, options.board, console, is_open)
    corner_set = detection.corner_set(options.square, options.square_sigma)
    remarks = (
        describe_recognised_board(pattern, corner_set),
        detection.remark,
        describe_unread_folders(options.paths),
        describe_unread_photographs(options.paths),
        _describe_rig(options.paths),
    )
    return corner_set, [remark for remark in remarks if remark]


def _describe_rig(paths: Sequence[str]) -> str:
    """Say which cameras photographs are of, and how a rig is made of them; empty if of one."""
    photographs = [path for path in paths if not (Path(path).is_file() and is_video(path))]
    groups = find_named_cameras(photographs) if photographs else {}
    if not groups:
        return ""
    named = paths[0] if len(paths) == 1 else "FOLDER"
    return (
        f"By their names the photographs are of several cameras: {list_cameras(groups)}. "
        f"`calibgui rig {named} --square MM` calibrates each, and how they stand to each other; "
        "here all are taken for photographs of one camera."
    )


def _choose_frames_folder(options: argparse.Namespace) -> Path:
    """Return the folder for frames of videos: as stated, or else that of the output, if any."""
    output = getattr(options, "output", None)
    beside = output.parent if isinstance(output, Path) else Path()
    return beside if options.frames_folder is None else Path(options.frames_folder)


def _exclude_images(corner_set: CornerSet, names: Sequence[str]) -> CornerSet:
    """Return the views with those of some images left out.

    Args:
        corner_set: the views.
        names: names or paths of images, or patterns as a shell has them of either.

    Raises:
        CalibrationError: for a name that no image has, and a pattern that none fits.
    """
    images = [view.image for view in corner_set.views]
    excluded: set[str] = set()
    for name in names:
        named = [each for each in images if name in (each, Path(each).name)] or [
            each for each in images if fnmatchcase(each, name) or fnmatchcase(Path(each).name, name)
        ]
        if not named:
            raise CalibrationError(
                f"There is no image {name!r} to leave out.",
                "Give the name of one of the images, as it is listed, its path, or a pattern "
                "that fits the names of some.",
            )
        excluded.update(named)
    views = tuple(
        replace(view, enabled=False) if view.image in excluded else view
        for view in corner_set.views
    )
    return replace(corner_set, views=views) if names else corner_set


def _read_corners_file(options: argparse.Namespace) -> CornerSet:
    """Return the views of a file of corners; --square replaces the side of the board's squares."""
    with open_input(options.paths[0]) as file:
        return read_corner_file(
            file, options.board, options.square, options.size, options.square_sigma
        )
