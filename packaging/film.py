"""Draw the film of the window that the README shows: from photographs to a remedied calibration.

    python packaging/film.py [FILE]

Photographs of a board whose squares are 0.5 % too high are dropped onto the window, which searches
them and calibrates; the verdict's button mends what is wrong, and what that has done is kept, until
nothing is. What is shown is what the window shows, with a drawn cursor; waiting is shortened.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import numpy.typing as npt
from make_sample import LOOK, VIEWS, draw_photograph
from PIL import Image
from PySide6.QtCore import QMimeData, QPoint, QPointF, Qt, QUrl
from PySide6.QtGui import QDropEvent, QImage, QPainter, QPen, QPolygonF
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QWidget
from screenshots import open_window, pause, wait

from calibgui.engine.images import write_image
from calibgui.gui.images.image_model import Role
from calibgui.gui.verdict.before_after import BeforeAndAfter
from calibgui.gui.widgets import theme
from calibgui.gui.window.main_window import MainWindow

Pixels = npt.NDArray[np.uint8]

FILE = Path(__file__).resolve().parents[1] / "resources" / "images" / "window.webp"
SIZE = 1100, 680
"""Width and height of the window, px."""
_FRAME_MS = 120
"""Time between two frames."""
_LEAST_CHANGE = 0.002
"""Share of the pixels that change from frame to frame while the window works: more than the numbers
of the progress bar."""
_STOP_MS = 1800
"""Time for reading what has come of a step."""
_STEPS = 4
"""Frames of a movement of the cursor."""
_ARROW = ((0, 0), (0, 17), (4, 13), (7, 20), (10, 19), (7, 12), (12, 12))
"""Outline of the cursor, px from its tip."""
_QUALITY = 72
"""Quality of the frames in WebP: texts are sharp, and the film stays below 1 MB."""
_STRETCH = 1.005
"""Height over width of the squares."""


class Film:
    """Takes frames of a window, and leads the cursor."""

    def __init__(self, window: MainWindow) -> None:
        self._window = window
        self._cursor = QPointF(60, SIZE[1] - 60)
        self._frames: list[tuple[Pixels, int]] = []

    def shoot(self, duration: int = _FRAME_MS) -> None:
        """Take a frame that stays for so many ms; one like the last lengthens that."""
        frame = self._grab()
        if self._frames and np.array_equal(self._frames[-1][0], frame):
            self._frames[-1] = frame, self._frames[-1][1] + duration
        else:
            self._frames.append((frame, duration))

    def film_until(self, condition: Callable[[], object]) -> None:
        """Film while the window works, leaving out times in which little happens."""
        while not condition():
            pause(_FRAME_MS / 1000)
            changed = np.any(self._grab() != self._frames[-1][0], axis=2)
            if changed.mean() > _LEAST_CHANGE:
                self.shoot()
        pause(_FRAME_MS / 1000)
        self.shoot()

    def _grab(self) -> Pixels:
        """Return what the window shows, (height, width, 3), with the cursor."""
        picture = self._window.grab().toImage().convertToFormat(QImage.Format.Format_RGB32)
        painter = QPainter(picture)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(QPen(Qt.GlobalColor.white, 1.5))
        painter.setBrush(Qt.GlobalColor.black)
        painter.drawPolygon(QPolygonF([self._cursor + QPointF(*at) for at in _ARROW]))
        painter.end()
        bgra = np.frombuffer(picture.constBits(), np.uint8).reshape(*SIZE[::-1], 4)
        return bgra[..., 2::-1].copy()

    def move_to(self, widget: QWidget, at: QPoint | None = None) -> None:
        """Lead the cursor to a place in a widget, by default its middle."""
        at = widget.rect().center() if at is None else at
        start, end = self._cursor, QPointF(widget.mapTo(self._window, at))
        for step in range(1, _STEPS + 1):
            self._cursor = start + (end - start) * step / _STEPS
            if step == _STEPS:
                QTest.mouseMove(widget, at)
                pause(0.05)
            self.shoot(_FRAME_MS // 2)

    def click(self, widget: QWidget) -> None:
        """Lead the cursor to a widget's middle and click."""
        self.move_to(widget)
        self.shoot(300)
        QTest.mouseClick(widget, Qt.MouseButton.LeftButton)

    def save(self, path: Path, quality: int = _QUALITY) -> None:
        """Write the film, which begins anew at its end."""
        pictures = [Image.fromarray(frame) for frame, _ in self._frames]
        pictures[0].save(
            path,
            save_all=True,
            append_images=pictures[1:],
            duration=[duration for _, duration in self._frames],
            loop=0,
            quality=quality,
            method=6,
        )


def act(window: MainWindow, film: Film, folder: Path) -> None:
    """Go from the empty window to a calibration that is kept."""
    session = window.session
    film.shoot(900)
    data = QMimeData()
    data.setUrls([QUrl.fromLocalFile(str(folder))])
    film.move_to(window.welcome)
    drop = QDropEvent(
        QPointF(window.rect().center()),
        Qt.DropAction.CopyAction,
        data,
        Qt.MouseButton.LeftButton,
        Qt.KeyboardModifier.NoModifier,
    )
    window.dropEvent(drop)
    bar = window.verdict
    film.film_until(lambda: bar.verdict is not None and not session.jobs.running)
    film.shoot(_STOP_MS)
    pause(0.2)
    strip = window.images.list
    for row in (2, 4):
        index = strip.model().index(row, 0)
        film.move_to(strip.viewport(), strip.visualRect(index).center())
        film.shoot(500)
    session.select(strip.model().index(4, 0).data(Role.PATH))
    film.film_until(lambda: window.page.shown_path == session.image)
    while bar.verdict is not None and bar.verdict.findings and bar.verdict.findings[0].action:
        film.click(bar.button)
        film.film_until(
            lambda: (
                isinstance(bar.comparison, BeforeAndAfter)
                and bar.comparison.isVisible()
                and not session.jobs.running
            )
        )
        film.shoot(2 * _STOP_MS)
        assert isinstance(bar.comparison, BeforeAndAfter)
        film.click(bar.comparison.keep)
    film.click(bar.square.confirm)
    wait(lambda: not session.jobs.running)
    pause(0.5)  # panels are drawn anew a moment later; until then a picture shows them black
    film.move_to(window.page.canvas)
    film.shoot(2 * _STOP_MS)


def main() -> None:
    """Draw the film."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file", nargs="?", type=Path, default=FILE)
    path = parser.parse_args().file
    with TemporaryDirectory() as folder, open_window(*SIZE, theme.Scheme.LIGHT) as window:
        for number in range(1, len(VIEWS) + 1):
            photograph = draw_photograph(number, replace(LOOK, stretch=_STRETCH))
            write_image(Path(folder) / f"view{number:02d}.png", photograph)
        pause(0.3)
        film = Film(window)
        act(window, film, Path(folder))
        film.save(path)


if __name__ == "__main__":
    main()
