"""A menu bar made from records: each entry is data, and nothing here knows what it does."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from PySide6.QtCore import QObject
from PySide6.QtGui import QAction, QActionGroup, QKeySequence
from PySide6.QtWidgets import QMenu, QMenuBar

from calibgui.gui.widgets.actions import enable_action, make_action


@dataclass(frozen=True, slots=True, kw_only=True)
class Command:
    """An entry that runs something when it is chosen."""

    text: str
    """Its name, with & before the letter that chooses it."""
    tip: str
    """A phrase on what it is good for."""
    run: Callable[[], object]
    """The function that does it."""
    shortcut: str | QKeySequence.StandardKey | None = None
    """The keys that run it from anywhere in the window."""
    is_enabled: Callable[[], bool] = lambda: True
    """True if it can be chosen now; asked at every `Menus.refresh`."""
    why_disabled: str = ""
    """A sentence on why it cannot be chosen while it cannot, and what to do about that."""
    get_subject: Callable[[], str] = lambda: ""
    """Name of what it would act on now, shown behind its text; asked at every `Menus.refresh`."""
    is_chosen: bool | None = None
    """True or False for a command that excludes others: whether it is the chosen one."""


@dataclass(frozen=True, slots=True)
class Menu:
    """A menu, or a menu in a menu."""

    title: str
    """Its name, with & before the letter that opens it."""
    entries: Sequence[Entry] | Callable[[], Sequence[Command]]
    """Its lines; a function is asked anew whenever the menu opens."""


Entry = Command | Menu | QAction | None
"""One line of a menu; an action that another part of the window owns is taken as it is, and None
is a line that separates."""


class Menus(QObject):
    """Fills a menu bar from records and keeps their state up to date.

    Args:
        bar: the empty menu bar.
        menus: what stands in it.
    """

    def __init__(self, bar: QMenuBar, menus: Sequence[Menu]) -> None:
        super().__init__(bar)
        self._bar = bar
        self._changeable: list[tuple[Command, QAction]] = []
        self._lists: list[Callable[[], None]] = []
        """Functions that fill the menus whose entries are asked for when they open."""
        for menu in menus:
            self._fill(bar.addMenu(menu.title), menu)
        self.refresh()

    def refresh(self) -> None:
        """Show which commands can be chosen now, and what they would act on."""
        for command, action in self._changeable:
            _show_state(command, action)

    def list_actions(self) -> list[tuple[str, QAction]]:
        """Return every action with the titles of its menus, in the menus' order, as it is now."""
        for fill in self._lists:
            fill()
        self.refresh()
        return [
            (path, action)
            for entry in self._bar.actions()
            if isinstance(menu := entry.menu(), QMenu)
            for path, action in _walk(menu, "")
        ]

    def _fill(self, widget: QMenu, menu: Menu) -> None:
        if callable(menu.entries):
            list_commands = menu.entries
            self._lists.append(lambda: _refill(widget, list_commands()))
            widget.aboutToShow.connect(self._lists[-1])
            return
        widget.setToolTipsVisible(True)
        widget.aboutToShow.connect(self.refresh)
        group = QActionGroup(widget)
        for entry in menu.entries:
            match entry:
                case None:
                    widget.addSeparator()
                case Menu():
                    self._fill(widget.addMenu(entry.title), entry)
                case Command():
                    action = _add_command(widget, entry)
                    self._changeable.append((entry, action))
                    if entry.is_chosen is not None:
                        group.addAction(action)
                case _:
                    widget.addAction(entry)


def _refill(widget: QMenu, commands: Sequence[Command]) -> None:
    """Show other commands than before in a menu that is about to open."""
    widget.clear()
    for command in commands:
        _show_state(command, _add_command(widget, command))


def _walk(menu: QMenu, above: str) -> Iterator[tuple[str, QAction]]:
    """Yield the actions of a menu and of the menus in it, with the titles on the way to each."""
    path = f"{above} › {strip_mnemonic(menu.title())}" if above else strip_mnemonic(menu.title())
    for action in menu.actions():
        if isinstance(below := action.menu(), QMenu):
            yield from _walk(below, path)
        elif not action.isSeparator():
            yield path, action


def strip_mnemonic(text: str) -> str:
    """Return the text of an action or a menu without the mark of its letter."""
    return text.replace("&&", "\0").replace("&", "").replace("\0", "&")


def _add_command(widget: QMenu, command: Command) -> QAction:
    action = make_action(widget, command.text, command.shortcut, command.tip, command.run)
    if command.is_chosen is not None:
        action.setCheckable(True)
        action.setChecked(command.is_chosen)
    widget.addAction(action)
    return action


def _show_state(command: Command, action: QAction) -> None:
    subject = command.get_subject()
    action.setText(f"{command.text} “{subject}”" if subject else command.text)
    enable_action(action, command.is_enabled(), command.why_disabled)
