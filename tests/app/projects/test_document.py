"""Undo, redo, save and reopen lead back to the same document, whatever was done."""

from __future__ import annotations

import itertools
import json
import os
import tempfile
from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import (
    RuleBasedStateMachine,
    initialize,
    invariant,
    precondition,
    rule,
    run_state_machine_as_test,
)

from calibgui.app.calibrating.settings import MODEL_CHOICES, Settings
from calibgui.app.projects.document import Document
from calibgui.app.projects.project import (
    Project,
    Unit,
    add_images,
    change_views,
    find_free_name,
    record_result,
    remove_result,
    remove_views,
    rename_result,
)
from calibgui.app.projects.project_file import encode_project, read_project, write_project
from calibgui.dataset import DEFAULT_SQUARE, View, ViewStatus
from calibgui.engine.boards.shape import BoardShapeModel, BoardShapePrior
from calibgui.engine.calibration.result import Cost
from tests.app import examples

_FOLDER = Path(tempfile.gettempdir()) / "calibgui images"


@lru_cache
def content(project: Project) -> str:
    """Everything that a project holds, to compare."""
    return json.dumps(encode_project(project, _FOLDER), default=_plain)


def _plain(value: Mapping[str, Any] | np.ndarray) -> Any:
    """What JSON has no word for, quickly: the project file's own writer is tested elsewhere."""
    return dict(value) if isinstance(value, Mapping) else value.tolist()


def answered(text: str, image: str) -> str:
    """That content once the search of `image`, if it waits, has found nothing."""
    record = json.loads(text)
    for view in record["views"]:
        if view["image"] == os.path.relpath(image, _FOLDER) and view["status"] == "waiting":
            view["status"], view["reason"] = "no-board", "No checkerboard was found."
    return json.dumps(record)


class Editing(RuleBasedStateMachine):
    """A document beside the plainest history there is: a list of contents and an index."""

    @initialize()
    def begin(self) -> None:
        self.document = Document()
        self.past = [content(self.document.project)]
        self.labels = [""]
        self.at = 0
        self.count = itertools.count()

    def edit(self, label: str, change, sliding: bool = False) -> None:
        before = self.document.project
        continues = (
            sliding
            and self.sliding_label == label
            and self.labels[self.at] == label
            and not self.document.saved
        )
        self.document.edit(label, change, sliding=sliding)
        if self.document.project is before:
            return
        keep = self.at if continues else self.at + 1
        self.past = [*self.past[:keep], content(self.document.project)]
        self.labels = [*self.labels[:keep], label]
        self.at = keep
        self.sliding_label = label if sliding else ""

    sliding_label = ""

    @rule(count=st.integers(1, 3))
    def add_images(self, count: int) -> None:
        names = [str(_FOLDER / f"new {next(self.count)}.png") for _ in range(count)]
        self.edit("Add images", lambda p: add_images(p, names))

    @rule()
    def add_found_views(self) -> None:
        have = {view.image for view in self.document.project.views}
        new = tuple(v for v in examples.views(_FOLDER) if v.image not in have)
        if new:
            self.edit("Add views", lambda p: replace(p, views=p.views + new, size=(200, 150)))

    @precondition(lambda self: self.document.project.views)
    @rule(data=st.data())
    def remove_images(self, data: st.DataObject) -> None:
        view = data.draw(st.sampled_from(self.document.project.views), label="removed")
        self.edit("Remove images", lambda p: remove_views(p, [view.image]))

    @precondition(lambda self: self.document.project.views)
    @rule(data=st.data())
    def exclude(self, data: st.DataObject) -> None:
        view = data.draw(st.sampled_from(self.document.project.views), label="toggled")
        self.edit(
            "Exclude",
            lambda p: change_views(p, [view.image], lambda v: replace(v, enabled=not v.enabled)),
        )

    @rule(square=st.floats(1.0, 100.0), unit=st.sampled_from(Unit))
    def slide_square(self, square: float, unit: Unit) -> None:
        self.edit("Square", lambda p: replace(p, square=square, unit=unit), sliding=True)

    @rule(grid_size=st.none() | st.tuples(st.integers(3, 20), st.integers(3, 20)))
    def state_board(self, grid_size: tuple[int, int] | None) -> None:
        self.edit("Board", lambda p: replace(p, grid_size=grid_size))

    @rule(
        cost=st.sampled_from(Cost),
        model=st.sampled_from([None, *MODEL_CHOICES]),
        fixed=st.dictionaries(st.sampled_from(["fx", "cx", "cy"]), st.none() | st.floats(-1, 1)),
        board_shape=st.none() | st.sampled_from(BoardShapeModel),
        prior=st.none() | st.builds(BoardShapePrior, st.floats(0.01, 1.0), st.floats(0.01, 1.0)),
        flags=st.tuples(*[st.booleans()] * 3),
    )
    def change_settings(
        self,
        cost: Cost,
        model: str | None,
        fixed: dict[str, float | None],
        board_shape: BoardShapeModel | None,
        prior: BoardShapePrior | None,
        flags: tuple[bool, bool, bool],
    ) -> None:
        robust, weigh_views, once = flags
        settings = Settings(
            cost=cost,
            model=model,
            fixed=fixed,
            board_shape=board_shape,
            prior=prior,
            robust=robust,
            weigh_views=weigh_views,
            once=once,
        )
        self.edit("Settings", lambda p: replace(p, settings=settings))

    @rule(which=st.sampled_from(["Calibration 1", "k3 held"]))
    def calibrate(self, which: str) -> None:
        result = examples.calibrated(_FOLDER).results[which]
        self.edit(
            "Calibrate",
            lambda p: record_result(p, find_free_name(p, "Calibration"), result.views, result),
        )

    @precondition(lambda self: self.document.project.results)
    @rule(data=st.data(), delete=st.booleans())
    def delete_or_rename_result(self, data: st.DataObject, delete: bool) -> None:
        name = data.draw(st.sampled_from(list(self.document.project.results)), label="result")
        if delete:
            self.edit("Delete", lambda p: remove_result(p, name))
        else:
            new = f"renamed {next(self.count)}"
            self.edit("Rename", lambda p: rename_result(p, name, new))

    @precondition(
        lambda self: any(v.status is ViewStatus.WAITING for v in self.document.project.views)
    )
    @rule()
    def learn(self) -> None:
        """A finding reaches every snapshot."""
        asked = next(v for v in self.document.project.views if v.status is ViewStatus.WAITING)

        def answer(view: View) -> View:
            return replace(view, status=ViewStatus.NO_BOARD, reason="No checkerboard was found.")

        def learnt(project: Project) -> Project:
            waits = [v.image for v in project.views if v.status is ViewStatus.WAITING]
            return change_views(project, [asked.image], answer) if asked.image in waits else project

        self.document.learn(learnt)
        self.past = [answered(text, asked.image) for text in self.past]

    @rule()
    def undo(self) -> None:
        self.document.undo()
        if self.at:
            self.at, self.sliding_label = self.at - 1, ""

    @rule()
    def redo(self) -> None:
        self.document.redo()
        if self.at + 1 < len(self.past):
            self.at, self.sliding_label = self.at + 1, ""

    @rule()
    def save_and_reopen(self) -> None:
        """The reopened document begins a new history with the same content."""
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "project.json"
            write_project(self.document.project, path)
            reopened = read_project(path)
            self.document.mark_saved(self.document.project, path)
        assert self.document.saved
        assert content(reopened) == content(self.document.project)
        # What is shared between views and results is one object again.
        for name, result in self.document.project.results.items():
            assert reopened.is_current(reopened.results[name]) == (
                self.document.project.is_current(result)
            )

    @invariant()
    def shows_what_the_plain_history_shows(self) -> None:
        assert content(self.document.project) == self.past[self.at]
        assert self.document.undo_label == self.labels[self.at]


def test_any_sequence_of_edits_can_be_undone_redone_saved_and_reopened() -> None:
    run_state_machine_as_test(Editing, settings=settings(max_examples=30, stateful_step_count=30))


def slide_square(document: Document, millimetres: float) -> None:
    """Change the side of the squares as a slider does that is being dragged."""
    document.edit("Square", lambda p: replace(p, square=millimetres), sliding=True)


def test_a_slider_that_goes_on_after_saving_leaves_the_saved_state_a_step() -> None:
    document = Document()
    slide_square(document, 31.0)
    slide_square(document, 32.0)
    assert not document.saved
    saved = document.project
    document.mark_saved(saved, _FOLDER / "project.json")
    assert document.saved
    slide_square(document, 33.0)
    assert not document.saved
    slide_square(document, 34.0)
    document.undo()
    assert document.project is saved
    assert document.saved, "the file holds what undo shows"
    document.undo()
    assert document.project.square == DEFAULT_SQUARE, "what was slid before is one step"
    assert not document.saved
    document.redo()
    assert document.saved


def test_an_edit_that_changes_nothing_leaves_the_document_saved() -> None:
    document = Document()
    document.edit("Nothing", lambda p: p)
    assert document.saved
    assert document.undo_label == ""


def test_saving_an_older_state_leaves_the_newer_one_unsaved() -> None:
    document = Document()
    slide_square(document, 31.0)
    older = document.project
    document.end_sliding_edit()
    slide_square(document, 32.0)
    document.mark_saved(older, _FOLDER / "project.json")
    assert not document.saved
    document.undo()
    assert document.saved
