"""The window's words for the kinds of boards: one entry for each in ``engine.boards.KINDS``."""

from __future__ import annotations

from typing import NamedTuple

from PySide6.QtCore import QCoreApplication

from calibgui.engine.boards import AprilGrid, Pattern

translate = QCoreApplication.translate


class PatternTexts(NamedTuple):
    """The words for one kind of board."""

    name: str
    """Its name in the list of kinds."""
    recognised: str
    """The sentence that says that photographs show it."""
    search: str
    """The button that searches for it."""


def list_pattern_texts() -> dict[str, PatternTexts]:
    """Return the words for every kind of board, in the user's language."""
    return {
        "checkerboard": PatternTexts(
            translate("PatternTexts", "Checkerboard"),
            translate("PatternTexts", "These look like photographs of a checkerboard."),
            translate("PatternTexts", "&Search for a checkerboard"),
        ),
        "charuco": PatternTexts(
            translate("PatternTexts", "ChArUco board"),
            translate("PatternTexts", "These look like photographs of a ChArUco board."),
            translate("PatternTexts", "&Search for a ChArUco board"),
        ),
        "circles": PatternTexts(
            translate("PatternTexts", "Circles"),
            translate("PatternTexts", "These look like photographs of a grid of circles."),
            translate("PatternTexts", "&Search for circles"),
        ),
        "asymmetric-circles": PatternTexts(
            translate("PatternTexts", "Asymmetric circles"),
            translate(
                "PatternTexts", "These look like photographs of an asymmetric grid of circles."
            ),
            translate("PatternTexts", "&Search for asymmetric circles"),
        ),
        "listed-circles": PatternTexts(
            translate("PatternTexts", "Circles of a list"),
            translate("PatternTexts", "These look like photographs of listed circles."),
            translate("PatternTexts", "&Search for listed circles"),
        ),
        "aprilgrid": PatternTexts(
            translate("PatternTexts", "AprilGrid"),
            translate("PatternTexts", "These look like photographs of an AprilGrid."),
            translate("PatternTexts", "&Search for an AprilGrid"),
        ),
        "tagged-checkerboard": PatternTexts(
            translate("PatternTexts", "Checkerboard with tags"),
            translate(
                "PatternTexts", "These look like photographs of a checkerboard with AprilTags."
            ),
            translate("PatternTexts", "&Search for a checkerboard with tags"),
        ),
        "puzzleboard": PatternTexts(
            translate("PatternTexts", "PuzzleBoard"),
            translate("PatternTexts", "These look like photographs of a PuzzleBoard."),
            translate("PatternTexts", "&Search for a PuzzleBoard"),
        ),
    }


def name_points(pattern: Pattern) -> str:
    """Name what is counted on a board, in the user's language."""
    if not pattern.has_squares:
        return translate("PatternTexts", "Circles")
    if isinstance(pattern, AprilGrid):
        return translate("PatternTexts", "Corners")
    return translate("PatternTexts", "Inner corners")


def name_side(pattern: Pattern) -> str:
    """Name the length that a board's others are measured by, in the user's language."""
    if not pattern.has_squares:
        return translate("PatternTexts", "Distance")
    if isinstance(pattern, AprilGrid):
        return translate("PatternTexts", "Tag")
    return translate("PatternTexts", "Square")
