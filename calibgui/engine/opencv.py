"""OpenCV's image processing behind functions that hide its versions.

No other module imports cv2, because its shapes and names differ between 4.x and 5.x. Points come
back as (n, 2) float64 whatever the version.
"""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from types import MappingProxyType
from typing import Any, NamedTuple

import cv2
import numpy as np
import numpy.typing as npt

from calibgui.engine.arrays import Array, BoolArray, FloatImage, GreyImage, IntArray, Size

VERSION: str = cv2.__version__

# The caller reports failures and names the file; OpenCV would print them as well.
cv2.utils.logging.setLogLevel(cv2.utils.logging.LOG_LEVEL_SILENT)


_FLOW_WINDOW, _FLOW_LEVELS = 21, 3
"""Side of the window, px, and levels above the image, with which OpenCV follows points."""
_STREAM_TIMEOUT_MSEC = 5000
"""Time without an answer after which a camera in the network counts as gone, ms: a choice."""


@contextlib.contextmanager
def single_thread() -> Iterator[None]:
    """Let OpenCV use one thread within, and end those that it has: a fork would lose them."""
    before = cv2.getNumThreads()
    cv2.setNumThreads(1)
    try:
        yield
    finally:
        cv2.setNumThreads(before)


def use_threads(count: int) -> None:
    """Let OpenCV use `count` threads in this process."""
    cv2.setNumThreads(count)


def halve_image(image: GreyImage) -> GreyImage:
    """Halve `image` (h, w): each pixel is the mean of a 2 x 2 block; an odd edge is dropped."""
    return shrink_image(image, 2)


def shrink_image(image: GreyImage, step: int) -> GreyImage:
    """Shrink `image` (h, w) or (h, w, 3): each pixel is the mean of a block of `step` x `step`.

    What is left at the edges is dropped: a size that is no multiple of `step` would make the blocks
    unequal, and corners drift by whole pixels.
    """
    height, width = image.shape[0] // step, image.shape[1] // step
    even = image[: step * height, : step * width]
    return np.asarray(cv2.resize(even, (width, height), interpolation=cv2.INTER_AREA))


def average_colours(image: GreyImage, weights: Array) -> GreyImage:
    """Average the colours of an image (h, w, 3) with weights (3,), rounded to its type."""
    return np.asarray(cv2.transform(image, weights[None])).reshape(image.shape[:2])


def blur_image(image: GreyImage, sigma: float) -> tuple[GreyImage, float]:
    """Blur `image` (h, w) by a Gaussian of standard deviation `sigma` px, edges reflected.

    Returns:
        The blurred image, and the number of its levels that make one of `image`. It is int16, in
        steps finer than any noise and half the size of float32.
    """
    kernel = cv2.getGaussianKernel(2 * round(4 * sigma) + 1, sigma, cv2.CV_32F)
    if image.dtype == np.uint8:
        return np.asarray(cv2.sepFilter2D(image, cv2.CV_16S, 128 * kernel, kernel)), 128.0
    levels = np.iinfo(np.int16).max / max(float(image.max()), 1.0)
    blurred = cv2.sepFilter2D(image, cv2.CV_32F, levels * kernel, kernel)
    return np.rint(blurred, out=blurred).astype(np.int16), levels


def smooth_image(image: GreyImage, sigma: float) -> GreyImage:
    """Blur an 8-bit image (h, w) by a Gaussian of standard deviation `sigma` px, to 8 bits."""
    return np.asarray(cv2.GaussianBlur(image, (0, 0), sigma))


def correlate_separable(
    image: GreyImage, along_u: npt.ArrayLike, along_v: npt.ArrayLike
) -> FloatImage:
    """Correlate `image` (h, w) with the outer product of two odd kernels, edges reflected."""
    ku, kv = (np.asarray(kernel, dtype=np.float32) for kernel in (along_u, along_v))
    return np.asarray(cv2.sepFilter2D(image, cv2.CV_32F, ku, kv))


def dilate_image(image: FloatImage, around: BoolArray) -> FloatImage:
    """Return the greatest value of `image` (h, w) in a neighbourhood of each pixel.

    Args:
        image: the image.
        around: the neighbourhood, a mask of odd sides.
    """
    return np.asarray(cv2.dilate(image, around.astype(np.uint8)))


def filter_median(image: GreyImage) -> GreyImage:
    """Return the median of the 3 x 3 pixels around each of an `image` (h, w)."""
    return np.asarray(cv2.medianBlur(np.ascontiguousarray(image), 3))


def average_detail(image: GreyImage, around: int, block: int) -> Array:
    """Average how far 8-bit levels (h, w) differ from the mean of the `around` x `around` px about
    them, over blocks of `block` x `block` px; those at the right and lower border may be cut."""
    detail = cv2.absdiff(image, cv2.blur(image, (around, around)))
    down, right = (-length % block for length in image.shape)
    detail = cv2.copyMakeBorder(detail, 0, down, 0, right, cv2.BORDER_REFLECT)
    size = (detail.shape[1] // block, detail.shape[0] // block)
    return np.asarray(cv2.resize(detail, size, interpolation=cv2.INTER_AREA), np.float64)


def cut_tiles(image: GreyImage, uv: Array, half: int) -> tuple[GreyImage, Array]:
    """Cut squares of (2 half + 1)^2 px from `image` (h, w), around the pixels nearest to `uv`.

    Returns:
        Tiles (n, side, side), the border replicated, and the pixel (n, 2) of their first entry.
    """
    origin = np.rint(uv).astype(np.int64) - half
    offset = np.arange(2 * half + 1)
    u = np.clip(origin[:, :1] + offset, 0, image.shape[1] - 1)
    v = np.clip(origin[:, 1:] + offset, 0, image.shape[0] - 1)
    return image[v[:, :, None], u[:, None, :]], origin.astype(np.float64)


_REDUCED = {
    2: cv2.IMREAD_REDUCED_GRAYSCALE_2,
    4: cv2.IMREAD_REDUCED_GRAYSCALE_4,
    8: cv2.IMREAD_REDUCED_GRAYSCALE_8,
}


def decode_small(data: bytes, times: int) -> GreyImage | None:
    """Return a JPEG file in grey (h, w), 2, 4 or 8 times smaller; None if it is damaged.

    The decoder leaves out what only the larger image needs.
    """
    flags = _REDUCED[times] | cv2.IMREAD_IGNORE_ORIENTATION
    try:
        return cv2.imdecode(np.frombuffer(data, np.uint8), flags)
    except cv2.error:
        return None


def decode_image(data: bytes, colour: bool) -> GreyImage | None:
    """Return the pixels of an image file as stored; None if it is damaged.

    The EXIF orientation is ignored (but a TIFF's is not). The result is grey (h, w), or with
    `colour` RGB (h, w, 3) unless the file is grey; 16 bits are kept.
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


def encode_image(suffix: str, image: GreyImage) -> bytes | None:
    """Encode `image`, (h, w) or RGB (h, w, 3), in the format of `suffix`; None if that fails."""
    bgr = cv2.cvtColor(image, cv2.COLOR_RGB2BGR) if image.ndim == 3 else image
    lossless_webp = [cv2.IMWRITE_WEBP_QUALITY, 101] if suffix == ".webp" else []
    try:
        ok, data = cv2.imencode(suffix, bgr, lossless_webp)
    except cv2.error:
        return None
    return bytes(data) if ok else None


def decode_video(path: str) -> tuple[int, Iterator[GreyImage]]:
    """Return the number of frames that a video says it has, 0 if it does not, and its frames.

    Frames are RGB (h, w, 3) of 8 bits, turned as the file says; there are none if it cannot be
    decoded. Only what is known for a container of frames should be given: FFmpeg follows lists.
    """
    stream = open_stream(path, is_live=False)

    def decode() -> Iterator[GreyImage]:
        try:
            while (frame := stream.read()) is not None:
                yield frame
        finally:
            stream.close()

    return stream.count, decode()


def read_frame_rate(path: str) -> float:
    """Return the frames per second that a video says it has, 0 if it does not."""
    capture = cv2.VideoCapture(path, cv2.CAP_FFMPEG)
    try:
        rate = float(capture.get(cv2.CAP_PROP_FPS))
        return rate if np.isfinite(rate) and rate > 0 else 0.0
    finally:
        capture.release()


class Stream:
    """A camera or a video that is open."""

    def __init__(self, capture: cv2.VideoCapture) -> None:
        self._capture = capture

    @property
    def is_open(self) -> bool:
        """True if the device or the file could be opened."""
        return bool(self._capture.isOpened())

    @property
    def time(self) -> float:
        """Time of the last frame from the first one on, s, as the stream states it."""
        return float(self._capture.get(cv2.CAP_PROP_POS_MSEC)) / 1000

    @property
    def size(self) -> Size:
        """Width and height of its images, px."""
        width, height = (
            int(self._capture.get(each))
            for each in (cv2.CAP_PROP_FRAME_WIDTH, cv2.CAP_PROP_FRAME_HEIGHT)
        )
        return width, height

    @property
    def exposure(self) -> float | None:
        """Exposure of a camera in its own unit; None if it tells none."""
        return self._get_setting(cv2.CAP_PROP_EXPOSURE)

    @property
    def focus(self) -> float | None:
        """Focus of a camera in its own unit; None if it tells none."""
        return self._get_setting(cv2.CAP_PROP_FOCUS)

    @property
    def has_autofocus_on(self) -> bool:
        """True if a camera says that its autofocus is on."""
        return float(self._capture.get(cv2.CAP_PROP_AUTOFOCUS)) > 0

    def set_size(self, size: Size) -> None:
        """Ask a camera for images of a size, px; it may take the nearest that it has."""
        self._capture.set(cv2.CAP_PROP_FRAME_WIDTH, size[0])
        self._capture.set(cv2.CAP_PROP_FRAME_HEIGHT, size[1])

    def set_exposure(self, exposure: float) -> None:
        """Ask a camera to expose alike always, in its own unit."""
        is_v4l = self._capture.getBackendName() == "V4L2"  # elsewhere 0 means by hand
        self._capture.set(cv2.CAP_PROP_AUTO_EXPOSURE, 1 if is_v4l else 0)
        self._capture.set(cv2.CAP_PROP_EXPOSURE, exposure)

    def set_focus(self, focus: float) -> None:
        """Ask a camera to focus alike always, in its own unit."""
        self._capture.set(cv2.CAP_PROP_AUTOFOCUS, 0)
        self._capture.set(cv2.CAP_PROP_FOCUS, focus)

    def _get_setting(self, which: int) -> float | None:
        """Get a setting of a camera; None if it has none: OpenCV then says 0 or -1."""
        value = float(self._capture.get(which))
        return value if np.isfinite(value) and value not in (0.0, -1.0) else None

    @property
    def count(self) -> int:
        """Number of frames that it says it has; 0 if it does not."""
        return max(0, int(self._capture.get(cv2.CAP_PROP_FRAME_COUNT)))

    def read(self) -> GreyImage | None:
        """Return the next frame, RGB (h, w, 3) of 8 bits; None if there is none."""
        is_read, frame = self._capture.read()
        return np.asarray(cv2.cvtColor(frame, cv2.COLOR_BGR2RGB)) if is_read else None

    def close(self) -> None:
        """Release the device or the file."""
        self._capture.release()


def open_stream(source: int | str, *, is_live: bool) -> Stream:
    """Open a camera by its number or address, or a video by its path.

    A live one in the network that does not answer within seconds counts as gone.
    """
    if isinstance(source, int):
        return Stream(cv2.VideoCapture(source))
    limits = [
        cv2.CAP_PROP_OPEN_TIMEOUT_MSEC,
        _STREAM_TIMEOUT_MSEC,
        cv2.CAP_PROP_READ_TIMEOUT_MSEC,
        _STREAM_TIMEOUT_MSEC,
    ]
    return Stream(cv2.VideoCapture(source, cv2.CAP_FFMPEG, limits if is_live else []))


def follow_points(
    before: GreyImage, after: GreyImage, uv: Array, spacing: float
) -> tuple[Array, Array]:
    """Follow points (n, 2) px to the next image by optical flow, and from there back again.

    Where the windows around points do not overlap in images of half the size, these are looked at:
    they take some half of the time, and points are still followed to 0.04 px.

    Args:
        before, after: images of one size, grey (h, w) or RGB (h, w, 3).
        uv: the points in the image before.
        spacing: smallest distance between two points, px.

    Returns:
        Where they are in the image after, and where the flow leads these in the image before, both
        (n, 2) px; NaN where it leads nowhere.
    """
    halvings = int(spacing >= 2 * _FLOW_WINDOW)
    corner, part = _cut_out_reach(uv, halvings)
    images = [_prepare_for_flow(image[part], halvings) for image in (before, after)]
    forward = _follow(images[0], images[1], (uv - corner) / (1 << halvings))
    back = _follow(images[1], images[0], forward)
    return corner + (1 << halvings) * forward, corner + (1 << halvings) * back


def _prepare_for_flow(image: GreyImage, halvings: int) -> GreyImage:
    """Return an image in grey levels of 8 bits, as the flow needs it, halved so many times.

    Pixel (u, v) of the halved image lies at (2 u, 2 v).
    """
    grey = np.asarray(cv2.cvtColor(image, cv2.COLOR_RGB2GRAY)) if image.ndim == 3 else image
    if grey.dtype != np.uint8:
        scale = 1 / 257 if grey.dtype == np.uint16 else 1.0
        grey = np.asarray(cv2.convertScaleAbs(grey, alpha=scale))
    for _ in range(halvings):
        grey = np.asarray(cv2.pyrDown(grey))
    return grey


def _follow(before: GreyImage, after: GreyImage, uv: Array) -> Array:
    if not np.isfinite(uv).any():
        return uv
    start = np.nan_to_num(uv).astype(np.float32)
    moved, status, _ = cv2.calcOpticalFlowPyrLK(before, after, start, None)
    return np.where((status.ravel() > 0)[:, None] & np.isfinite(uv), moved, np.nan)


def _cut_out_reach(uv: Array, halvings: int) -> tuple[Array, tuple[slice, slice]]:
    """Cut out what the flow of points (n, 2) px reaches; its pyramid is as that of the whole image.

    Returns:
        The upper left corner (2,), px, and the rows and columns.
    """
    reach = _FLOW_WINDOW << (_FLOW_LEVELS + halvings)
    first = np.maximum(0, uv.min(axis=0) - reach).astype(np.int64)
    first -= first % (1 << (_FLOW_LEVELS + halvings))
    last = np.maximum(first + 1, uv.max(axis=0).astype(np.int64) + reach)
    rows, cols = (slice(int(first[k]), int(last[k])) for k in (1, 0))
    return first.astype(np.float64), (rows, cols)


def measure_sharpness(image: GreyImage) -> float:
    """Return the variance of the Laplacian of an RGB image (h, w, 3), halved: blur lessens it."""
    grey = halve_image(np.asarray(cv2.cvtColor(image, cv2.COLOR_RGB2GRAY)))
    return float(cv2.Laplacian(grey, cv2.CV_16S).var())


def resample_image(image: GreyImage, uv: FloatImage, out: GreyImage) -> None:
    """Interpolate `image`, (h, w) or (h, w, c), at `uv` (2, H, W) px, into `out` of its type.

    The interpolation is bilinear, between pixels that are 0 outside of the image. No side may
    exceed `MAX_SIDE` px.
    """
    u, v = uv
    cv2.remap(image, u, v, cv2.INTER_LINEAR, out, cv2.BORDER_CONSTANT)


def draw_line(image: GreyImage, uv: Array, colour: Array, width: int) -> None:
    """Draw a line through points (n, 2) px into `image`, (h, w, 3), with smooth edges.

    Points far outside are drawn up to some widths of the image beyond it.
    """
    height, across, _ = image.shape
    far = 8.0 * max(height, across)
    points = np.rint(16 * np.clip(uv, -far, far)).astype(np.int32)
    # OpenCV smooths the edges of 8-bit lines only.
    smooth = cv2.LINE_AA if image.dtype == np.uint8 else cv2.LINE_8
    cv2.polylines(image, [points], False, colour.tolist(), width, smooth, shift=4)


MAX_SIDE = 32_766
"""Longest side, px, of the images that `resample_image` takes and returns: OpenCV's limit."""


def format_storage(
    suffix: str, values: Mapping[str, int | float | str | Array], comment: str = ""
) -> str:
    """Return the text of a cv2.FileStorage file with `values`.

    Args:
        suffix: ".yml", ".yaml", ".xml" or ".json", which decides the format.
        values: the values by name, in the order of the file.
        comment: lines for the head of the file; JSON has no comments that others can read.
    """
    file = cv2.FileStorage(suffix, cv2.FILE_STORAGE_WRITE | cv2.FILE_STORAGE_MEMORY)
    if comment:
        file.writeComment(comment)
    for name, value in values.items():
        file.write(name, np.array(value) if isinstance(value, np.ndarray) else value)
    return str(file.releaseAndGetString())


@cache
def list_dictionaries() -> Mapping[str, int]:
    """Return the names of the predefined dictionaries of markers with their numbers of markers."""
    names = {name.upper() for name in vars(cv2.aruco) if name.startswith("DICT_")}
    return MappingProxyType({name: len(_load_dictionary(name).bytesList) for name in sorted(names)})


class DetectedMarkers(NamedTuple):
    """The square markers of a dictionary in an image, and what else may be markers."""

    numbers: IntArray
    """(n,)"""
    corners: Array
    """(n, 4, 2) px, clockwise as printed from the upper left."""
    unread: Array
    """(m, 4, 2) px, corners of the other dark quadrilaterals."""


def detect_markers(image: GreyImage, dictionary: str) -> DetectedMarkers:
    """Detect the square markers of a predefined dictionary in an 8-bit image (h, w)."""
    parameters = _marker_parameters(image)
    parameters.cornerRefinementMethod = cv2.aruco.CORNER_REFINE_SUBPIX
    detector = cv2.aruco.ArucoDetector(_load_dictionary(dictionary), parameters)
    corners, ids, unread = detector.detectMarkers(image)
    numbers = np.zeros(0, np.int64) if ids is None else np.asarray(ids, np.int64).ravel()
    return DetectedMarkers(numbers, _stack_quads(corners), _stack_quads(unread))


def detect_dark_quads(
    image: GreyImage, is_quick: bool = False, is_part: bool = False, least_side: float | None = None
) -> Array:
    """Return corners (n, 4, 2) px of the shapes in an 8-bit image (h, w) that may be markers.

    The dark is darker than its surroundings. A quick search compares with those of one size only,
    where OpenCV takes three. In a part of a larger image only the smallest markers are left out,
    not those that are small for it; or those of less than `least_side` px.
    """
    any_one = cv2.aruco.Dictionary(np.zeros((1, 2, 4), np.uint8), 4, 0)
    parameters = _marker_parameters(image)
    if is_part or least_side is not None:
        side = _MIN_MARKER_SIDE if least_side is None else least_side
        parameters.minMarkerPerimeterRate = 4 * side / max(image.shape)
    if is_quick:
        parameters.adaptiveThreshWinSizeMin = parameters.adaptiveThreshWinSizeMax = QUICK_WINDOW
    detector = cv2.aruco.ArucoDetector(any_one, parameters)
    read, _, others = detector.detectMarkers(image)
    return _stack_quads([*read, *others])


def _stack_quads(quads: Sequence[Any]) -> Array:
    """Return the corners (n, 4, 2) px of quadrilaterals as OpenCV lists them."""
    return np.array(quads, np.float64).reshape(-1, 4, 2)


def count_quads(image: GreyImage, window: int, perimeter: int, least: int, most: int) -> int:
    """Count the quadrilaterals of an 8-bit image (h, w) that are darker than the mean of the
    `window` px around and have a `perimeter` px or more, up to the `most`; 0 if fewer outlines than
    the `least` number are there."""
    dark = cv2.adaptiveThreshold(
        image, 255, cv2.ADAPTIVE_THRESH_MEAN_C, cv2.THRESH_BINARY_INV, window, DARKER
    )
    if _count_tops(dark) > _FEW_TOPS * dark.size:
        # Texture has thousands of specks, whose outlines are too short but take long to follow.
        _, labels, stats, _ = cv2.connectedComponentsWithStats(dark, connectivity=8)
        sides = stats[:, cv2.CC_STAT_WIDTH] + stats[:, cv2.CC_STAT_HEIGHT]
        dark[(sides - 2 < _SPECK_SHARE * perimeter)[labels]] = 0
    outlines, _ = cv2.findContours(dark, cv2.RETR_LIST, cv2.CHAIN_APPROX_SIMPLE)
    if len(outlines) < least:
        return 0
    count = 0
    for outline in outlines:
        length = cv2.arcLength(outline, closed=True)
        if length >= perimeter:
            count += len(cv2.approxPolyDP(outline, _OFF_QUAD * length, closed=True)) == 4
            if count == most:
                break
    return count


def _count_tops(mask: GreyImage) -> int:
    """Count the places of a mask (h, w) with none to the left of and above them: one of each of its
    parts, or more where that has several tops."""
    above = mask[:-1]
    before = above[:, :-2] | above[:, 1:-1] | above[:, 2:] | mask[1:, :-2]
    return cv2.countNonZero(mask[1:, 1:-1] & ~before)


def _marker_parameters(image: GreyImage) -> Any:
    parameters = cv2.aruco.DetectorParameters()
    parameters.minMarkerPerimeterRate = min(0.03, 4 * _MIN_MARKER_SIDE / max(image.shape))
    return parameters


def count_correctable_cells(dictionary: str) -> int:
    """Return the number of a marker's cells that may be misread without a confusion."""
    return int(_load_dictionary(dictionary).maxCorrectionBits * _CORRECTED_SHARE)


def draw_marker_cells(dictionary: str, number: int) -> BoolArray:
    """Return (k, k) true for the dark cells of a marker, its border of one cell included."""
    source = _load_dictionary(dictionary)
    side = source.markerSize + 2
    return np.asarray(cv2.aruco.generateImageMarker(source, number, side)) == 0


@cache
def _load_dictionary(name: str) -> Any:
    known = {key.upper(): value for key, value in vars(cv2.aruco).items() if key[:5] == "DICT_"}
    return cv2.aruco.getPredefinedDictionary(known[name])


_CORRECTED_SHARE = 0.6
"""Share of a dictionary's correctable cells that OpenCV corrects (its default)."""
_MIN_MARKER_SIDE = 10.0
"""Side of the smallest markers that are detected, px."""
DARKER = 7
"""Difference from the mean around by which pixels are dark, grey levels: OpenCV's for markers."""
_SPECK_SHARE = 0.4
"""Width and height, over the perimeter asked for, below which no outline is that long: half of it,
or less if it is not straight."""
_FEW_TOPS = 0.01
"""Share of the pixels that are tops of dark parts up to which these have so few outlines that to
follow them takes less time than to tell specks. Of boards it is up to 0.009, in noise 0.05."""
_OFF_QUAD = 0.05
"""Greatest distance of an outline from its quadrilateral, perimeters."""
QUICK_WINDOW = 7
"""Side of the surroundings that the dark is compared with where one size has to do, px: of rendered
markers of 13 px and more it finds nearly as many as OpenCV's three sizes."""


def average_around(image: GreyImage, side: int) -> GreyImage:
    """Average an 8-bit image (h, w) over the `side` x `side` px around each, an odd number of them,
    the border replicated."""
    return np.asarray(cv2.blur(image, (side, side), borderType=cv2.BORDER_REPLICATE))


def fill_narrow_parts(image: GreyImage, side: int, *, are_bright: bool) -> GreyImage:
    """Fill what is narrower than `side` px, an odd number, of an image (h, w) with the levels of
    what is left around: dark parts by a morphological closing, bright ones by an opening."""
    operation = cv2.MORPH_OPEN if are_bright else cv2.MORPH_CLOSE
    return np.asarray(cv2.morphologyEx(image, operation, np.ones((side, side), np.uint8)))


def label_parts(mask: BoolArray) -> tuple[npt.NDArray[np.int32], int]:
    """Label what of a mask (h, w) is connected along rows and columns.

    It is ``scipy.ndimage.label``, but that takes 0.1 s of processor time to import.

    Returns:
        The number (h, w) of each place's part, in the order of their first places row by row, 0 for
        none; and the number of parts.
    """
    count, labels = cv2.connectedComponents(mask.astype(np.uint8), connectivity=4)
    return np.asarray(labels, np.int32), count - 1


class CalibratedCamera(NamedTuple):
    """A camera as OpenCV calibrates it, without the root mean square distance."""

    params: Array
    """(9,) fx, fy, cx, cy, px, and k1, k2, p1, p2, k3."""
    rvecs: Array
    """(K, 3) rotation vectors cam_from_board."""
    tvecs: Array
    """(K, 3) translations, in the unit of the board's points."""


FIX_FLAGS: Mapping[tuple[str, ...], int] = {
    ("fx", "fy"): cv2.CALIB_FIX_FOCAL_LENGTH,
    ("cx", "cy"): cv2.CALIB_FIX_PRINCIPAL_POINT,
    ("k1",): cv2.CALIB_FIX_K1,
    ("k2",): cv2.CALIB_FIX_K2,
    ("k3",): cv2.CALIB_FIX_K3,
    ("p1", "p2"): cv2.CALIB_FIX_TANGENT_DIST,
}
"""The flags of `calibrate_camera` that hold parameters, by the names that each one holds."""


def calibrate_camera(
    uv: Sequence[Array],
    xy: Sequence[Array],
    size: Size,
    guess: Array | None,
    flags: int,
    max_iterations: int,
) -> CalibratedCamera | None:
    """Calibrate a camera with `cv2.calibrateCamera` and its five coefficients.

    It ends after `max_iterations`, or when a step changes the parameters by less than 2.2e-16 of
    their length (OpenCV's own default). OpenCV takes points in single precision only, which rounds
    coordinates near 1000 px by up to 3e-5 px.

    Args:
        uv: per view the corners (n, 2) in the image, px.
        xy: per view the same corners (n, 2) on the board.
        size: width and height of the images, px.
        guess: (9,) parameters to start from, as in `CalibratedCamera`; None for OpenCV's own start.
        flags: sum of `FIX_FLAGS`, which need a guess.
        max_iterations: largest number of its iterations.

    Returns:
        None if OpenCV refuses the views.
    """
    places = [np.pad(points, [(0, 0), (0, 1)]).astype(np.float32) for points in xy]
    corners = [points.astype(np.float32) for points in uv]
    criteria = (
        cv2.TERM_CRITERIA_COUNT + cv2.TERM_CRITERIA_EPS,
        max_iterations,
        float(np.finfo(np.float64).eps),
    )
    matrix, coefficients = None, None
    if guess is not None:
        fx, fy, cx, cy = guess[:4]
        matrix = np.array([[fx, 0.0, cx], [0.0, fy, cy], [0.0, 0.0, 1.0]])
        coefficients = np.array(guess[4:9])
        flags |= cv2.CALIB_USE_INTRINSIC_GUESS
    try:
        _, K, k, rvecs, tvecs = cv2.calibrateCamera(
            places, corners, size, matrix, coefficients, flags=flags, criteria=criteria
        )
    except cv2.error:
        return None
    params = np.concatenate([[K[0, 0], K[1, 1], K[0, 2], K[1, 2]], np.ravel(k)[:5]])
    return CalibratedCamera(
        params.astype(np.float64),
        np.array(rvecs, np.float64).reshape(-1, 3),
        np.array(tvecs, np.float64).reshape(-1, 3),
    )
