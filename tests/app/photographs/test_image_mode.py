"""The mode of images is guessed from their size where that tells it."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.app.photographs.image_mode import guess_mode
from calibgui.engine.arrays import Size
from calibgui.engine.camera import describe_mode
from calibgui.engine.errors import CalibrationError

VGA, HD, STILL = (640, 480), (1920, 1080), (4000, 3000)


@pytest.mark.parametrize(
    ("full", "size", "words"),
    [
        (VGA, VGA, "the whole of 640 x 480 px"),
        (VGA, (320, 240), "the whole of 640 x 480 px, scaled by 0.5"),
        (VGA, (1280, 960), "the whole of 640 x 480 px, scaled by 2"),
        ((4056, 3040), (1014, 760), "the whole of 4056 x 3040 px, scaled by 0.25"),
        (VGA, (640, 360), "columns 0 to 639 and rows 60 to 419 of 640 x 480 px"),
        (HD, (1440, 1080), "columns 240 to 1679 and rows 0 to 1079 of 1920 x 1080 px"),
        (VGA, (1280, 720), "columns 0 to 639 and rows 60 to 419 of 640 x 480 px, scaled by 2"),
        (
            HD,
            (2560, 1920),
            "columns 240 to 1679 and rows 0 to 1079 of 1920 x 1080 px, scaled by 1.7",
        ),
    ],
)
def test_what_the_numbers_tell(full: Size, size: Size, words: str) -> None:
    mode = guess_mode(full, size)
    assert (mode.full, mode.size) == (full, size)
    assert describe_mode(mode).startswith(words)


def test_size_is_rounded_to_whole_pixels() -> None:
    mode = guess_mode((641, 481), (320, 240))
    np.testing.assert_allclose(mode.factor, [320 / 641, 240 / 481])


def test_both_options_are_named_where_two_modes_explain_it() -> None:
    with pytest.raises(CalibrationError) as raised:
        guess_mode(STILL, HD)
    assert "--crop 1040,960,1920x1080 is the middle" in raised.value.hint
    assert "--crop 0,375,4000x2250 --to-size 1920x1080" in raised.value.hint


@pytest.mark.parametrize("size", [(480, 640), (1080, 1920), (640, 500), (700, 480), (4000, 1000)])
def test_aspect_that_no_mode_explains_is_refused(size: Size) -> None:
    with pytest.raises(CalibrationError, match="no crop of the middle and no scale"):
        guess_mode(VGA, size)
