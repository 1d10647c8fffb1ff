"""The set-up: the board, the lens, limits, and what is for experts, each to be folded."""

from __future__ import annotations

from PySide6.QtWidgets import QWidget

from calibgui.gui.settings.board_panel import BoardPanel
from calibgui.gui.settings.limits_choice import LimitsChoice
from calibgui.gui.settings.settings_panel import SettingsPanel
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.buttons import Button, Kind
from calibgui.gui.widgets.layouts import make_column
from calibgui.gui.widgets.scrolling import make_scrollable
from calibgui.gui.widgets.sheet import Sheet

_WIDTH = 480
"""Device-independent px."""


class SetupSheet(Sheet):
    """Lies over the right of the desk.

    Args:
        desk: that it lies over.
        board, settings, limits: what is set up.
    """

    def __init__(
        self, desk: QWidget, board: BoardPanel, settings: SettingsPanel, limits: LimitsChoice
    ) -> None:
        super().__init__(desk, _WIDTH, fills=True)
        parts: list[QWidget] = []
        self.folds: list[Button] = []
        for title, tip, part, is_open in (
            (self.tr("Board"), self.tr("What is photographed"), board, True),
            (self.tr("Lens"), self.tr("Which model describes the lens"), settings.lens, True),
            (self.tr("Limits"), self.tr("What is demanded of the camera"), limits, True),
            (self.tr("For experts"), self.tr("How to calibrate"), settings.experts, False),
        ):
            self.folds.append(_make_fold(title, tip, part, is_open))
            parts += [self.folds[-1], part]
        inside, around = QWidget(), (theme.MARGIN, theme.SPACING, theme.MARGIN, theme.MARGIN)
        make_column(*parts, None, of=inside, spacing=theme.SPACING // 2, margins=around)
        labels = board.pattern.label, board.counted, *settings.labels
        width = max(max(each.minimumWidth(), each.sizeHint().width()) for each in labels)
        for each in labels:  # the fields of all parts begin alike
            each.setMinimumWidth(width)
        make_column(make_scrollable(inside), of=self, margins=(1, 0, 0, 0))


def _make_fold(title: str, tip: str, part: QWidget, is_open: bool) -> Button:
    """Return the heading of a part, which shows and hides it."""
    fold = Button(kind=Kind.LINK)
    fold.setToolTip(tip)
    fold.setAccessibleName(title)
    fold.setFont(theme.make_font(bold=True))
    fold.setCheckable(True)

    def show(is_open: bool) -> None:
        fold.setText(f"{'▾▸'[not is_open]}  {title}")
        part.setVisible(is_open)

    fold.setChecked(is_open)
    show(is_open)
    fold.toggled.connect(show)
    return fold
