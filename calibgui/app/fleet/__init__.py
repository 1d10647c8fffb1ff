"""Fleets: many cameras calibrated from a list, each a task of its own, with a ledger of all.

`read_manifest` says which cameras there are, and `run_batch` calibrates those that are not done, on
a scheduler of `open_scheduler`.
"""

from __future__ import annotations

from calibgui.app.fleet.batch import BatchSummary, run_batch
from calibgui.app.fleet.manifest import BoardSought, CameraTask, read_manifest
from calibgui.app.fleet.schedulers import describe_trust, open_scheduler

__all__ = [
    "BatchSummary",
    "BoardSought",
    "CameraTask",
    "describe_trust",
    "open_scheduler",
    "read_manifest",
    "run_batch",
]
