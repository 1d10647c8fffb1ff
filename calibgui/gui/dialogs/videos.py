"""Videos among what is opened in the window: frames of them are taken and added as photographs."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from pathlib import Path

from PySide6.QtCore import QCoreApplication

from calibgui.app.photographs.board_recognition import find_any_board
from calibgui.app.photographs.detection import Detection, find_views
from calibgui.app.photographs.videos import DecodingProgress, take_frames
from calibgui.app.projects.project import Project
from calibgui.engine.arrays import GridSize
from calibgui.engine.boards import CHECKERBOARD, Pattern
from calibgui.gui.jobs.job import Job
from calibgui.gui.session.session import Session

translate = QCoreApplication.translate


def start_taking_frames(
    session: Session, videos: Sequence[Path], add: Callable[[Sequence[Path]], None]
) -> None:
    """Take frames of videos in the background, `add` their files, and say what was taken."""
    project = session.project

    def done(taken: tuple[Sequence[Path], str]) -> None:
        frames, said = taken
        add(frames)
        session.notified.emit(said)

    session.jobs.start(
        translate("Videos", "Decoding {0}").format(videos[0].name),
        lambda job: take_frames(
            videos, partial(_search, project, job), partial(_show_progress, job)
        ),
        done,
    )


def _search(project: Project, job: Job, images: Sequence[Path]) -> Detection:
    """Search frames for the project's board; for any, where no kind is stated."""

    def find(pattern: Pattern, grid_size: GridSize | None) -> Detection:
        job.rename(translate("Videos", "Finding corners"))
        return find_views(
            images,
            grid_size,
            progress=lambda done, total, _: job.advance(done, total),
            stop=job.cancelling,
            method=project.method,
            pattern=pattern,
            field=project.field,
        )

    if project.pattern == CHECKERBOARD:
        return find_any_board(find, project.grid_size)
    return find(project.pattern, project.grid_size)


@contextmanager
def _show_progress(job: Job, what: str, _unit: str) -> Iterator[DecodingProgress]:
    """Give what tells a job of the progress of decoding."""
    job.rename(what[:1].upper() + what[1:])
    yield job.advance
