"""Sentences of the engine in the user's language: those that are most often in sight.

The engine speaks English. A sentence is looked up with its numbers taken out, and what is not
listed stays as it is.
"""

from __future__ import annotations

import re

from PySide6.QtCore import QT_TRANSLATE_NOOP, QCoreApplication

_CONTEXT = "Sentences"
_NUMBER = re.compile(r"\d+(?:\.\d+)?(?:e[+-]?\d+)?")
_END = re.compile(r"(?<=\.) (?=[A-Z])")
"""Where a sentence ends and another begins."""
LISTED = (
    QT_TRANSLATE_NOOP("Sentences", "The photographs show nothing wrong."),
    QT_TRANSLATE_NOOP("Sentences", "The views do not determine the camera."),
    QT_TRANSLATE_NOOP("Sentences", "The calibration is not finished."),
    QT_TRANSLATE_NOOP("Sentences", "Pixels are known too poorly."),
    QT_TRANSLATE_NOOP("Sentences", "One view cannot be checked."),
    QT_TRANSLATE_NOOP("Sentences", "{0} views are too few."),
    QT_TRANSLATE_NOOP(
        "Sentences", "{0} views are too few: take {1} or more, tilted in all directions."
    ),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "Nothing needs to be done: pixels among corners are known to {0} px or better.",
    ),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "The photographs show nothing wrong, but pixels are known to {0} px where they are known "
        "worst among corners: add views.",
    ),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "Nothing is wrong among corners, where pixels are known to {0} px; beyond them they are "
        "known to {1} px: bring corners closer to the image's edge.",
    ),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "Add views with the board tilted by {0} to {1} degrees in different directions and all "
        "over the image; six good ones are enough.",
    ),
    QT_TRANSLATE_NOOP("Sentences", "The views are too few, or too much alike."),
    QT_TRANSLATE_NOOP("Sentences", "Your board is not printed true."),
    QT_TRANSLATE_NOOP("Sentences", "Your board is not flat."),
    QT_TRANSLATE_NOOP("Sentences", "Your board is not flat, or not printed true."),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "Your board is not flat ({0} mm): its shape was estimated; errors {1} times smaller.",
    ),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "Your board is not printed true ({0} mm): its shape was estimated; errors {1} times "
        "smaller.",
    ),
    QT_TRANSLATE_NOOP("Sentences", "The lens model does not follow this lens."),
    QT_TRANSLATE_NOOP("Sentences", "The focal length differs between the views."),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "Switch autofocus and stabilisation off, and do not touch zoom and focus.",
    ),
    QT_TRANSLATE_NOOP("Sentences", "Some views show the corners less well than the others."),
)
"""The sentences, with places for their numbers."""


def translate_sentences(text: str) -> str:
    """Return a text of the engine with the sentences that are listed in the user's language."""
    return " ".join(map(_translate, _END.split(text)))


def _translate(sentence: str) -> str:
    numbers = _NUMBER.findall(sentence)
    places = iter(range(len(numbers)))
    listed = _NUMBER.sub(lambda _: f"{{{next(places)}}}", sentence)
    if listed not in LISTED:
        return sentence
    return QCoreApplication.translate(_CONTEXT, listed).format(*numbers)
