"""The modes of the desk and what each shows, known before any panel is loaded."""

from __future__ import annotations

from collections.abc import Callable
from enum import StrEnum
from typing import NamedTuple

from PySide6.QtCore import QCoreApplication


class Page(NamedTuple):
    """Something that the window shows."""

    title: str
    """Its name."""
    tip: str
    """A sentence on what it is for."""
    show: Callable[[], object]
    """The function that brings it to the front."""


class Mode(StrEnum):
    """A mode of the window, which fills the desk."""

    PHOTOGRAPHS = "photographs"
    METHOD = "method"
    FIT = "fit"
    LENS = "lens"
    BOARD = "board"
    SPACE = "space"
    UNDISTORT = "undistort"
    COMPARE = "compare"


def name_mode(mode: Mode) -> str:
    """Return the name of a mode for the user."""
    translate = QCoreApplication.translate
    return {
        Mode.PHOTOGRAPHS: translate("modes", "Photographs"),
        Mode.METHOD: translate("modes", "Method"),
        Mode.FIT: translate("modes", "Fit"),
        Mode.LENS: translate("modes", "Lens"),
        Mode.BOARD: translate("modes", "Board"),
        Mode.SPACE: translate("modes", "3-D"),
        Mode.UNDISTORT: translate("modes", "Undistort"),
        Mode.COMPARE: translate("modes", "Compare"),
    }[mode]


def describe_mode(mode: Mode) -> str:
    """Return in a sentence what a mode shows."""
    translate = QCoreApplication.translate
    return {
        Mode.PHOTOGRAPHS: translate("modes", "The photographs, and what was found in them."),
        Mode.METHOD: translate("modes", "How the camera was found, step by step as in the paper."),
        Mode.FIT: translate("modes", "How well the photographs agree, and every value."),
        Mode.LENS: translate("modes", "What the lens does, and which model describes it."),
        Mode.BOARD: translate("modes", "How the real board differs from the drawing."),
        Mode.SPACE: translate("modes", "Where the board was held, and where to hold it next."),
        Mode.UNDISTORT: translate("modes", "Photographs without the distortion of the lens."),
        Mode.COMPARE: translate("modes", "Two results side by side."),
    }[mode]
