"""The switches of the ablation, by kind of board, and those of assessment."""

from __future__ import annotations

from tests.benchmarks.ablation.patching import Switch
from tests.benchmarks.ablation.switches_of_boards import (
    APRILGRID,
    CHARUCO,
    CIRCLES,
    PUZZLEBOARD,
)
from tests.benchmarks.ablation.switches_of_causes import ASSESSMENT
from tests.benchmarks.ablation.switches_of_checkerboards import CHECKERBOARD

SWITCHES: dict[str, list[Switch]] = {
    "checkerboard": CHECKERBOARD,
    "charuco": CHARUCO,
    "aprilgrid": APRILGRID,
    "puzzleboard": PUZZLEBOARD,
    "circles": CIRCLES,
    "assessment": ASSESSMENT,
}
