"""Rectified pairs of photographs of a rig, and both beside each other with lines along rows."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import cast

import numpy as np

from calibgui.app.outputs.output_files import identify_file, make_folder
from calibgui.engine.errors import CalibrationError
from calibgui.engine.images import Pixels, read_colour, write_image
from calibgui.engine.rig import StereoPair, rectify_stereo_image

_LINES = 16
"""Number of lines across a pair."""
_LINE = np.array([255, 60, 60])
"""Colour of the lines, RGB."""


def write_stereo_images(
    pair: StereoPair,
    names: tuple[str, str],
    photographs: Sequence[tuple[str, Path, Path]],
    folder: Path,
    progress: Callable[[int, int], None] = lambda *_: None,
    overwrite: bool = False,
) -> list[Path]:
    """Write rectified photographs.

    Args:
        pair: the two cameras.
        names: their names, after which the folders of their images are named.
        photographs: the name of each instant, and the photographs of both cameras.
        folder: where the folders are made, and one with pairs of images beside each other.
        progress: called with the numbers of finished instants, and of all.
        overwrite: whether files may be replaced.

    Returns:
        The files that were written.

    Raises:
        CalibrationError: if a photograph cannot be read or has another size than its camera, or a
            file exists or cannot be written.
    """
    folders = (folder / names[0], folder / names[1], folder / "pairs")
    targets = [[place / f"{name}.png" for place in folders] for name, *_ in photographs]
    read = {identify_file(path) for _, *both in photographs for path in both}
    for target in (each for row in targets for each in row):
        if target.exists() and (not overwrite or identify_file(target) in read):
            raise CalibrationError(
                f"{target} exists.", "Choose another folder, or add --overwrite to replace it."
            )
    for place in folders:
        make_folder(place)
    for done, (row, (_, *both)) in enumerate(zip(targets, photographs, strict=True), 1):
        made = [
            cast(Pixels, rectify_stereo_image(read_colour(path), pair, which).image)
            for which, path in enumerate(both)
        ]
        for target, image in zip(row, [*made, join_images(made, pair.is_upright)], strict=True):
            write_image(target, image)
        progress(done, len(photographs))
    return [each for row in targets for each in row]


def join_images(images: Sequence[Pixels], is_upright: bool) -> Pixels:
    """Return two images beside each other, or below each other, with lines across both."""
    colour = [
        np.repeat(image[..., None], 3, axis=2) if image.ndim == 2 else image for image in images
    ]
    joined = np.concatenate(colour, axis=0 if is_upright else 1)
    across = joined.swapaxes(0, 1) if is_upright else joined  # a view: lines are drawn in place
    rows = np.linspace(0, len(across), _LINES + 1, dtype=int)[1:-1]
    across[rows] = _LINE * (np.iinfo(joined.dtype).max // 255)
    return np.ascontiguousarray(joined)
