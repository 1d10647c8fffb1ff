"""The panels on a result by the modes that show them, one of which is in front."""

from __future__ import annotations

from functools import partial
from typing import TypeVar, cast

from PySide6.QtCore import QTimer, Signal
from PySide6.QtWidgets import QStackedWidget, QWidget

from calibgui.app.projects.project import Project
from calibgui.dataset import Result
from calibgui.engine.calibration import Iteration
from calibgui.gui.panels.answer.compare import ComparePanel
from calibgui.gui.panels.answer.result import ResultPanel
from calibgui.gui.panels.answer.uncertainty import UncertaintyPanel
from calibgui.gui.panels.answer.undistort import UndistortPanel
from calibgui.gui.panels.evidence.board_shape import BoardShapePanel
from calibgui.gui.panels.evidence.coverage import CoveragePanel
from calibgui.gui.panels.evidence.histograms import HistogramsPanel
from calibgui.gui.panels.evidence.poses import PosesPanel
from calibgui.gui.panels.evidence.residuals import ResidualsPanel
from calibgui.gui.panels.method.convergence import ConvergencePanel
from calibgui.gui.panels.method.distortion import DistortionPanel
from calibgui.gui.panels.method.lens_models import LensModelsPanel
from calibgui.gui.panels.method.methods import MethodsPanel
from calibgui.gui.panels.method.stage_one import StageOnePanel
from calibgui.gui.panels.method.synthetic import SyntheticPanel
from calibgui.gui.panels.mode_page import ModePage, Row, describe_panel, name_panel
from calibgui.gui.panels.modes import Mode, Page
from calibgui.gui.panels.panel import Panel
from calibgui.gui.panels.services import Services
from calibgui.gui.session.session import Session

MODES: dict[Mode, tuple[Row, ...]] = {
    Mode.METHOD: (
        Row((StageOnePanel,), 0.5),
        Row((ConvergencePanel, SyntheticPanel), 0.5),
        Row((MethodsPanel,), 1.0),
    ),
    Mode.FIT: (
        Row((ResidualsPanel, UncertaintyPanel), 0.92),
        Row((HistogramsPanel,), 0.6),
        Row((ResultPanel,), 0.9),
    ),
    Mode.LENS: (Row((DistortionPanel,), 0.92), Row((LensModelsPanel,), 0.9)),
    Mode.BOARD: (Row((BoardShapePanel,), 1.0),),
    Mode.SPACE: (Row((PosesPanel,), 0.92), Row((CoveragePanel,), 0.75)),
    Mode.UNDISTORT: (Row((UndistortPanel,), 1.0),),
    Mode.COMPARE: (Row((ComparePanel,), 1.0),),
}
"""The panels of each mode, in rows; the photographs have none."""

PANELS: tuple[type[Panel], ...] = tuple(
    kind for rows in MODES.values() for row in rows for kind in row.kinds
)
"""All panels."""

_TURN = 1
"""Time after which the event loop has begun another turn, ms; what waits for none is done in this
one."""

P = TypeVar("P", bound=Panel)


class Analysis(QStackedWidget):
    """Shows every panel on the chosen result, those of one mode at a time.

    A panel is made, filled and painted in turns of the event loop of their own.
    """

    exclude_wanted = Signal(list)
    """Images that the user wants out of the calibration."""
    save_wanted = Signal(tuple, object)
    """See `Panel.save_wanted`."""
    lens_wanted = Signal(str, tuple)
    """See `Panel.lens_wanted`."""
    method_wanted = Signal(str, object)
    """See `Panel.method_wanted`."""
    mode_shown = Signal(Mode)
    """A panel of this mode has come to the front."""
    corner_picked = Signal()
    """The user points at a corner, which is seen in its photograph."""

    def __init__(self, session: Session) -> None:
        super().__init__()
        self._session = session
        self._services = Services(session.jobs, session.images.read)
        self._shown: Result | None = None
        self._built: dict[type[Panel], Panel] = {}
        self._pages: dict[Mode, ModePage] = {}
        self._front: type[Panel] = ResidualsPanel
        self._filled: dict[type[Panel], Result | None] = {}
        """The result that each panel was given last."""
        self._waiting: list[type[Panel]] = []
        """Panels that are made, filled and shown one after the other."""
        self._turn = QTimer(self, singleShot=True, interval=_TURN)
        self._turn.timeout.connect(self._bring_up_next)
        session.changed.connect(self._project_changed)
        session.result_changed.connect(self._show_result)
        session.judged.connect(self._note_verdict)
        session.selected.connect(self._select)
        session.hovered.connect(self._hover)
        self._show_result(session.result)

    def panel(self, kind: type[P]) -> P:
        """The panel of that kind; built when it is wanted first."""
        if kind not in self._built:
            panel = self._built[kind] = kind(self._services)
            panel.picked.connect(self._select_picked)
            panel.hovered.connect(self._hover_shown)
            panel.exclude_wanted.connect(self._exclude)
            panel.save_wanted.connect(self.save_wanted)
            panel.lens_wanted.connect(self.lens_wanted)
            panel.method_wanted.connect(self.method_wanted)
            panel.failed.connect(self._session.failed)
            panel.offer_results(self._session.project.results)
            panel.hide()
            self._page(find_mode(kind)).cards[kind].hold(panel)
            self._fill(kind)
        return cast(P, self._built[kind])

    def show_panel(self, kind: type[P]) -> P:
        """Bring a panel to the front, and the others of its mode after it."""
        self._bring_to_front(kind)
        self._page(find_mode(kind)).bring_into_sight(kind)
        return self.panel(kind)

    def show_mode(self, mode: Mode) -> None:
        """Show the panels of a mode as they were left, or from its top."""
        is_there = self.currentWidget() is self._page(mode) and find_mode(self._front) is mode
        self._bring_to_front(self._front if is_there else MODES[mode][0].kinds[0])

    def _bring_to_front(self, kind: type[Panel]) -> None:
        mode = find_mode(kind)
        self._front, page = kind, self._page(mode)
        others = [other for other in page.cards if other is not kind]
        if self.currentWidget() is not page or not self.isVisible():
            for other in others:  # each comes in a turn of its own
                if other in self._built:
                    self._built[other].hide()
        self.setCurrentWidget(page)
        self.mode_shown.emit(mode)
        self._bring_up(kind)
        self._waiting = [*others, *(other for other in self._waiting if other not in page.cards)]
        self._turn.start()

    def _bring_up(self, kind: type[Panel]) -> None:
        """Have a panel show the result, and be in sight if its mode is."""
        panel = self.panel(kind)
        if self._filled[kind] is not self._shown:
            self._fill(kind)
        if panel.isHidden() and find_mode(kind) is find_mode(self._front):
            self._put_off_painting(panel)
            panel.show()

    def _bring_up_next(self) -> None:
        if self._waiting:
            self._bring_up(self._waiting.pop(0))
            self._turn.start()

    def _put_off_painting(self, panel: QWidget) -> None:
        """Paint a panel in the next turn: to fill it, too, would take too long for one."""
        panel.setUpdatesEnabled(False)
        QTimer.singleShot(_TURN, panel, lambda: panel.setUpdatesEnabled(True))

    def _page(self, mode: Mode) -> ModePage:
        if mode not in self._pages:
            self._pages[mode] = ModePage(MODES[mode])
            self.addWidget(self._pages[mode])
        return self._pages[mode]

    def build_next(self) -> bool:
        """Build the first panel that is not there yet; return False if all are."""
        missing = next((kind for kind in PANELS if kind not in self._built), None)
        if missing is not None:
            self.panel(missing)
        return missing is not None

    @property
    def shown(self) -> Panel:
        """The panel that was brought to the front last."""
        return self.panel(self._front)

    def list_pages(self) -> list[Page]:
        """Return the panels, as pages that the window shows."""
        return [
            Page(name_panel(kind), describe_panel(kind), partial(self.show_panel, kind))
            for kind in PANELS
        ]

    def show_panel_named(self, name: str) -> None:
        """Bring the panel of a class to the front."""
        self.show_panel(next(kind for kind in PANELS if kind.__name__ == name))

    def show_beginning(self) -> None:
        """A calibration starts: its progress is shown where one looks at it."""
        cost = self._session.project.settings.cost
        self.panel(ConvergencePanel).start(cost)  # before it would draw the last one

    def show_iteration(self, iteration: Iteration) -> None:
        """A calibration has come one iteration further."""
        self.panel(ConvergencePanel).add(iteration)

    def show_end(self) -> None:
        """A calibration is over: what came of it is shown in place of its progress."""
        self.panel(ConvergencePanel).show_result(self._session.result)

    def _project_changed(self, before: Project, after: Project) -> None:
        is_another_due = self._session.result is not self._shown  # which lists them itself
        if before.results is not after.results and not is_another_due:
            self._offer_results()

    def _offer_results(self) -> None:
        for panel in self._built.values():
            panel.offer_results(self._session.project.results)

    def compare_with(self, name: str) -> None:
        """Set another result beside the one shown."""
        self.show_panel(ComparePanel).compare(name, self._session.result_name)

    def _show_result(self, result: Result | None) -> None:
        self._offer_results()
        if result is self._shown:
            return
        self._shown = result
        for kind, panel in self._built.items():
            if kind is self._front or not panel.isVisible():
                self._fill(kind)
            else:
                self._waiting.append(kind)
        self._turn.start()

    def _fill(self, kind: type[Panel]) -> None:
        """Show the result in a panel, which is painted in the next turn."""
        panel = self._built[kind]
        if panel.isVisible():
            self._put_off_painting(panel)
        self._filled[kind] = self._shown
        panel.show_result(self._shown)
        panel.select(self._place(self._session.image), self._session.corner)

    def _note_verdict(self) -> None:
        for panel in self._built.values():
            panel.note_verdict()

    def _select(self, image: str, corner: int) -> None:
        if self._shown is not None:
            for panel in self._built.values():
                panel.select(self._place(image), corner)

    def _hover(self, image: str) -> None:
        for panel in self._built.values():
            panel.hover(self._place(image))

    def _hover_shown(self, view: int) -> None:
        if self._shown is not None:
            self._session.hover(self._shown.views[view].image if view >= 0 else "")

    def _place(self, image: str) -> int:
        """Index of an image in the shown result; -1 if it has none."""
        views = () if self._shown is None else self._shown.views
        return next((i for i, view in enumerate(views) if view.image == image), -1)

    def _select_picked(self, view: int, corner: int) -> None:
        if self._shown is not None:
            self._session.select(self._shown.views[view].image, corner)
            if corner >= 0:
                self.corner_picked.emit()

    def _exclude(self, views: tuple[int, ...]) -> None:
        if self._shown is not None:
            self.exclude_wanted.emit([self._shown.views[k].image for k in views])


def find_mode(kind: type[Panel]) -> Mode:
    """Return the mode that shows a kind of panel."""
    return next(mode for mode, rows in MODES.items() if any(kind in row.kinds for row in rows))
