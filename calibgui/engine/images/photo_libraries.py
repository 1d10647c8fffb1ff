"""Photographs of phones (HEIC, AVIF) and cameras' raw images, by libraries that may be installed.

pillow-heif and rawpy come with the extra `photos`; without it such files are refused. A HEIC image
is turned by its decoder, as its EXIF orientation repeats; a raw image is developed in 16 bits with
the camera's white balance, without brightening, and neither turned nor corrected for its lens.
"""

from __future__ import annotations

import io
from dataclasses import replace
from importlib import import_module
from importlib.util import find_spec
from typing import Any

import numpy as np

from calibgui.engine.images.exif import Exif, read_exif, read_tiff
from calibgui.engine.images.headers import Data, ForeignKind, Header

_LIBRARIES = {ForeignKind.HEIF: "pillow_heif", ForeignKind.RAW: "rawpy"}
SUFFIXES = {
    ForeignKind.HEIF: (".heic", ".heif", ".hif", ".avif"),
    ForeignKind.RAW: (
        *(".dng", ".cr2", ".cr3", ".nef", ".arw"),
        *(".raf", ".orf", ".rw2", ".pef", ".gpr"),
    ),
}
"""Suffixes of the files."""
_ORIENTATION_BY_FLIP = {0: 1, 3: 3, 5: 8, 6: 6}
"""EXIF orientations of LibRaw's turns."""


def is_library_installed(kind: ForeignKind) -> bool:
    """Return whether photographs of a kind can be read here."""
    return kind in _LIBRARIES and find_spec(_LIBRARIES[kind]) is not None


def list_suffixes() -> tuple[str, ...]:
    """List the suffixes of the photographs that can be read here."""
    return tuple(
        suffix
        for kind, suffixes in SUFFIXES.items()
        if is_library_installed(kind)
        for suffix in suffixes
    )


def read_photo_header(kind: ForeignKind, data: Data) -> Header | None:
    """Return the header of a photograph of a kind whose library is installed; None if it is damaged
    or packed in a way that the library does not know."""
    return _use_library(_read_heif_header if kind is ForeignKind.HEIF else _read_raw_header, data)


def decode_photo(kind: ForeignKind, data: Data, colour: bool) -> Any:
    """Return the pixels of a photograph, RGB (h, w, 3) or grey (h, w); None if it is damaged.

    Those of a HEIC image are turned by its orientation, those of a raw image are not.
    """
    pixels: Any = _use_library(_decode_heif if kind is ForeignKind.HEIF else _decode_raw, data)
    if pixels is None:
        return None
    if pixels.ndim == 3:  # without transparency, and of a camera without colours in one plane
        pixels = pixels[..., :3] if pixels.shape[2] >= 3 else pixels[..., 0]
    if colour or pixels.ndim == 2:
        return pixels
    # Weights of grey levels: ITU-R BT.601, as OpenCV's.
    grey = pixels @ np.array([0.299, 0.587, 0.114], np.float32)
    return np.rint(grey, out=grey).astype(pixels.dtype)


def _use_library(read: Any, data: Data) -> Any:
    """Return what a function reads of a file; None for whatever a library raises on damage."""
    try:
        return read(io.BytesIO(bytes(data)))
    except Exception:  # the libraries see nothing but the file: what they raise is its fault
        return None


def _read_heif_header(file: io.BytesIO) -> Header:
    image: Any = import_module("pillow_heif").open_heif(file)
    block = image.info.get("exif") or b""
    exif = read_exif(block.removeprefix(b"Exif\0\0"))
    size = image.size if exif.orientation < 5 else image.size[::-1]
    return Header("HEIC", (int(size[0]), int(size[1])), exif)


def _decode_heif(file: io.BytesIO) -> Any:
    module = import_module("pillow_heif")
    return np.asarray(module.open_heif(file, convert_hdr_to_8bit=False))


def _read_raw_header(file: io.BytesIO) -> Header:
    exif = _read_raw_exif(file.getvalue())
    with import_module("rawpy").imread(file) as raw:
        sizes = raw.sizes
        orientation = _ORIENTATION_BY_FLIP.get(sizes.flip, 1)
        return Header(
            "raw", (int(sizes.iwidth), int(sizes.iheight)), replace(exif, orientation=orientation)
        )


def _read_raw_exif(data: bytes) -> Exif:
    """Return the EXIF of a raw image that is a TIFF; an empty one of others."""
    try:
        return read_tiff(data)[1]
    except ValueError:
        return Exif()


def _decode_raw(file: io.BytesIO) -> Any:
    with import_module("rawpy").imread(file) as raw:
        return raw.postprocess(output_bps=16, use_camera_wb=True, no_auto_bright=True, user_flip=0)
