"""The work that the window does ahead of its user: modules, compiled kernels, and panels."""

from __future__ import annotations

import gc
from collections.abc import Callable
from importlib import import_module

from PySide6.QtCore import QObject, QTimer
from PySide6.QtWidgets import QApplication, QWidget

from calibgui.app.system.kernel_preparation import compile_kernels, prepare_solver
from calibgui.engine.kernels import are_all_kept
from calibgui.gui.images.film_strip import FilmStrip
from calibgui.gui.jobs import qt_names
from calibgui.gui.jobs.job import nothing
from calibgui.gui.session.session import Session


class Preparation(QObject):
    """Prepares what will be needed, while nobody waits for it.

    Args:
        window: that it prepares things for.
        session: whose results the panels show.
        strip: which stands still while a panel is built.
        build_next: builds one panel that was not shown yet, and tells whether there was any.
    """

    def __init__(
        self, window: QWidget, session: Session, strip: FilmStrip, build_next: Callable[[], bool]
    ) -> None:
        super().__init__(window)
        self._window, self._session, self._strip = window, session, strip
        self._build_next = build_next
        self._building = QTimer(self, interval=_PAUSE)
        self._building.timeout.connect(self._build_ahead)

    def start(self) -> None:
        """Import beside the main thread what will be needed: detectors, SciPy, panels, solver; then
        compile kernels, once after an installation.

        Once there is a result, the panels on it are built before they are asked for.

        What is there by then stays: going through it at every full collection of garbage would
        stop the window for longer than a frame.
        """
        qt_names.make_classes(self._window, self._load)
        self._session.result_changed.connect(lambda _: self._building.start())
        bar = self._strip.list.horizontalScrollBar()
        for in_use in (self._session.selected, self._session.hovered, bar.valueChanged):
            in_use.connect(lambda *_: self._put_off_building())

    def _load(self) -> None:
        if self._window.isVisible():  # it may have been closed meanwhile
            self._session.jobs.start("", lambda _: _load_ahead(), self._compile)

    def _compile(self, are_kernels_kept: bool) -> None:
        gc.freeze()
        if not are_kernels_kept and self._window.isVisible():
            self._session.jobs.start(
                self.tr("Compiling for speed, once"),
                lambda job: compile_kernels(job.advance, job.cancelling),
                failed=nothing,  # the readable functions go on
                is_about_document=False,
            )

    def _put_off_building(self) -> None:
        """Build the next panel only after a pause: who scrolls would see the strip stand still."""
        if self._building.isActive():
            self._building.start()

    def _build_ahead(self) -> None:
        """Build one panel that was not shown yet, unless somebody works."""
        working = any(job.is_about_document for job in self._session.jobs.running)
        if not (working or QApplication.mouseButtons()):
            self._building.stop()  # so that a panel that cannot be built is not tried for ever
            if self._build_next():
                self._building.start()


def _load_ahead() -> bool:
    """Import what is needed soon; return whether all kernels are compiled, and load them then."""
    for name in _NEEDED_SOON:
        import_module(name)
    if is_kept := are_all_kept():
        prepare_solver()
    return is_kept


_NEEDED_SOON = (
    "calibgui.engine.detection.find_corners",
    "calibgui.engine.redetection.redetect_corners",
    "calibgui.gui.panels.analysis",
)
"""Modules that are imported beside the main thread once the window is open."""
_PAUSE = 150
"""Time between two panels that are built ahead, ms: what the user does comes between them."""
