"""The theme gives colours, spacing and fonts, light or dark as the system is.

The colours of the first eight views are Okabe and Ito's, which people with any common kind of
colour blindness tell apart; later views have other hues, and another symbol every eight views.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from typing import assert_never

from PySide6.QtCore import QObject, Qt, Signal
from PySide6.QtGui import QColor, QFont, QFontDatabase, QFontInfo, QGuiApplication, QPalette, QPen
from PySide6.QtWidgets import QApplication, QWidget

from calibgui.gui.widgets.kept_settings import keep, read_kept_text

SPACING = 8
"""Between widgets, and around a panel's content, device-independent px: twice the grid's step."""
MARGIN = 16
"""Around what fills a part of the window, device-independent px."""
TEXT, CAPTION, FIGURE, HEADLINE = 13, 11, 17, 19
"""Sizes of letters: text, what is secondary, numbers on a picture, and the verdict, px."""
CONTROL = 32
"""Height of a button in a bar, device-independent px."""
RADIUS, SMALL_RADIUS = 8, 6
"""Radii of the corners of cards and of controls, device-independent px."""
ERROR_STOPS = ("#16335b", "#1d5f86", "#2f9c95", "#9fc75f", "#f4e04d")
"""Colours of errors on the sensor, from the least to the largest."""

_OKABE_ITO = (
    "#0072B2",
    "#E69F00",
    "#009E73",
    "#D55E00",
    "#CC79A7",
    "#56B4E9",
    "#B8A800",
    "#888888",
)
_GOLDEN_ANGLE = 0.381966
"""Share of a turn: hues that are this far apart never come close to those shortly before."""
_DISTINCT = 64
"""Number of views after which colours come again: more cannot be told apart."""
_DARKENED = 140
"""The percentage by which Fusion divides the lightness of the window for borders."""
_BORDERED = ("QCheckBox", "QRadioButton", "QMenu", "QTreeView", "QLineEdit", "QAbstractSpinBox")
"""Kinds of widgets whose border alone shows where they are."""
_SYMBOLS = ("o", "s", "t1", "d", "+", "x", "star")


class Scheme(StrEnum):
    """The colours that the user asks for."""

    SYSTEM = "system"
    LIGHT = "light"
    DARK = "dark"


@dataclass(frozen=True, slots=True)
class Theme:
    """The colours of one scheme, as #rrggbb."""

    window: str
    """Behind controls."""
    button: str
    """Of buttons, boxes' arrows and the handles of sliders."""
    base: str
    """Behind lists, tables and plots."""
    canvas: str
    """Around an image."""
    text: str
    muted: str
    """Text of secondary importance."""
    line: str
    """Borders, axes and grids."""
    border: str
    """Borders of check boxes, fields and menus: they alone show an empty one."""
    accent: str
    """Selection and the main action."""
    on_accent: str
    chosen: str
    """Behind the chosen row of a table or list."""
    bar: str
    """Of what is compared by its length."""
    good: str
    warning: str
    bad: str
    warning_base: str
    """Behind a banner that warns."""
    bad_base: str
    """Behind a banner that reports a failure, and outlying rows of a table."""


LIGHT = Theme(
    window="#f4f5f7",
    button="#ffffff",
    base="#ffffff",
    canvas="#22262e",
    text="#1c2026",
    muted="#5b6470",
    line="#c3c9d1",
    border="#6f7884",
    accent="#0b5cad",
    on_accent="#ffffff",
    chosen="#dbe7f5",
    bar="#4a8fd3",
    good="#17804d",
    warning="#8a5a00",
    bad="#b3400a",
    warning_base="#fff3d6",
    bad_base="#fde5da",
)
DARK = Theme(
    window="#2d323a",
    button="#3b424d",
    base="#191c21",
    canvas="#22262e",
    text="#e7eaee",
    muted="#a2abb7",
    line="#525a66",
    border="#8a94a2",
    accent="#4aa3df",
    on_accent="#0b1117",
    chosen="#263d55",
    bar="#3f83c4",
    good="#35c79a",
    warning="#f0b429",
    bad="#f38b57",
    warning_base="#3d3215",
    bad_base="#452a1e",
)

# Marks on images: the paper's colours, drawn over a dark halo so that they show on any grey.
ESTIMATE = QColor("#ff3b30")
REFINED = QColor("#ffe600")
REGION = QColor("#ffe600")
REPROJECTED = QColor("#56b4e9")
RESIDUAL = QColor("#ff8c1a")
PATH = QColor("#00d39b")
MUTED_MARK = QColor("#ffffff")
HALO = QColor(0, 0, 0, 150)


class _Shown(QObject):
    changed = Signal()
    theme: Theme = LIGHT


_shown = _Shown()
"""The theme that `apply` has shown last. What is painted asks for it all the time, and would wait
for the interpreter at each question to Qt while another thread computes."""


def current() -> Theme:
    """The theme that the application shows."""
    return _shown.theme


def chosen() -> Scheme:
    """The scheme that the user chose, now or in an earlier session."""
    try:
        return Scheme(read_kept_text("scheme") or Scheme.SYSTEM)
    except ValueError:
        return Scheme.SYSTEM


def choose(scheme: Scheme) -> None:
    """Show `scheme`, and remember it."""
    keep("scheme", str(scheme))
    app = QApplication.instance()
    if isinstance(app, QApplication):
        apply(app, scheme)


def apply(app: QApplication, scheme: Scheme) -> None:
    """Give the application the look of `scheme`."""
    match scheme:
        case Scheme.SYSTEM:
            dark = app.styleHints().colorScheme() is Qt.ColorScheme.Dark
        case Scheme.LIGHT | Scheme.DARK:
            dark = scheme is Scheme.DARK
        case _:
            assert_never(scheme)
    theme = _shown.theme = DARK if dark else LIGHT
    if app.style().objectName() != "fusion":
        app.setStyle("Fusion")
    app.setFont(make_font())
    palette = _palette(theme)
    app.setPalette(palette)
    # Fusion makes their borders by darkening what it takes for the window's colour.
    palette.setColor(QPalette.ColorRole.Window, QColor(theme.border).lighter(_DARKENED))
    for kind in _BORDERED:
        app.setPalette(palette, kind)  # type: ignore[arg-type]  # stated as bytes, taken as a name
    palette.setColor(QPalette.ColorRole.Highlight, QColor(theme.chosen))
    palette.setColor(QPalette.ColorRole.HighlightedText, QColor(theme.text))
    app.setPalette(palette, "QTreeView")  # type: ignore[arg-type]
    rows = _palette(theme)
    rows.setColor(QPalette.ColorRole.Highlight, QColor(theme.chosen))
    rows.setColor(QPalette.ColorRole.HighlightedText, QColor(theme.text))
    for role in (QPalette.ColorRole.Window, QPalette.ColorRole.Button):  # behind headings
        rows.setColor(role, QColor(theme.base))
    app.setPalette(rows, "QAbstractItemView")  # type: ignore[arg-type]
    _shown.changed.emit()


def follow(restyle: Callable[[], object]) -> None:
    """Call a widget's method whenever the colours have changed, for as long as there is the widget.

    Raises:
        TypeError: if it is no method of a widget, whose end would not be known.
    """
    if not isinstance(getattr(restyle, "__self__", None), QObject):
        raise TypeError("only a widget's method ends with the widget")
    _shown.changed.connect(restyle)


def follow_system(app: QApplication) -> None:
    """Repeat `apply` whenever the system turns dark or light."""
    app.styleHints().colorSchemeChanged.connect(lambda: apply(app, chosen()))


def view_colour(view: int) -> QColor:
    """Return the colour of a view everywhere: in the film strip, on the image and in every plot.

    Args:
        view: index of the view in the project, so that leaving another one out changes nothing.
    """
    k = view % _DISTINCT
    if k < len(_OKABE_ITO):
        return QColor(_OKABE_ITO[k])
    turn = (k * _GOLDEN_ANGLE) % 1.0
    # Two saturations by three lightnesses, none too pale for white nor too deep for black.
    return QColor.fromHslF(turn, (0.75, 0.45)[k % 2], (0.38, 0.48, 0.60)[k % 3])


def view_symbol(view: int) -> str:
    """Return the pyqtgraph symbol of a view's marks: another one every eight views."""
    return _SYMBOLS[view // len(_OKABE_ITO) % len(_SYMBOLS)]


def make_pen(
    colour: QColor | str, width: float = 1.0, style: Qt.PenStyle = Qt.PenStyle.SolidLine
) -> QPen:
    """Return a pen for lines of plots, which are as wide at any zoom.

    Qt counts the width of such a pen in pixels of the screen, however small they are: of the
    finest one, if there are several.

    Args:
        colour: of the line.
        width: of the line, device-independent px.
        style: of the line.
    """
    ratios = [screen.devicePixelRatio() for screen in QGuiApplication.screens()]
    pen = QPen(QColor(colour), width * max(ratios, default=1.0), style)
    pen.setCosmetic(True)
    return pen


def set_text_colour(label: QWidget, colour: str) -> None:
    """Give the text of a widget a colour, which is quicker than by a style sheet."""
    palette = label.palette()
    if palette.color(label.foregroundRole()) != QColor(colour):
        palette.setColor(label.foregroundRole(), QColor(colour))
        label.setPalette(palette)


def make_font(size: int = TEXT, *, bold: bool = False) -> QFont:
    """Return the window's font in a size, px; whoever has asked the system for larger letters gets
    them larger in proportion."""
    font = QFontDatabase.systemFont(QFontDatabase.SystemFont.GeneralFont)
    usual = QFontInfo(font).pixelSize()
    font.setPixelSize(round(size * max(usual / TEXT, 1.0)))
    font.setBold(bold)
    return font


def fixed_font() -> QFont:
    """A font whose digits align."""
    return QFontDatabase.systemFont(QFontDatabase.SystemFont.FixedFont)


def make_dark_palette() -> QPalette:
    """Return the palette of what stands beside a photograph, which is dark in either scheme."""
    palette = _palette(DARK)
    palette.setColor(QPalette.ColorRole.Window, QColor(LIGHT.canvas))
    palette.setColor(QPalette.ColorRole.Button, QColor(LIGHT.canvas))
    return palette


def _palette(theme: Theme) -> QPalette:
    role = QPalette.ColorRole
    colours = {
        role.Window: theme.window,
        role.WindowText: theme.text,
        role.Base: theme.base,
        role.AlternateBase: theme.window,
        role.ToolTipBase: theme.base,
        role.ToolTipText: theme.text,
        role.PlaceholderText: theme.muted,
        role.Text: theme.text,
        role.Button: theme.button,
        role.ButtonText: theme.text,
        role.BrightText: theme.bad,
        role.Link: theme.accent,
        role.LinkVisited: theme.accent,
        role.Highlight: theme.accent,
        role.HighlightedText: theme.on_accent,
        role.Mid: theme.line,
        role.Midlight: theme.window,
        role.Light: theme.base,
        role.Dark: theme.line,
        role.Shadow: theme.line,
        role.Accent: theme.accent,
    }
    palette = QPalette()
    for name, colour in colours.items():
        palette.setColor(name, QColor(colour))
    faded = QColor(theme.muted)
    faded.setAlpha(140)
    for name in (role.WindowText, role.Text, role.ButtonText):
        palette.setColor(QPalette.ColorGroup.Disabled, name, faded)
    palette.setColor(QPalette.ColorGroup.Disabled, role.Highlight, QColor(theme.line))
    return palette
