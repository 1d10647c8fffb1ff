"""The history of a project: a tuple of snapshots, of which one is shown.

An edit is a function from project to project with a name that the user reads in the menu;
undo and redo move an index. Findings of the program itself (corners in an image) are no edits:
they are added to all snapshots that lack them, so that undo never loses them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

from calibgui.app.calibrating.settings import BEST_SETTINGS
from calibgui.app.projects.project import Project

Change = Callable[[Project], Project]
Listener = Callable[[Project, Project], None]
"""Function that is called with the project before and after a change."""


@dataclass(frozen=True, eq=False, slots=True)
class Step:
    """A snapshot, and the edit that made it."""

    label: str
    project: Project
    sliding: bool = False
    """True if an edit of the same name may replace it."""


class Document:
    """A project, its past and its undone future.

    Args:
        project: the first snapshot; an empty project if None.
        path: its file; None if it has none yet.
        saved: true if the file holds it.
    """

    def __init__(
        self, project: Project | None = None, path: Path | None = None, *, saved: bool = True
    ) -> None:
        project = project or Project(settings=BEST_SETTINGS)
        self.path = path
        self.listeners: list[Listener] = []
        self._steps: tuple[Step, ...] = (Step("", project),)
        self._index = 0
        self._saved = project if saved else None

    @property
    def project(self) -> Project:
        """The snapshot that is shown."""
        return self._steps[self._index].project

    @property
    def edits(self) -> int:
        """Number of edits that lead to the shown snapshot."""
        return self._index

    @property
    def saved(self) -> bool:
        """True if the file holds the shown snapshot."""
        return self.project is self._saved

    @property
    def undo_label(self) -> str:
        """Name of the edit that `undo` takes back; empty if there is none."""
        return self._steps[self._index].label

    @property
    def redo_label(self) -> str:
        """Name of the edit that `redo` repeats; empty if there is none."""
        return self._steps[self._index + 1].label if self._index + 1 < len(self._steps) else ""

    def edit(self, label: str, change: Change, *, sliding: bool = False) -> None:
        """Apply `change`; it becomes one step of the history.

        Args:
            label: the edit's name for the user; not empty.
            change: function from the present project to the next; the same project makes no step.
            sliding: true if following edits of the same name, such as those of a slider that is
                being dragged, continue this step.
        """
        before = self.project
        after = change(before)
        if after is before:
            return
        last = self._steps[self._index]
        continues = sliding and last.sliding and last.label == label and not self.saved
        keep = self._index if continues else self._index + 1
        self._steps = (*self._steps[:keep], Step(label, after, sliding))
        self._index = keep
        self._announce(before)

    def end_sliding_edit(self) -> None:
        """End a sliding edit: the next edit of the same name makes a new step."""
        self._replace_all(lambda step: replace(step, sliding=False))

    def learn(self, change: Change) -> None:
        """Add a finding to all snapshots; `change` returns snapshots that it does not concern."""
        before = self.project
        self._replace_all(lambda step: replace(step, project=change(step.project)))
        if self.project is not before:
            self._announce(before)

    def undo(self) -> None:
        """Show the snapshot before the last edit."""
        self._move(max(self._index - 1, 0))

    def redo(self) -> None:
        """Show the snapshot after the edit that was undone last."""
        self._move(min(self._index + 1, len(self._steps) - 1))

    def mark_saved(self, project: Project, path: Path) -> None:
        """Remember that `path` holds `project`."""
        self.path = path
        self._saved = project
        self._announce(self.project)

    def _move(self, index: int) -> None:
        before = self.project
        if index != self._index:
            self.end_sliding_edit()  # a slider that goes on later does not continue what was left
        self._index = index
        if self.project is not before:
            self._announce(before)

    def _replace_all(self, change: Callable[[Step], Step]) -> None:
        self._steps = tuple(change(step) for step in self._steps)

    def _announce(self, before: Project) -> None:
        for listener in self.listeners:
            listener(before, self.project)
