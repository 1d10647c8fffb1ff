"""The panels on a result in their groups, one of which is shown."""

from __future__ import annotations

from functools import partial
from typing import TypeVar, cast

from PySide6.QtCore import QEvent, QTimer, Signal
from PySide6.QtWidgets import (
    QComboBox,
    QHBoxLayout,
    QLabel,
    QMenu,
    QPushButton,
    QSizePolicy,
    QStackedWidget,
    QVBoxLayout,
    QWidget,
)

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
from calibgui.gui.panels.groups import Group, Page
from calibgui.gui.panels.method.convergence import ConvergencePanel
from calibgui.gui.panels.method.distortion import DistortionPanel
from calibgui.gui.panels.method.lens_models import LensModelsPanel
from calibgui.gui.panels.method.methods import MethodsPanel
from calibgui.gui.panels.method.stage_one import StageOnePanel
from calibgui.gui.panels.method.synthetic import SyntheticPanel
from calibgui.gui.panels.panel import Panel
from calibgui.gui.panels.panel_area import PanelArea
from calibgui.gui.panels.panel_chooser import PanelChooser, describe_panel, name_panel
from calibgui.gui.panels.services import Services
from calibgui.gui.session.session import Session
from calibgui.gui.widgets import theme

GROUPS: dict[Group, tuple[type[Panel], ...]] = {
    Group.ANSWER: (ResultPanel, UncertaintyPanel, UndistortPanel, ComparePanel),
    Group.EVIDENCE: (
        ResidualsPanel,
        HistogramsPanel,
        PosesPanel,
        CoveragePanel,
        BoardShapePanel,
    ),
    Group.METHOD: (
        StageOnePanel,
        ConvergencePanel,
        DistortionPanel,
        LensModelsPanel,
        MethodsPanel,
        SyntheticPanel,
    ),
}
"""The panels of each group, in their order."""

PANELS: tuple[type[Panel], ...] = tuple(kind for kinds in GROUPS.values() for kind in kinds)
"""All panels."""

PANEL_WIDTH = 380
"""Least width of a panel, px."""

_TURN = 1
"""Time after which the event loop has begun another turn, ms; what waits for none is done in this
one."""

P = TypeVar("P", bound=Panel)


class Analysis(QWidget):
    """Shows the named results, and every panel on the chosen one."""

    exclude_wanted = Signal(list)
    """Images that the user wants out of the calibration."""
    save_wanted = Signal(tuple, object)
    """See `Panel.save_wanted`."""
    lens_wanted = Signal(str, tuple)
    """See `Panel.lens_wanted`."""
    method_wanted = Signal(str, object)
    """See `Panel.method_wanted`."""
    export_wanted = Signal()
    rename_wanted = Signal(str)
    delete_wanted = Signal(str)
    group_shown = Signal(Group)
    """A panel of this group has come to the front."""

    def __init__(self, session: Session) -> None:
        super().__init__()
        self._session = session
        self._services = Services(session.jobs, session.images.read)
        self._shown: Result | None = None
        self._built: dict[type[Panel], Panel] = {}
        self._areas: dict[type[Panel], PanelArea] = {}
        self.choosers = {group: PanelChooser(kinds) for group, kinds in GROUPS.items()}
        self._last = {group: kinds[0] for group, kinds in GROUPS.items()}
        """The panel that was shown last of each group."""
        self._names = QStackedWidget()
        self._names.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Fixed)
        for chooser in self.choosers.values():
            chooser.chosen.connect(self.show_panel)
            self._names.addWidget(chooser)
        self.stack = QStackedWidget()
        # All panels get the width that there is, or choosing one would move the image.
        self.stack.setMinimumSize(PANEL_WIDTH, 0)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(theme.SPACING // 2)
        layout.addWidget(self._names)
        layout.addLayout(self._make_bar())
        layout.addWidget(self.stack, 1)
        session.changed.connect(self._project_changed)
        session.result_changed.connect(self._show_result)
        session.judged.connect(self._note_verdict)
        session.selected.connect(self._select)
        session.hovered.connect(self._hover)
        self._show_result(session.result)
        self.show_panel(ResultPanel)

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
            panel.show_result(self._shown)
            panel.select(self._place(self._session.image), self._session.corner)
            area = self._areas[kind] = PanelArea(panel)
            self.stack.addWidget(area)
        return cast(P, self._built[kind])

    def show_panel(self, kind: type[P]) -> P:
        """Bring a panel to the front."""
        panel = self.panel(kind)
        group = next(group for group, kinds in GROUPS.items() if kind in kinds)
        self._last[group] = kind
        self._bring_to_front(self._areas[kind])
        self.choosers[group].show_chosen(kind)
        self._names.setCurrentWidget(self.choosers[group])
        self.group_shown.emit(group)
        return panel

    def _bring_to_front(self, area: PanelArea) -> None:
        if self.stack.currentWidget() is not area:
            self._put_off_painting(area)
            self.stack.setCurrentWidget(area)

    def _put_off_painting(self, area: QWidget) -> None:
        """Paint a panel in the next turn: to fill it, too, would take too long for one."""
        area.setUpdatesEnabled(False)
        QTimer.singleShot(_TURN, area, lambda: area.setUpdatesEnabled(True))

    def build_next(self) -> bool:
        """Build the first panel that is not there yet; return False if all are."""
        missing = next((kind for kind in PANELS if kind not in self._built), None)
        if missing is not None:
            self.panel(missing)
        return missing is not None

    @property
    def shown(self) -> Panel:
        """The panel in front."""
        area = self.stack.currentWidget()
        assert isinstance(area, PanelArea)
        return area.panel

    def list_pages(self) -> list[Page]:
        """Return the panels, as pages that the inspector shows."""
        return [
            Page(name_panel(kind), describe_panel(kind), partial(self.show_panel, kind))
            for kind in PANELS
        ]

    def show_panel_named(self, name: str) -> None:
        """Bring the panel of a class to the front."""
        self.show_panel(next(kind for kind in PANELS if kind.__name__ == name))

    def show_group(self, group: Group) -> None:
        """Bring that panel of a group to the front that was there last."""
        self.show_panel(self._last[group])

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

    def _make_bar(self) -> QHBoxLayout:
        self.results = QComboBox()
        self.results.setAccessibleName(self.tr("Result"))
        self.results.setToolTip(self.tr("Every calibration keeps its result under a name"))
        self.results.activated.connect(
            lambda row: self._session.show_result(self.results.itemText(row))
        )
        self.state = QLabel()
        self.export = QPushButton(self.tr("Export…"))
        self.export.setToolTip(self.tr("Write the camera for another program (Ctrl+E)"))
        self.export.clicked.connect(self.export_wanted)
        self.more = QPushButton(self.tr("Manage"))
        self.more.setToolTip(self.tr("Rename, delete or compare results"))
        menu = QMenu(self.more)
        self.compare = menu.addMenu(self.tr("&Compare with"))
        menu.addAction(
            self.tr("&Rename…"), lambda: self.rename_wanted.emit(self._session.result_name)
        )
        menu.addAction(
            self.tr("&Delete"), lambda: self.delete_wanted.emit(self._session.result_name)
        )
        self.more.setMenu(menu)
        bar = QHBoxLayout()
        bar.setContentsMargins(0, 0, theme.SPACING, 0)
        bar.addWidget(self.results, 1)
        for widget in (self.state, self.export, self.more):
            bar.addWidget(widget)
        return bar

    def _project_changed(self, before: Project, after: Project) -> None:
        is_another_due = self._session.result is not self._shown  # which lists them itself
        if before.results is not after.results and not is_another_due:
            self._list_results()
        self._show_state()

    def _list_results(self) -> None:
        names = list(self._session.project.results)
        self.results.clear()
        self.results.addItems(names)
        self.results.setCurrentText(self._session.result_name)
        for control in (self.results, self.export, self.more):
            control.setEnabled(bool(names))
        self.compare.clear()
        for name in names:
            if name != self._session.result_name:
                self.compare.addAction(name, partial(self.compare_with, name))
        self.compare.setEnabled(len(names) > 1)
        for panel in self._built.values():
            panel.offer_results(self._session.project.results)

    def compare_with(self, name: str) -> None:
        """Set another result beside the one shown."""
        self.show_panel(ComparePanel).compare(name, self._session.result_name)

    def _show_state(self) -> None:
        age = self._session.describe_age(self._session.result)
        self.state.setText(self.tr("out of date") if age else "")
        self.state.setToolTip(age)
        self.state.setStyleSheet(f"color: {theme.current().warning}")

    def changeEvent(self, event: QEvent) -> None:  # noqa: N802 - Qt's name
        super().changeEvent(event)
        if event.type() == QEvent.Type.PaletteChange and hasattr(self, "state"):
            self._show_state()

    def _show_result(self, result: Result | None) -> None:
        self._list_results()
        self._show_state()
        if result is self._shown:
            return
        self._shown = result
        if (front := self.stack.currentWidget()) is not None:
            self._put_off_painting(front)
        for panel in self._built.values():
            panel.show_result(result)
        self._select(self._session.image, self._session.corner)

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

    def _exclude(self, views: tuple[int, ...]) -> None:
        if self._shown is not None:
            self.exclude_wanted.emit([self._shown.views[k].image for k in views])
