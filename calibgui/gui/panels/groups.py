"""The groups of panels and what else the inspector shows, known before any panel is loaded."""

from __future__ import annotations

from collections.abc import Callable
from enum import StrEnum
from typing import NamedTuple

from PySide6.QtCore import QCoreApplication


class Page(NamedTuple):
    """Something that the inspector shows."""

    title: str
    """Its name."""
    tip: str
    """A sentence on what it is for."""
    show: Callable[[], object]
    """The function that brings it to the front."""


class Group(StrEnum):
    """What panels are for."""

    ANSWER = "answer"
    """What was found, and how far it is to be trusted."""
    EVIDENCE = "evidence"
    """What speaks for it and against it."""
    METHOD = "method"
    """How it was found, and what else could have been."""


def name_group(group: Group) -> str:
    """Return the name of a group for the user."""
    translate = QCoreApplication.translate
    return {
        Group.ANSWER: translate("groups", "Answer"),
        Group.EVIDENCE: translate("groups", "Evidence"),
        Group.METHOD: translate("groups", "Method"),
    }[group]


def describe_group(group: Group) -> str:
    """Return in a sentence what the panels of a group are for."""
    translate = QCoreApplication.translate
    return {
        Group.ANSWER: translate("groups", "The camera, and how well it is known."),
        Group.EVIDENCE: translate("groups", "What the views say for and against the camera."),
        Group.METHOD: translate("groups", "How the camera was found, and what else could be."),
    }[group]
