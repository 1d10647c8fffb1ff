"""Sentences of the engine on rigs, and on hand and eye, as `sentences.py` looks them up."""

from __future__ import annotations

from PySide6.QtCore import QT_TRANSLATE_NOOP

HAND_EYE = (
    QT_TRANSLATE_NOOP(
        "Sentences",
        "Tool ± {0} mm, ± {1} degrees (k = 2); robot {2} %, camera {3} %, from {4} poses",
    ),
    QT_TRANSLATE_NOOP("Sentences", "The robot's poses are {0}."),
    QT_TRANSLATE_NOOP("Sentences", "angles a, b, c of {0} in degrees, {1}"),
    QT_TRANSLATE_NOOP("Sentences", "angles a, b, c of {0} in radians, {1}"),
    QT_TRANSLATE_NOOP("Sentences", "rotation vectors in degrees, {0}"),
    QT_TRANSLATE_NOOP("Sentences", "rotation vectors in radians, {0}"),
    QT_TRANSLATE_NOOP("Sentences", "before the place {0}"),
    QT_TRANSLATE_NOOP("Sentences", "quaternions {0}"),
    QT_TRANSLATE_NOOP("Sentences", "x, y, z, w, {0}"),
    QT_TRANSLATE_NOOP("Sentences", "w, x, y, z, {0}"),
    QT_TRANSLATE_NOOP("Sentences", "matrices row by row, {0}"),
    QT_TRANSLATE_NOOP("Sentences", "matrices column by column, {0}"),
    QT_TRANSLATE_NOOP("Sentences", "rotations transposed, {0}"),
    QT_TRANSLATE_NOOP("Sentences", "millimetres, {0}"),
    QT_TRANSLATE_NOOP("Sentences", "metres, {0}"),
    QT_TRANSLATE_NOOP("Sentences", "base from hand"),
    QT_TRANSLATE_NOOP("Sentences", "hand from base"),
    QT_TRANSLATE_NOOP("Sentences", "camera in the hand"),
    QT_TRANSLATE_NOOP("Sentences", "camera beside the robot"),
    QT_TRANSLATE_NOOP("Sentences", "Read so, the board scatters by {0} mm."),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "Read so, the board scatters by {0} mm, and by {1} mm in any other way.",
    ),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "A pose of the robot is off by {0} mm along each axis and by {1} degrees about "
        "each, one standard deviation.",
    ),
    QT_TRANSLATE_NOOP("Sentences", "The corners are off by {0} px."),
    QT_TRANSLATE_NOOP("Sentences", "The poses fit as well as {0}."),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "Turn the hand about more axes, or state where the camera is (above).",
    ),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "The order is shifted: each pose stands {0}, and was used for the photograph that it fits.",
    ),
    QT_TRANSLATE_NOOP("Sentences", "one line early"),
    QT_TRANSLATE_NOOP("Sentences", "one line late"),
    QT_TRANSLATE_NOOP("Sentences", "Correct the file."),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "{0} have the same pose of the robot: if it moved between them, the file is wrong.",
    ),
    QT_TRANSLATE_NOOP("Sentences", "Open: the camera may be turned about {0} of the hand."),
    QT_TRANSLATE_NOOP("Sentences", "Open: the camera may be turned about {0} of the base."),
    QT_TRANSLATE_NOOP("Sentences", "any axis"),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "Turn the hand about another axis as well, or move it without turning.",
    ),
    QT_TRANSLATE_NOOP("Sentences", "Open: the camera may be shifted along {0} of the hand."),
    QT_TRANSLATE_NOOP("Sentences", "Open: the camera may be shifted along {0} of the base."),
    QT_TRANSLATE_NOOP("Sentences", "All else is determined, and no ± counts this."),
    QT_TRANSLATE_NOOP("Sentences", "Turn the hand about {0}, or measure it."),
    QT_TRANSLATE_NOOP("Sentences", "a second axis"),
    QT_TRANSLATE_NOOP("Sentences", "two axes"),
    QT_TRANSLATE_NOOP("Sentences", "other axes"),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "The robot's pose does not fit in {0}: another moment, or a mistake in the file.",
    ),
    QT_TRANSLATE_NOOP("Sentences", "Leave it out {0}."),
    QT_TRANSLATE_NOOP("Sentences", "below"),
    QT_TRANSLATE_NOOP("Sentences", "Left out: {0}"),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "No ± counts the camera's errors: its file does not state them.",
    ),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "The robot's poses do not fit the photographs, however they are read: at best "
        "the board scatters by {0} mm in the robot's frame.",
    ),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "Check that they are the poses of these photographs in this order, and that "
        "board and camera stayed fixed, one to the hand and the other to the base.",
    ),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "By the robot's motions the board's squares are {0} times as long as stated.",
    ),
    QT_TRANSLATE_NOOP("Sentences", "State the side of a square as it was printed."),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "There are {0} different poses of the robot with a board; hand and eye need at least {1}.",
    ),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "Photograph the board from ten poses or more, turned about two axes at least.",
    ),
    QT_TRANSLATE_NOOP("Sentences", "{0} has {1} poses, and there are {2} photographs."),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "Give a pose for each photograph, in the order of their names, or name the "
        "photographs in the first column.",
    ),
    QT_TRANSLATE_NOOP("Sentences", "{0} names none of the photographs."),
    QT_TRANSLATE_NOOP("Sentences", "Name them as they are called, as {0}."),
    QT_TRANSLATE_NOOP("Sentences", "{0} holds no poses."),
)
"""On hand and eye, with the phrases that say how poses were read."""
RIGS = (
    QT_TRANSLATE_NOOP("Sentences", "Paired by their {0}: {1} of several cameras, the first {2}."),
    QT_TRANSLATE_NOOP("Sentences", "names"),
    QT_TRANSLATE_NOOP("Sentences", "numbers"),
    QT_TRANSLATE_NOOP("Sentences", "times, which are at most {0} ms apart"),
    QT_TRANSLATE_NOOP("Sentences", "1 instant"),
    QT_TRANSLATE_NOOP("Sentences", "{0} instants"),
    QT_TRANSLATE_NOOP("Sentences", "Without a partner: {0}."),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "{0} cameras at {1}: together they leave {2} px, each alone {3} px.",
    ),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "{0} cameras at {1}: together they leave {2} px, each alone {3} px, {4} times less.",
    ),
    QT_TRANSLATE_NOOP("Sentences", "They agree."),
    QT_TRANSLATE_NOOP("Sentences", "The instants disagree."),
    QT_TRANSLATE_NOOP("Sentences", "{0} is {1} ms {2} than {3}."),
    QT_TRANSLATE_NOOP("Sentences", "later"),
    QT_TRANSLATE_NOOP("Sentences", "earlier"),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "Single instants have {0} mm from where most have it beside {1}; the corners' "
        "noise explains {2} mm.",
    ),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "Photographs of one instant were not taken at quite the same moment, or the "
        "board bends in the hand.",
    ),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "Each ± counts it: put the board down for each picture, or trigger the cameras together.",
    ),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "The photographs of {0} belong to those of {1} of {2} earlier: nothing above holds.",
    ),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "The photographs of {0} belong to those of {1} of {2} later: nothing above holds.",
    ),
    QT_TRANSLATE_NOOP("Sentences", "Pair them so."),
    QT_TRANSLATE_NOOP("Sentences", "Exchanged with those of {0}: {1}."),
    QT_TRANSLATE_NOOP("Sentences", "They are left out; give them back their names."),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "The squares were counted {0} times as long as in the others in {1}, and the "
        "photographs of {2} beside them.",
    ),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "They are left out: is that another board, or another --square?",
    ),
    QT_TRANSLATE_NOOP("Sentences", "{0} stands {1} mm otherwise beside {2} from {3} on."),
    QT_TRANSLATE_NOOP("Sentences", "Calibrate the photographs before and after it by themselves."),
    QT_TRANSLATE_NOOP("Sentences", "The boards stand {0} mm otherwise to each other from {1} on."),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "Fasten them, or calibrate the photographs before and after it by themselves.",
    ),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "The focal length of {0} is {1} times as long from {2} on: it was refocused or zoomed.",
    ),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "Left out, as the board is elsewhere than in the other cameras' photographs of "
        "the instant: {0}.",
    ),
    QT_TRANSLATE_NOOP("Sentences", "Were they taken at another instant?"),
    QT_TRANSLATE_NOOP("Sentences", "Those that agree least with the other cameras: {0}."),
    QT_TRANSLATE_NOOP("Sentences", "Counted from another end of the board, and turned back: {0}."),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "Where {0} stands beside {1} is open: no two cameras saw them at one instant.",
    ),
    QT_TRANSLATE_NOOP("Sentences", "Nothing else depends on it."),
    QT_TRANSLATE_NOOP("Sentences", "{0} deviates from its drawing by {1} mm rms, at most {2} mm."),
    QT_TRANSLATE_NOOP("Sentences", "board {0}"),
    QT_TRANSLATE_NOOP("Sentences", "Board {0}"),
    QT_TRANSLATE_NOOP("Sentences", "The board"),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "The board moved while the cameras' clocks did not agree: with one offset in "
        "time for each camera they leave {0} px.",
    ),
    QT_TRANSLATE_NOOP("Sentences", "--offsets estimates these."),
    QT_TRANSLATE_NOOP("Sentences", "The kind or the size of {0} is not stated."),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "State both of each board (--target and --board on the command line).",
    ),
    QT_TRANSLATE_NOOP("Sentences", "Nothing is stated of {0} that tells it from the other boards."),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "Several boards have markers or tags: state --target and --board of each, and "
        "the --dictionary of a ChArUco board, the --family of one with AprilTags.",
    ),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "The markers {0} to {1} of {2} are on {3} and on {4}: photographs do not tell "
        "the boards apart.",
    ),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "The tags {0} to {1} of {2} are on {3} and on {4}: photographs do not tell the "
        "boards apart.",
    ),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "The cameras fall apart into {0} groups that never see the board together: {1}.",
    ),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "The cameras fall apart into {0} groups that nothing joins: {1}.",
    ),
    QT_TRANSLATE_NOOP("Sentences", "{0} shows no board of {1} in any photograph, and {2} does."),
    QT_TRANSLATE_NOOP(
        "Sentences",
        "A rig takes one board before all cameras: photograph the same one, or leave "
        "out the camera that saw another.",
    ),
    QT_TRANSLATE_NOOP("Sentences", "Photographs of {0} cameras: {1}."),
)
"""On rigs: their pairing, how well they agree, and what is wrong with them."""
