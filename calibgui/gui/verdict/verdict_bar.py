"""The verdict on the shown result: a headline, its figures and the button that makes it better."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from pathlib import PurePath
from typing import assert_never

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QLabel, QSizePolicy, QWidget

from calibgui.app.calibrating.true_board import measure_gain_of_glass
from calibgui.app.projects.project import Project
from calibgui.app.projects.remedies import apply_action, state_glass
from calibgui.dataset import Result, ViewStatus
from calibgui.dataset.judging import judge_result, recall_verdict
from calibgui.engine.arrays import Array
from calibgui.engine.assessment import Action, ActionKind, Cause, Finding, Grade, Verdict
from calibgui.engine.calibration import METHODS, Status, is_held
from calibgui.engine.uncertainty import estimate_projection_uncertainty
from calibgui.gui.jobs.job import Job
from calibgui.gui.panels.latest import Latest
from calibgui.gui.session.session import Session
from calibgui.gui.verdict.findings_list import FindingsList
from calibgui.gui.verdict.grade_icon import GradeIcon, get_colour
from calibgui.gui.verdict.limits_row import LimitsRow
from calibgui.gui.verdict.remedy_runner import CarriedOut, RemedyRunner
from calibgui.gui.verdict.sensor_figure import SensorFigure
from calibgui.gui.verdict.sentences import translate_sentences
from calibgui.gui.verdict.square_row import SquareRow
from calibgui.gui.verdict.texts import describe_button, describe_grade
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.buttons import Button, Kind
from calibgui.gui.widgets.elided import elide_name
from calibgui.gui.widgets.fit_text import describe_fit
from calibgui.gui.widgets.layouts import make_column, make_row
from calibgui.gui.widgets.lengths import state_condition
from calibgui.gui.widgets.pattern_texts import list_pattern_texts
from calibgui.gui.widgets.reserved_label import ReservedLabel
from calibgui.report.summary import describe_lost_images
from calibgui.report.verdict import describe_reason

_PLACES = "CoveragePanel"
"""The panel that shows where to hold the board."""
_LINES, _LINES_IF_ROOMY = 2, 3
"""Lines that are reserved for the reason, so that another verdict moves nothing below."""
_LINES_OF_QUESTION = 2
"""Lines that are reserved for the question how long the squares are."""
ROOMY = 690
"""Height of the inspector above which the reason has another line, device-independent px."""
_LEAST_HEIGHT, _HEIGHT, _REST = 120, 180, 494
"""Least and usual height of the picture, and that of all else in an inspector without remedies,
device-independent px."""
_NAME_LENGTH = 16
"""Letters of a name that have room on a button in the least width."""


class VerdictBar(QWidget):
    """Always in sight; what is wrong is listed on demand, over the desk.

    Args:
        session: whose shown result is judged.
        desk: over which the lists open.
    """

    panel_wanted = Signal(str)
    """The class name of a panel that the user wants to see."""
    shown = Signal(object, str)
    """The grade that is shown, or None, and the headline."""

    def __init__(self, session: Session, desk: QWidget) -> None:
        super().__init__()
        self.setObjectName("verdict")
        self._session, self._desk = session, desk
        self._result: Result | None = None
        self._judged: Result | None = None
        """The result whose verdict is shown: the last one that has any, in the same project."""
        self._document = session.document
        self._age = ""
        """The sentence that says that the shown result is out of date; "" if it is not."""
        self._is_running = self._is_searching = False
        self.verdict: Verdict | None = None
        self._glass: Mapping[str, float] | None = None
        """The ± that would come with a board of glass, where they are worth being told.

        None until the shown result is judged.
        """
        self._work, self._map_work = Latest(session.jobs, self), Latest(session.jobs, self)
        self.remedy_runner = RemedyRunner(session)
        self.icon = GradeIcon()
        self.headline = QLabel()
        self.headline.setFont(theme.make_font(theme.HEADLINE, bold=True))
        # It must not push aside what stands beside the verdict below the strip.
        self.headline.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        self.reason = ReservedLabel(_LINES)
        self.limits = LimitsRow(session)
        self.figures = SensorFigure()
        self._fit = ""
        """The words on the residuals, which are made once for each calibration."""
        self.button = Button(self.tr("Remedy"), Kind.MAIN)
        self.button.clicked.connect(self._do_first)
        self.unfold = Button()
        self.unfold.setCheckable(True)
        self.square = SquareRow(session)
        self.square.reserve(_LINES_OF_QUESTION)
        self.findings = FindingsList(desk)
        self.findings.action_wanted.connect(lambda finding: self._act(finding.action))
        self.findings.proof_wanted.connect(self._show_proof)
        self.findings.glass_wanted.connect(self._state_glass)
        self.findings.closed.connect(lambda: self.unfold.setChecked(False))
        self.unfold.toggled.connect(self.findings.setVisible)
        self.comparison: QWidget | None = None
        self._lay_out()
        self.fit_height(ROOMY)
        self.remedy_runner.began.connect(self._show_buttons)
        self.remedy_runner.ended.connect(self._show_buttons)
        self.remedy_runner.done.connect(self._compare)
        session.result_changed.connect(self._judge)
        session.changed.connect(lambda *_: self._show_age())
        theme.follow(self._restyle)
        self._judge(session.result)

    def _lay_out(self) -> None:
        top = make_row(self.icon, (self.headline, 1))
        self.action_row = QWidget()
        """What can be done about the verdict; it stands where the inspector has room."""
        make_row(self.button, self.unfold, None, of=self.action_row)
        make_column(
            top,
            self.reason,
            self.square,
            self.figures,
            self.limits,
            of=self,
            spacing=theme.SPACING // 2,
        )
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Fixed)

    def show_running(self, running: bool, searching: bool) -> None:
        """Say that a better result is on its way, or judge the one that there is.

        Args:
            running: whether a calibration is under way.
            searching: whether it waits for corners that are searched.
        """
        if (running, searching) != (self._is_running, self._is_searching):
            self._is_running, self._is_searching = running, searching
            if self._glass is None:
                self._judge(self._result)

    def fit_height(self, of_inspector: int) -> None:
        """Leave room to what is below in an inspector that is not high."""
        self.reason.reserve(_LINES_IF_ROOMY if of_inspector > ROOMY else _LINES)
        self.figures.setFixedHeight(min(max(of_inspector - _REST, _LEAST_HEIGHT), _HEIGHT))
        if (layout := self.layout()) is not None:
            layout.activate()  # whoever is being resized asks at once how high all is by now

    def _judge(self, result: Result | None) -> None:
        """Find out what the shown result is worth, beside the window, once nothing better comes.

        Until then the last verdict stays.
        """
        is_held_camera = result is not None and is_held(result.calibration)
        if result is None or is_held_camera or self._session.document is not self._document:
            self._judged, self._document = None, self._session.document
        last, self._result = self._result, result
        self.verdict = None if result is None else recall_verdict(result)
        is_alike = result and last and last.calibration is result.calibration
        if not is_alike:
            self._fit = "" if result is None else describe_fit(result)
            self._glass = None
            self._map(result)
        if self.verdict is None:
            self.unfold.setChecked(False)
        else:
            self._judged = result
        self._work.cancel()
        # What makes the camera better may have judged it already; the panels wait to be told.
        if result and not is_held_camera and self._glass is None and not self._is_running:
            self._work.start(
                "" if self.verdict else self.tr("Judging the calibration"),
                partial(_judge_with_glass, result),
                self._receive,
                self._session.failed.emit,
            )
        self._show()

    def _map(self, result: Result | None) -> None:
        """Find the colours of the sensor; the last ones stay until then."""
        show = self.figures.show_map
        if result is None:
            self._map_work.cancel()
            show(None)
        else:
            self._map_work.start("", lambda _: _map_errors(result), show, lambda _: show(None))

    def _receive(self, answer: tuple[Verdict, Mapping[str, float]]) -> None:
        self.verdict, self._glass = answer
        self._judged = self._result
        self._session.judged.emit()
        self._show()

    def _show_age(self) -> None:
        """Show whether the result is of the project as it is now, if that has changed.

        A result that is about to take its place is shown then.
        """
        is_shown = self._session.result is self._result
        is_of_other_age = self._age != self._session.describe_age(self._result)
        if is_shown and (self._result is None or is_of_other_age):
            self._show_reason()

    def _show(self) -> None:
        verdict, result = self._shown, self._judged
        self._show_reason()
        self.icon.show_grade(None if verdict is None else verdict.grade, dimmed=self._is_dimmed)
        if verdict is None or result is None:
            self.headline.setText(self._describe_state())
        else:
            self.headline.setText(describe_grade(verdict.grade, verdict.times_better))
        self.figures.show_verdict(verdict, result, self._fit, dimmed=self._is_dimmed)
        self.shown.emit(None if verdict is None else verdict.grade, self.headline.text())
        if self.verdict is not None and self._result is not None:
            self.findings.show_verdict(
                self.verdict, self._list_names(), state_condition(self._result), self._offered_glass
            )
        self._show_buttons()
        self._restyle()

    @property
    def _shown(self) -> Verdict | None:
        """The verdict that is shown: that on the shown result, or the last one."""
        return None if self._judged is None else recall_verdict(self._judged)

    @property
    def _is_dimmed(self) -> bool:
        """Return whether the verdict that is shown is on another result than the one shown."""
        return self.verdict is None and self._judged is not None

    def _describe_state(self) -> str:
        """Say in capitals what goes on while there is no verdict at all."""
        if self._result is None:
            if self._is_searching:
                return self.tr("SEARCHING CORNERS…")
            return self.tr("CALIBRATING…") if self._is_running else self.tr("NOT CALIBRATED")
        if is_held(self._result.calibration):
            return self.tr("KNOWN CAMERA")
        return self.tr("FIRST FIT") if self._is_running else self.tr("JUDGING…")

    def _show_reason(self) -> None:
        """Show why the verdict is as it is, and whether it is out of date."""
        verdict, result = self.verdict, self._result
        self._age = self._session.describe_age(result)
        if result is None:
            reason = self._describe_start()
        elif self._is_dimmed and self._judged is not None:
            reason = self.tr("Of {0} photographs. {1}").format(
                len(self._judged.used), self._describe_work()
            )
        elif is_held(result.calibration):
            reason = f"{self._age} {' '.join(result.calibration.warnings)}".lstrip()
        elif verdict is None:
            reason = self._describe_work()
        else:
            said = translate_sentences(_describe_reason(verdict, result))
            reason = f"{self._age} {said}".lstrip()
        self.reason.setText(reason)
        self._restyle()

    def _describe_work(self) -> str:
        """Say what goes on until there is a verdict on the shown result."""
        if self._is_running:
            return self.tr("The new calibration is being made better, and judged.")
        return self.tr("The new calibration is being judged: what makes it better is tried.")

    def _describe_start(self) -> str:
        """Say what is missing for a first result."""
        project = self._session.project
        is_searched = all(view.status is not ViewStatus.WAITING for view in project.views)
        if project.views and is_searched and not project.usable:
            if all(view.status is not ViewStatus.NO_BOARD for view in project.views):
                return self.tr("No photograph can be used: click one to see why.")
            kind = list_pattern_texts()[project.pattern.kind].name
            return self.tr(
                "No board of the kind “{0}” was found: click a photograph to see why."
            ).format(kind)
        if project.by_hand and not project.usable:
            return self.tr(
                "Mark the board in the photographs (M), or let them be searched: Set-up."
            )
        return self.tr("How far the camera can be trusted is said here once it is calibrated.")

    def _show_buttons(self) -> None:
        busy = self.remedy_runner.running
        action = self._action
        self.button.setVisible(action is not None)
        if action is not None:
            self.button.setText(describe_button(action, self._list_names()))
            self.button.setToolTip(self.button.text())  # a name in it may be shortened
        self.button.setEnabled(not busy)
        self.findings.set_busy(busy)
        count = 0 if self.verdict is None else len(self.verdict.findings)
        self.unfold.setVisible(count > 0 or bool(self._offered_glass))
        if count:
            text = self.tr("&1 finding") if count == 1 else self.tr("{0} &findings").format(count)
            tip = self.tr("List what is wrong, with the figures that show it")
        else:
            text = self.tr("Is it &glass?")
            tip = self.tr("Say what it brings to state that the board is of glass")
        self.unfold.setText(text)
        self.unfold.setToolTip(tip)
        self.action_row.setVisible(not (self.button.isHidden() and self.unfold.isHidden()))

    @property
    def _offered_glass(self) -> Mapping[str, float]:
        """The gain of a board of glass, once lengths are confirmed: it is stated in mm."""
        is_stated = self._result is None or self._result.condition
        return {} if is_stated or self._glass is None else self._glass

    @property
    def _action(self) -> Action | None:
        """The action to do first: on the most harmful finding, or to add views."""
        verdict, result = self.verdict, self._result
        if verdict is None or result is None:
            return None
        if verdict.findings:
            return verdict.findings[0].action
        is_finished = result.calibration.status in (Status.CONVERGED, Status.PARTIAL)
        is_open = is_finished and not verdict.is_known_well
        return Action(ActionKind.PHOTOGRAPH_MORE) if is_open else None

    def _list_names(self) -> list[str]:
        used = () if self._result is None else self._result.used
        return [elide_name(PurePath(view.image).stem, _NAME_LENGTH) for view in used]

    def _do_first(self) -> None:
        self._act(self._action)

    def _act(self, action: Action | None) -> None:
        """Carry an action out, or show what the user can do."""
        result = self._result
        if action is None or result is None:
            return
        if action.change is not None:
            self.unfold.setChecked(False)

            def change(project: Project) -> Project:
                return apply_action(project, result, action)

            self.remedy_runner.run(describe_button(action, self._list_names()), change, result)
        elif action.views:
            self._session.select(result.used[action.views[0]].image)
        else:
            self._show_panel(_PLACES)

    def _state_glass(self) -> None:
        """Calibrate with the board stated to be of glass."""
        if self._result is not None:
            self.unfold.setChecked(False)
            self.remedy_runner.run(self.tr("State a board of glass"), state_glass, self._result)

    def _show_proof(self, finding: Finding) -> None:
        """Show the panel that proves a finding, and the first view that it is found in."""
        if self._result is not None and finding.views:
            self._session.select(self._result.used[finding.views[0]].image)
        self._show_panel(_choose_proof(finding.cause))

    def _show_panel(self, name: str) -> None:
        self.unfold.setChecked(False)
        self.panel_wanted.emit(name)

    def _compare(self, carried_out: CarriedOut) -> None:
        """Show what an action has done; plots are imported when there is something to plot."""
        from calibgui.gui.verdict.before_after import BeforeAndAfter

        if not isinstance(self.comparison, BeforeAndAfter):
            self.comparison = BeforeAndAfter(self._desk, self._session)
            self.comparison.taken_back.connect(self.remedy_runner.take_back)
        self.comparison.show_carried_out(carried_out)

    def _restyle(self) -> None:
        """Colour the words, by palettes: a style sheet would style all that is in the bar."""
        colours = theme.current()
        plain = colours.muted if self._is_dimmed else colours.text
        theme.set_text_colour(self.reason, colours.warning if self._age else plain)
        theme.set_text_colour(self.headline, get_colour(self._grade))
        self.update()

    @property
    def _grade(self) -> Grade | None:
        """The grade of the shown result, if it is known."""
        return None if self.verdict is None else self.verdict.grade


def _judge_with_glass(result: Result, job: Job) -> tuple[Verdict, Mapping[str, float]]:
    """Judge a result, and measure what a board of glass would bring if lengths hold."""
    verdict = judge_result(result, job.check)
    if not METHODS[result.calibration.settings.method].is_weighted:
        return verdict, {}  # the panel of settings states no prior beside such a method
    return verdict, measure_gain_of_glass(replace(result, lengths_confirmed=True))


def _map_errors(result: Result) -> Array | None:
    """Map the calibration's own uncertainty; None where the views do not determine the camera, or
    it is known from a file."""
    if result.calibration.diagnosis is not None or is_held(result.calibration):
        return None
    views = result.observations()
    return estimate_projection_uncertainty(result.calibration, views).worst_direction


def _describe_reason(verdict: Verdict, result: Result) -> str:
    """Say what to do next about a result, if no button does it, and why it has its grade."""
    if (diagnosis := result.calibration.diagnosis) is not None:
        return f"{diagnosis.message} {describe_lost_images(result) or diagnosis.hint}"
    reason = describe_reason(verdict, result)
    for finding in verdict.findings[:1]:
        has_button = finding.action is not None and finding.action.change is not None
        if reason == finding.message and not has_button:
            return f"{finding.remedy} {reason}"
    return reason


def _choose_proof(cause: Cause) -> str:
    """Choose the panel that proves a finding, by its class's name."""
    match cause:
        case Cause.BOARD_SHAPE:
            return "BoardShapePanel"
        case Cause.LENS:
            return "LensModelsPanel"
        case Cause.FEW_VIEWS | Cause.UNDETERMINED:
            return "UncertaintyPanel"
        case Cause.HELD_VALUE:
            return "ResultPanel"
        case (
            Cause.WRONG_FRAME
            | Cause.MISPLACED_CORNERS
            | Cause.FOCUS
            | Cause.MOVING_CENTRE
            | Cause.BENDING_BOARD
            | Cause.ROLLING_SHUTTER
            | Cause.LINE_JITTER
            | Cause.SHEARED_IMAGES
            | Cause.ROLLED_IMAGES
            | Cause.SCALED_IMAGES
            | Cause.MIXED_VIEWS
            | Cause.DISAGREEMENT
            | Cause.BLUR
        ):
            return "ResidualsPanel"
        case _:
            assert_never(cause)
