"""The parts of the window that panels use."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from calibgui.engine.images import Image
from calibgui.gui.jobs.jobs import Jobs


@dataclass(frozen=True, slots=True)
class Services:
    """The parts of the window that a panel may use; its constructor takes what it needs.

    A panel asks for everything else by the signals of `Panel`.
    """

    jobs: Jobs
    """Runs work beside the main thread."""
    read_image: Callable[[str], Image]
    """Reads the image of a path; to be called in a worker.

    Raises:
        CalibrationError: if the image cannot be read.
    """
