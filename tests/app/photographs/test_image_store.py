from __future__ import annotations

import hashlib
from pathlib import Path

import cv2
import numpy as np
import pytest

from calibgui.app.photographs.image_store import ImageStore, read_thumbnail
from calibgui.engine.errors import CalibrationError
from calibgui.engine.images.reading import read_image, stretch_levels, write_image
from calibgui.engine.opencv import halve_image


def test_a_thumbnail_tells_size_and_digest(tmp_path: Path) -> None:
    pixels = np.tile(np.linspace(0, 60000, 800).astype(np.uint16), (600, 1))
    path = tmp_path / "ramp.png"
    write_image(path, pixels)
    thumbnail = read_thumbnail(str(path))
    assert thumbnail.size == (800, 600)
    assert thumbnail.grey.dtype == np.uint8
    assert 96 <= max(thumbnail.grey.shape) < 384
    assert thumbnail.grey[:, 0].max() < 10 < 245 < thumbnail.grey[:, -1].min()
    assert thumbnail.digest == hashlib.sha256(path.read_bytes()).hexdigest()
    with pytest.raises(CalibrationError, match="missing"):
        read_thumbnail(str(tmp_path / "missing.png"))


def test_a_photograph_is_read_small_as_it_would_be_made_small(tmp_path: Path) -> None:
    u, v = np.meshgrid(np.linspace(0, 9, 1600), np.linspace(0, 7, 1201))
    path = tmp_path / "waves.jpg"
    cv2.imwrite(str(path), (120 + 100 * np.sin(u) * np.cos(v)).astype(np.uint8))
    thumbnail = read_thumbnail(str(path))
    small = read_image(path).pixels
    while max(small.shape) >= 384:
        small = halve_image(small)
    assert thumbnail.size == (1600, 1201)
    rows, cols = small.shape
    near = thumbnail.grey[:rows, :cols].astype(float) - stretch_levels(small)
    assert np.abs(near).mean() < 2


def test_memory_is_bounded_and_the_last_used_stay(tmp_path: Path) -> None:
    paths = [str(tmp_path / f"{k}.pgm") for k in range(4)]
    for k, path in enumerate(paths):
        write_image(path, np.full((50, 40), k, np.uint8))
    store = ImageStore(memory=3 * 50 * 40)
    for path in paths[:3]:
        store.read(path)
    store.read(paths[0])
    store.read(paths[3])
    assert store.size <= 3 * 50 * 40
    assert store.kept(paths[1]) is None
    assert store.kept(paths[0]) is store.read(paths[0])
    store.forget(paths[0])
    assert store.kept(paths[0]) is None


def test_images_are_turned_as_the_caller_says(tmp_path: Path) -> None:
    path = str(tmp_path / "a.pgm")
    write_image(path, np.zeros((50, 40), np.uint8))
    assert ImageStore(find_orientation={path: 6}.get).read(path).size == (50, 40)
    assert ImageStore().read(path).size == (40, 50)


def test_one_image_larger_than_the_bound_is_kept(tmp_path: Path) -> None:
    path = str(tmp_path / "big.pgm")
    write_image(path, np.zeros((50, 40), np.uint8))
    store = ImageStore(memory=10)
    assert store.read(path) is store.kept(path)
