"""The error of a pixel as numbers on a picture of the sensor."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import (
    QColor,
    QFont,
    QFontMetricsF,
    QImage,
    QPainter,
    QPainterPath,
    QPaintEvent,
    QPen,
)
from PySide6.QtWidgets import QSizePolicy, QWidget

from calibgui.dataset import Result
from calibgui.engine.arrays import Array
from calibgui.engine.assessment import Verdict
from calibgui.gui.verdict.texts import describe_figures, describe_length, format_pixels
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.lengths import describe_condition

_INSET = 12
"""From the picture's edge to its texts, device-independent px."""
_SHADOW = QColor(0, 0, 0, 170)


class SensorFigure(QWidget):
    """Four numbers where they hold: at the centre, along the edge, at worst, and in the scene.

    The colours are the calibration's own uncertainty over the sensor; what they say in words is
    `text`, which a screen reader reads.
    """

    def __init__(self) -> None:
        super().__init__()
        self._verdict: Verdict | None = None
        self._result: Result | None = None
        self._picture: QImage | None = None
        self._fit = ""
        self._is_dimmed = False
        self._meaning = self.tr(
            "How far off the camera puts a distant point in the image (one standard deviation), as "
            "the verdict has it: beside the camera that mends the findings, if there are any.\n"
            "The colours: where the calibration's own uncertainty is small (dark) and large."
        )
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Fixed)
        self.setAccessibleName(self.tr("Error of a pixel"))

    def show_verdict(
        self, verdict: Verdict | None, result: Result | None, fit: str, *, dimmed: bool
    ) -> None:
        """Show the numbers of a verdict.

        Args:
            verdict: that is shown; None while there is none.
            result: that it is on, or that there is no verdict on.
            fit: words on the residuals of the result that is shown.
            dimmed: whether the verdict is on an earlier result.
        """
        self._verdict, self._result, self._fit = verdict, result, fit
        self._is_dimmed = dimmed
        self.setToolTip("\n\n".join(filter(None, (self.text(), self._meaning))))
        self.setAccessibleDescription(self.text())
        self.update()

    def show_map(self, error: Array | None) -> None:
        """Colour the sensor by a map (m, n) of errors, px; None for no colours."""
        self._picture = None if error is None else _colour(error)
        self.update()

    def text(self) -> str:
        """Return in words what the picture says."""
        lines = []
        if self._verdict is not None and self._result is not None:
            lines = describe_figures(self._verdict, self._result)
        fit = self.tr("Now: {0}").format(self._fit) if self._is_dimmed else self._fit
        return "\n".join(filter(None, [*lines, fit]))

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802, ARG002 - Qt's name
        painter, colours = QPainter(self), theme.current()
        painter.setRenderHints(
            QPainter.RenderHint.Antialiasing | QPainter.RenderHint.SmoothPixmapTransform
        )
        shape = QPainterPath()
        shape.addRoundedRect(QRectF(self.rect()), theme.RADIUS, theme.RADIUS)
        painter.fillPath(shape, QColor(colours.window))
        verdict = self._verdict
        if verdict is None or not np.isfinite(verdict.error.worst):
            painter.setPen(QColor(colours.muted))
            room = self.rect().adjusted(_INSET, _INSET, -_INSET, -_INSET)
            said = self._fit if verdict is None else self.text()
            flags = Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap
            painter.drawText(room, int(flags), said)
            return
        painter.setClipPath(shape)
        if self._picture is None:
            painter.fillRect(self.rect(), QColor(theme.ERROR_STOPS[0]))
        else:
            painter.drawImage(self.rect(), self._picture)
        if self._is_dimmed:
            painter.fillRect(self.rect(), QColor(90, 90, 90, 150))
        for text in self._list_texts(verdict):
            text.write(painter)

    def list_places(self) -> list[QRectF]:
        """Return where the numbers and words stand; none while there are no numbers."""
        return [text.place for text in self._list_texts(self._verdict)] if self._verdict else []

    def _list_texts(self, verdict: Verdict) -> list[_Text]:
        """List what is written on the picture."""
        error, right, bottom = verdict.error, self.width() - _INSET, self.height() - _INSET
        small = theme.make_font(theme.CAPTION)
        line = QFontMetricsF(small).lineSpacing()
        centre = self.tr("{0} px").format(format_pixels(error.centre))
        edge, worst = map(format_pixels, (error.edge, error.worst))
        texts = [
            *_pair(QPointF(self.width() / 2, self.height() / 2), centre, self.tr("centre"), 0.5),
            *_pair(QPointF(_INSET, _INSET + theme.FIGURE - 2), edge, self.tr("edge"), 0.0),
            *_pair(QPointF(right, bottom - line), worst, self.tr("worst pixel"), 1.0),
        ]
        scene = describe_length(verdict)
        condition = "" if self._result is None else describe_condition(self._result).strip()
        for k, text in enumerate(filter(None, (scene, condition))):
            texts.append(_Text.align(QPointF(right, _INSET + line * (k + 0.8)), text, small, 1.0))
        fit = self.tr("Now: {0}").format(self._fit) if self._is_dimmed else self._fit
        lines = fit.split(", ", 1) if fit else []
        for k, text in enumerate(reversed(lines)):
            texts.append(_Text.align(QPointF(_INSET, bottom - 2 - k * line), text, small, 0.0))
        return texts


class _Text(NamedTuple):
    """A text on the picture."""

    text: str
    font: QFont
    start: QPointF
    """Where its base line begins."""

    @classmethod
    def align(cls, at: QPointF, text: str, font: QFont, share: float) -> _Text:
        """Return a text of which a share stands to the left of a point."""
        width = QFontMetricsF(font).horizontalAdvance(text)
        return cls(text, font, at - QPointF(share * width, 0))

    @property
    def place(self) -> QRectF:
        """The rectangle that the letters fill."""
        return QFontMetricsF(self.font).tightBoundingRect(self.text).translated(self.start)

    def write(self, painter: QPainter) -> None:
        """Write it in white with a soft shadow."""
        path = QPainterPath()
        path.addText(self.start, self.font, self.text)
        pen = QPen(_SHADOW, 3.0)
        pen.setJoinStyle(Qt.PenJoinStyle.RoundJoin)
        painter.strokePath(path, pen)
        painter.fillPath(path, QColor("#ffffff"))


def _pair(at: QPointF, number: str, place: str, share: float) -> tuple[_Text, _Text]:
    """Return a number with its place below it, of which a share stands to the left of a point."""
    large, small = theme.make_font(theme.FIGURE, bold=True), theme.make_font(theme.CAPTION)
    widest = max(
        QFontMetricsF(large).horizontalAdvance(number),
        QFontMetricsF(small).horizontalAdvance(place),
    )
    middle = at + QPointF(widest * (0.5 - share), 0)
    below = middle + QPointF(0, QFontMetricsF(small).lineSpacing())
    return _Text.align(middle, number, large, 0.5), _Text.align(below, place, small, 0.5)


def _colour(error: Array) -> QImage:
    """Return a picture of errors (m, n), from the least in the first colour to the largest; what is
    not known has the first."""
    root = np.sqrt(np.where(np.isfinite(error), error, np.nan))
    low, high = float(np.nanmin(root, initial=np.inf)), float(np.nanmax(root, initial=0.0))
    share = np.nan_to_num((root - low) / (high - low) if high > low else 0.0 * root)
    stops = np.array([(c.red(), c.green(), c.blue()) for c in map(QColor, theme.ERROR_STOPS)])
    places = np.linspace(0.0, 1.0, len(stops))
    rgb = np.stack([np.interp(share, places, stops[:, k]) for k in range(3)], axis=-1)
    pixels = np.ascontiguousarray(rgb.round().astype(np.uint8))
    rows, cols = share.shape
    return QImage(pixels.data, cols, rows, 3 * cols, QImage.Format.Format_RGB888).copy()
