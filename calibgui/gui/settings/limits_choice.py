"""The choice of what is demanded of a camera: nothing, a preset of limits, or those in a file."""

from __future__ import annotations

from functools import partial

from PySide6.QtWidgets import QFileDialog, QWidget

from calibgui.app.projects.project import set_limits
from calibgui.app.system.limit_presets import find_camera_limits, list_presets
from calibgui.dataset.limits import Limits
from calibgui.engine.errors import CalibrationError
from calibgui.gui.session.session import Session
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.layouts import INDENTED, make_column
from calibgui.gui.widgets.narrow_combo import NarrowCombo
from calibgui.gui.widgets.wrapped_label import WrappedLabel


class LimitsChoice(QWidget):
    """Edits the limits of the project, by which the verdict says PASS or FAIL.

    Args:
        session: whose project it is.
    """

    def __init__(self, session: Session) -> None:
        super().__init__()
        self._session = session
        self.choice = NarrowCombo()
        self.choice.setAccessibleName(self.tr("Limits"))
        self.choice.setToolTip(
            self.tr("What a calibration has to keep, as for a fleet: the verdict stays as it is.")
        )
        self.words = WrappedLabel()
        self.words.setFont(theme.make_font(theme.CAPTION))
        self.words.setForegroundRole(self.words.palette().ColorRole.PlaceholderText)
        make_column(
            self.choice,
            self.words,
            of=self,
            margins=INDENTED,
            spacing=theme.SPACING // 2,
        )
        self.choice.activated.connect(lambda _: self._choose())
        session.changed.connect(lambda *_: self._refresh())
        self._refresh()

    def _refresh(self) -> None:
        limits = self._session.project.limits
        names = [*list_presets()]
        if limits is not None and limits.name not in names:
            names.append(limits.name)
        self.choice.clear()
        self.choice.addItems([self.tr("nothing is demanded"), *names, self.tr("from a file…")])
        self.choice.setCurrentIndex(0 if limits is None else 1 + names.index(limits.name))
        said = [] if limits is None else self._list_demands(limits)
        self.words.setText(
            "\n".join(said)
            or self.tr("With limits the verdict says PASS or FAIL, as for a fleet's cameras.")
        )

    def _choose(self) -> None:
        """Take the limits that are chosen, or say why they cannot be taken."""
        row, known = self.choice.currentIndex(), self._session.project.limits
        name = self.choice.currentText()
        if row == self.choice.count() - 1:
            name = QFileDialog.getOpenFileName(
                self, self.tr("Limits"), "", self.tr("Limits (*.toml)")
            )[0]
        is_same = not name or (known is not None and name == known.name)
        try:
            limits = known if is_same else find_camera_limits(name) if row else None
        except CalibrationError as error:
            self._session.failed.emit(error)
            limits = known
        if limits is not known:
            self._session.edit(self.tr("Limits"), partial(set_limits, limits=limits))
        self._refresh()

    def _list_demands(self, limits: Limits) -> list[str]:
        """List what limits demand."""
        said = []
        if (edge := limits.largest_edge_error_px) is not None:
            said.append(self.tr("error of a pixel at the edge: at most {0:g} px").format(edge))
        if (views := limits.fewest_views) is not None:
            said.append(self.tr("photographs: at least {0:g}").format(views))
        if (share := limits.least_coverage) is not None:
            said.append(self.tr("of the sensor with corners: at least {0:g} %").format(100 * share))
        if (length := limits.length) is not None:
            text = self.tr("lengths of {0:g} mm at {1:g} mm: ± {2:g} mm at most")
            said.append(text.format(length.length_mm, length.distance_mm, length.sigma_mm))
        return said
