"""Names of files as people read them."""

from __future__ import annotations

import pytest

from calibgui.report.names import number_names


@pytest.mark.parametrize(
    ("names", "numbers"),
    [
        (["a/Image2.tif", "a/Image10.tif"], ["2", "10"]),
        (["IMG_2001.jpg", "IMG_2019.jpg"], ["01", "19"]),
        (["left01.png", "right01.png"], ["1", "2"]),  # the number alone does not tell them apart
        (["a/1.png", "b/1.png"], ["1", "2"]),
        (["near.png", "far.png"], ["1", "2"]),
        (["board7.png"], ["7"]),
        ([], []),
    ],
)
def test_a_number_is_the_names_own_or_its_place(names: list[str], numbers: list[str]) -> None:
    assert number_names(names) == numbers
