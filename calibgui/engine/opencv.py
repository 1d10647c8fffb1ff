"""The one place that imports OpenCV: its shapes and names differ between 4.x and 5.x.

Points come back as (n, 2) float64 whatever the version.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import cv2
import numpy as np
import numpy.typing as npt

from calibgui.engine.arrays import Array, BoolArray, FloatImage, GreyImage, IntArray

VERSION: str = cv2.__version__

# What fails here is answered to the caller, who names the file; OpenCV would print it besides.
cv2.utils.logging.setLogLevel(cv2.utils.logging.LOG_LEVEL_SILENT)


def use_threads(count: int) -> None:
    """Let OpenCV use `count` threads in this process."""
    cv2.setNumThreads(count)


def half(image: GreyImage) -> GreyImage:
    """Every second pixel of `image` (h, w), each the mean of its 2 x 2 block; odd edges drop.

    An odd size would make the blocks unequal, and corners drift by whole pixels.
    """
    height, width = image.shape[0] // 2, image.shape[1] // 2
    even = image[: 2 * height, : 2 * width]
    return np.asarray(cv2.resize(even, (width, height), interpolation=cv2.INTER_AREA))


def smooth(image: GreyImage, sigma: float) -> tuple[GreyImage, float]:
    """`image` (h, w) blurred by a Gaussian of standard deviation `sigma` px, edges reflected.

    Returns:
        The blurred image, and how many of its levels make one of `image`. Of 8 bits it is int16,
        in steps finer than any noise and half the size of float32, which it is otherwise.
    """
    levels, kind = (128.0, cv2.CV_16S) if image.dtype == np.uint8 else (1.0, cv2.CV_32F)
    kernel = cv2.getGaussianKernel(2 * round(4 * sigma) + 1, sigma, cv2.CV_32F)
    return np.asarray(cv2.sepFilter2D(image, kind, levels * kernel, kernel)), levels


def separable(image: GreyImage, along_u: npt.ArrayLike, along_v: npt.ArrayLike) -> FloatImage:
    """Correlation of `image` (h, w) with the outer product of two odd kernels, edges reflected."""
    ku, kv = (np.asarray(kernel, dtype=np.float32) for kernel in (along_u, along_v))
    return np.asarray(cv2.sepFilter2D(image, cv2.CV_32F, ku, kv))


def greatest(image: FloatImage, around: BoolArray) -> FloatImage:
    """Greatest value of `image` (h, w) at the places around each pixel that are marked in the mask,
    which has odd sides."""
    return np.asarray(cv2.dilate(image, around.astype(np.uint8)))


def tiles(image: GreyImage, uv: Array, half: int) -> tuple[GreyImage, Array]:
    """Squares of (2 half + 1)^2 pixels of `image` (h, w) around the pixels nearest to `uv` (n, 2).

    Returns:
        Tiles (n, side, side), the border replicated, and the pixel (n, 2) of their first entry.
    """
    origin = np.rint(uv).astype(np.int64) - half
    offset = np.arange(2 * half + 1)
    u = np.clip(origin[:, :1] + offset, 0, image.shape[1] - 1)
    v = np.clip(origin[:, 1:] + offset, 0, image.shape[0] - 1)
    return image[v[:, :, None], u[:, None, :]], origin.astype(np.float64)


def decode(data: bytes, colour: bool) -> GreyImage | None:
    """Pixels of an image file as stored, EXIF orientation ignored (but a TIFF's); None if damaged.

    Grey (h, w), or with `colour` RGB (h, w, 3) unless the file is grey; 16 bits are kept.
    """
    flags = cv2.IMREAD_ANYDEPTH | cv2.IMREAD_IGNORE_ORIENTATION
    if colour:
        flags |= cv2.IMREAD_ANYCOLOR
    if data[:2] in (b"P1", b"P2", b"P3"):
        data += b"\n"  # OpenCV wants a blank behind the last number
    try:
        image = cv2.imdecode(np.frombuffer(data, np.uint8), flags)
    except cv2.error:
        return None
    if image is None or image.ndim == 2:
        return image
    return np.asarray(cv2.cvtColor(image, cv2.COLOR_BGR2RGB))


def encode(suffix: str, image: GreyImage) -> bytes | None:
    """`image`, (h, w) or RGB (h, w, 3), in the file format of `suffix`; None if it cannot be."""
    bgr = cv2.cvtColor(image, cv2.COLOR_RGB2BGR) if image.ndim == 3 else image
    lossless_webp = [cv2.IMWRITE_WEBP_QUALITY, 101] if suffix == ".webp" else []
    try:
        ok, data = cv2.imencode(suffix, bgr, lossless_webp)
    except cv2.error:
        return None
    return bytes(data) if ok else None


def resample(image: GreyImage, uv: Array) -> GreyImage:
    """`image` (h, w) or (h, w, c) at `uv` (H, W, 2) px, bilinear, its border replicated, its type.

    No side may exceed `LONGEST_SIDE` px.
    """
    points = uv.astype(np.float32)
    return np.asarray(cv2.remap(image, points, None, cv2.INTER_LINEAR, None, cv2.BORDER_REPLICATE))


LONGEST_SIDE = 32_766
"""Of the images that `resample` takes and returns, px."""


def storage(suffix: str, values: Mapping[str, int | float | str | Array], comment: str = "") -> str:
    """The text of a cv2.FileStorage file holding `values`.

    Args:
        suffix: ".yml", ".yaml", ".xml" or ".json", which decides the format.
        values: by name, in the order to be written.
        comment: lines for the head of the file; JSON has no comments that others can read.
    """
    file = cv2.FileStorage(suffix, cv2.FILE_STORAGE_WRITE | cv2.FILE_STORAGE_MEMORY)
    if comment:
        file.writeComment(comment)
    for name, value in values.items():
        file.write(name, np.array(value) if isinstance(value, np.ndarray) else value)
    return str(file.releaseAndGetString())


def dictionaries() -> dict[str, int]:
    """Names of the predefined dictionaries of markers, and how many markers each has."""
    names = {name.upper() for name in vars(cv2.aruco) if name.startswith("DICT_")}
    return {name: len(_dictionary(name).bytesList) for name in sorted(names)}


def markers(image: GreyImage, dictionary: str) -> tuple[IntArray, Array]:
    """The square markers of a predefined dictionary in an 8-bit image (h, w).

    Returns:
        Their numbers (n,) and corners (n, 4, 2) px: first, clockwise as printed, the upper left.
    """
    parameters = _marker_parameters(image)
    parameters.cornerRefinementMethod = cv2.aruco.CORNER_REFINE_SUBPIX
    detector = cv2.aruco.ArucoDetector(_dictionary(dictionary), parameters)
    corners, ids, *_ = detector.detectMarkers(image)
    if ids is None or not len(corners):
        return np.zeros(0, np.int64), np.zeros((0, 4, 2))
    return np.asarray(ids, np.int64).ravel(), np.array(corners, np.float64).reshape(-1, 4, 2)


def dark_quads(image: GreyImage) -> Array:
    """(n, 4, 2) px, corners of what in an 8-bit image (h, w) may be a marker of any dictionary."""
    any_one = cv2.aruco.Dictionary(np.zeros((1, 2, 4), np.uint8), 4, 0)
    detector = cv2.aruco.ArucoDetector(any_one, _marker_parameters(image))
    read, _, others = detector.detectMarkers(image)
    return np.array([*read, *others], np.float64).reshape(-1, 4, 2)


def _marker_parameters(image: GreyImage) -> Any:
    parameters = cv2.aruco.DetectorParameters()
    parameters.minMarkerPerimeterRate = min(0.03, 4 * _LEAST_MARKER / max(image.shape))
    return parameters


def correctable_cells(dictionary: str) -> int:
    """How many of a marker's cells may be misread for it to be told from the dictionary's others
    still."""
    return int(_dictionary(dictionary).maxCorrectionBits * _CORRECTED)


def marker_cells(dictionary: str, number: int) -> BoolArray:
    """(k, k) which cells of a marker are dark, its border of one cell included."""
    source = _dictionary(dictionary)
    side = source.markerSize + 2
    return np.asarray(cv2.aruco.generateImageMarker(source, number, side)) == 0


def _dictionary(name: str) -> Any:
    known = {key.upper(): value for key, value in vars(cv2.aruco).items() if key[:5] == "DICT_"}
    return cv2.aruco.getPredefinedDictionary(known[name])


_CORRECTED = 0.6
"""Share of a dictionary's correctable cells that OpenCV corrects."""
_LEAST_MARKER = 10.0
"""Side of the smallest markers that are looked for, px."""


def dark_parts(image: GreyImage, window: int) -> tuple[npt.NDArray[np.int32], int]:
    """Connected parts of an 8-bit image (h, w) darker than the mean of the `window` px around.

    Returns:
        The number (h, w) of the part that each pixel belongs to, 0 for none, and the numbers' end.
    """
    dark = cv2.adaptiveThreshold(
        image, 255, cv2.ADAPTIVE_THRESH_MEAN_C, cv2.THRESH_BINARY_INV, 2 * (window // 2) + 1, 8
    )
    count, labels, *_ = cv2.connectedComponentsWithStats(dark, connectivity=4)
    return np.asarray(labels, np.int32), int(count)
