"""What a calibration says of the whole image, as drawings that lie over every photograph."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np
from PySide6.QtCore import QObject
from PySide6.QtGui import QColor

from calibgui.dataset import Result
from calibgui.engine.arrays import Array, Size
from calibgui.engine.camera import DisplacementPart, compute_displacement
from calibgui.engine.errors import CalibrationError
from calibgui.engine.images import make_mesh
from calibgui.engine.numbers import format_two_digits
from calibgui.gui.canvas.canvas import Canvas
from calibgui.gui.canvas.layers import Drawing, Layer
from calibgui.gui.jobs.job import Job
from calibgui.gui.session.session import Session
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.levels import choose_levels

_CELLS = 120
"""Values of a map along the image's longer side."""
_ARROWS = 16
"""Arrows along the image's longer side."""
_FULL = 0.9
"""Length of the longest arrow, in distances between arrows."""

_PLACES_OF_LABEL = np.array([0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8])
"""Places of a label along its line, of the line's length, the best one first."""

Work = Callable[[Result, Job], Drawing]


class Evidence(QObject):
    """Computes the layers of the whole calibration beside the main thread, when they are shown.

    Args:
        session: whose result they are of.
        canvas: that shows them.
    """

    def __init__(self, session: Session, canvas: Canvas) -> None:
        super().__init__(canvas)
        self._session, self._canvas = session, canvas
        self.drawings: dict[Layer, Drawing] = {}
        """What has been computed for the shown result."""
        self._jobs: dict[Layer, Job] = {}
        self._works: dict[Layer, tuple[str, Work]] = {
            Layer.COVERAGE: ("", _draw_coverage),
            Layer.DISTORTION: ("", self._draw_distortion),
            Layer.DISPLACEMENT: ("", self._draw_displacement),
            Layer.UNCERTAINTY: (self.tr("Propagating the uncertainty"), self._draw_uncertainty),
            Layer.NEXT_VIEW: (self.tr("Looking for the next view"), self._draw_next_view),
        }
        session.result_changed.connect(lambda _: self._begin_anew())

    def need(self) -> None:
        """Compute those of the shown layers that are not there."""
        result = self._session.result
        if result is None:
            return
        for layer, (label, work) in self._works.items():
            if layer in self._canvas.shown and layer not in self._jobs:
                self._start(layer, label, work, result)

    def _begin_anew(self) -> None:
        """Forget the layers of another result."""
        for job in self._jobs.values():
            job.cancel()
        self._jobs, self.drawings = {}, {}
        self._canvas.show_drawings({})
        self.need()

    def _start(self, layer: Layer, label: str, work: Work, result: Result) -> None:
        def done(drawing: Drawing) -> None:
            if self._jobs.get(layer) is job:
                self.drawings[layer] = drawing
                self._canvas.show_drawings(self.drawings)

        def failed(error: Exception) -> None:
            if not isinstance(error, CalibrationError):
                self._session.failed.emit(error)

        job = self._session.jobs.start(
            label, lambda job: work(result, job), done, failed=failed, owner=self
        )
        self._jobs[layer] = job

    def _draw_distortion(self, result: Result, _: Job) -> Drawing:
        camera = result.calibration.camera
        u, v = _place_cells(camera.size, _CELLS)
        d = compute_displacement(make_mesh(u, v), camera, DisplacementPart.COMPLETE).length
        levels = choose_levels(float(np.nanmax(d, initial=0.0)))
        lines, labels = _trace_contours(u, v, d, levels, self.tr("{0:g} px"))
        return Drawing(camera.size, theme.MAGNITUDE, lines, labels)

    def _draw_displacement(self, result: Result, _: Job) -> Drawing:
        camera = result.calibration.camera
        at = make_mesh(*_place_cells(camera.size, _ARROWS)).reshape(-1, 2)
        vector = compute_displacement(at, camera, DisplacementPart.COMPLETE).vector
        length = np.linalg.norm(vector, axis=1)
        longest = float(np.nanmax(length, initial=1e-12))
        scale = _FULL * max(camera.size) / _ARROWS / longest
        lines = tuple(_trace_arrow(a, scale * d) for a, d in zip(at, vector, strict=True))
        corner = np.array([0.0, camera.size[1] - 1.0])  # the image's name stands at the upper left
        text = self.tr("displacement × {0:.2g}, at most {1} px at the arrows").format(
            scale, format_two_digits(longest)
        )
        return Drawing(camera.size, theme.DISPLACED, lines, ((corner[None], text),))

    def _draw_uncertainty(self, result: Result, _: Job) -> Drawing:
        from calibgui.engine.uncertainty import estimate_projection_uncertainty  # slow to load

        found = estimate_projection_uncertainty(result.calibration, result.observations())
        levels = choose_levels(found.worst)
        lines, labels = _trace_contours(
            found.u, found.v, found.worst_direction, levels, self.tr("± {0:g} px")
        )
        return Drawing(found.size, theme.UNCERTAIN, lines, labels)

    def _draw_next_view(self, result: Result, _: Job) -> Drawing:
        from scipy.spatial import ConvexHull  # slow to load

        from calibgui.engine.uncertainty import propose_views  # slow to load

        view = propose_views(result.calibration, result.observations(), 1)[0]
        around = ConvexHull(view.corners).vertices
        outline = view.corners[[*around, around[0]]]
        return Drawing(
            result.calibration.camera.size,
            theme.NEXT_VIEW,
            (outline,),
            ((outline, self.tr("next view")),),
            ((view.corners, theme.NEXT_VIEW),),
        )


def _draw_coverage(result: Result, _: Job) -> Drawing:
    """Draw the corners of all views, each view's in its colour."""
    used = result.places
    dots = tuple(
        (observation.uv, theme.view_colour(i))
        for i, observation in zip(used, result.observations(), strict=True)
    )
    return Drawing(result.calibration.camera.size, QColor(theme.MUTED_MARK), dots=dots)


def _place_cells(size: Size, count: int) -> tuple[Array, Array]:
    """Return u and v of cells' middles that cover an image, `count` along its longer side."""
    side = max(size) / count
    u, v = ((np.arange(max(1, round(n / side))) + 0.5) for n in size)
    return u * size[0] / len(u) - 0.5, v * size[1] / len(v) - 0.5


def _trace_contours(
    u: Array, v: Array, values: Array, levels: Iterable[float], text: str
) -> tuple[tuple[Array, ...], tuple[tuple[Array, str], ...]]:
    """Return the lines of `values` (m, n) at `levels`, and a label for the longest of each.

    Each label may stand at the middle of its line, or at one of few places along it.
    """
    from contourpy import contour_generator  # slow to load

    contours = contour_generator(u, v, np.ma.masked_invalid(values))
    lines: list[Array] = []
    labels = []
    for level in levels:
        found = [np.asarray(line) for line in contours.lines(level)]
        lines += found
        if found:
            longest = max(found, key=len)
            order = (len(longest) * _PLACES_OF_LABEL).astype(int)
            labels.append((longest[order], text.format(level)))
    return tuple(lines), tuple(labels)


def _trace_arrow(at: Array, vector: Array) -> Array:
    """Return an arrow that begins at (2,) and goes along (2,), as one line."""
    tip = at + vector
    side = np.array([-vector[1], vector[0]])
    barbs = [tip - 0.3 * vector + sign * 0.18 * side for sign in (1, -1)]
    return np.array([at, tip, barbs[0], tip, barbs[1]])
