"""Sentences of the engine in the user's language: those that are most often in sight.

The engine speaks English. A sentence is looked up with its numbers and names taken out, and what is
not listed stays as it is.
"""

from __future__ import annotations

import re
from functools import cache

from PySide6.QtCore import QT_TRANSLATE_NOOP, QCoreApplication

from calibgui.gui.verdict.rig_sentences import HAND_EYE, RIGS

_CONTEXT = "Sentences"
_PLACE = re.compile(r"\\{\d\\}")
_END = re.compile(r"(?<=\.) (?=[A-Z])")
"""Where a sentence ends and another begins."""
LISTED = (
    QT_TRANSLATE_NOOP("Sentences", "The photographs show nothing wrong."),
    QT_TRANSLATE_NOOP("Sentences", "The views do not determine the camera."),
    QT_TRANSLATE_NOOP("Sentences", "The calibration is not finished."),
    QT_TRANSLATE_NOOP("Sentences", "The camera is not known well enough: add photographs."),
    QT_TRANSLATE_NOOP("Sentences", "One view cannot be checked."),
    QT_TRANSLATE_NOOP("Sentences", "{0} views are too few."),
    QT_TRANSLATE_NOOP(
        "Sentences", "{0} views are too few: take {1} or more, tilted in all directions."
    ),
    QT_TRANSLATE_NOOP("Sentences", "Nothing needs to be done: the camera is known to {0} px."),
    QT_TRANSLATE_NOOP("Sentences", "The camera is known to {0} px."),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "The photographs show nothing wrong, but the camera is known to {0} px only: add "
        "photographs.",
    ),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "Nothing is wrong where corners were seen: the camera is known to {0} px.",
    ),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "Beyond them it is known to {0} px: hold the board closer to the image's edges.",
    ),
    QT_TRANSLATE_NOOP(
        "Sentences", "Beyond them it is not known: hold the board closer to the image's edges."
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
    QT_TRANSLATE_NOOP("Sentences", "The lens model {0} does not follow this lens."),
    QT_TRANSLATE_NOOP("Sentences", "{0} does not belong to the others."),
    QT_TRANSLATE_NOOP("Sentences", "{0} do not belong to the others."),
    QT_TRANSLATE_NOOP("Sentences", "{0} is blurred, which does no harm here."),
    QT_TRANSLATE_NOOP("Sentences", "{0} are blurred, which does no harm here."),
    QT_TRANSLATE_NOOP("Sentences", "The images were scaled, by the camera or a program."),
    QT_TRANSLATE_NOOP(
        "Sentences", "One view does not determine a camera, which leaves {0} unknown."
    ),
    QT_TRANSLATE_NOOP("Sentences", "The focal length differs between the views."),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "Switch autofocus and stabilisation off, and do not touch zoom and focus.",
    ),
    QT_TRANSLATE_NOOP("Sentences", "Some views show the corners less well than the others."),
    *HAND_EYE,
    *RIGS,
)
"""The sentences, with places for numbers, names, and phrases that are listed themselves."""


def translate_sentences(text: str) -> str:
    """Return a text of the engine with the sentences that are listed in the user's language."""
    return " ".join(map(_translate, _END.split(text)))


def _translate(sentence: str) -> str:
    for listed in map(str, LISTED):
        if (found := _compile(listed).fullmatch(sentence)) is not None:
            return QCoreApplication.translate(_CONTEXT, listed).format(
                *map(_translate, found.groups())
            )
    return sentence


@cache
def _compile(listed: str) -> re.Pattern[str]:
    """Return the pattern of a listed sentence, with a group for each place."""
    return re.compile(_PLACE.sub("(.+)", re.escape(listed)))
