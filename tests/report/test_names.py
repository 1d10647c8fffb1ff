"""Names of files as people read them."""

from __future__ import annotations

import pytest

from calibgui.report.names import distinguish_paths, join_words, number_names


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


@pytest.mark.parametrize(
    ("paths", "ends"),
    [
        (["/x/18.json", "/x/35.json"], ["18.json", "35.json"]),
        (["/x/18/result.json", "35/result.json"], ["18/result.json", "35/result.json"]),
        (["a/18/r.json", "b/18/r.json", "c/r.json"], ["a/18/r.json", "b/18/r.json", "c/r.json"]),
        (["r.json", "a/r.json"], ["r.json", "a/r.json"]),
        (["a/r.json", "a/r.json"], ["r.json", "r.json"]),
        ([], []),
    ],
)
def test_paths_are_as_long_as_tells_them_apart(paths: list[str], ends: list[str]) -> None:
    assert distinguish_paths(paths) == ends


def test_words_are_joined_by_commas_and_one_and() -> None:
    assert [join_words("abc"[:count]) for count in range(4)] == ["", "a", "a and b", "a, b and c"]
