"""The verdict on a result, which is found out once for all who ask."""

from __future__ import annotations

from collections.abc import Callable
from threading import Lock
from weakref import WeakKeyDictionary

from calibgui.dataset.result import Result
from calibgui.engine.assessment import Verdict, judge_calibration
from calibgui.engine.calibration import Calibration

_lock = Lock()
_verdicts: WeakKeyDictionary[Calibration, Verdict] = WeakKeyDictionary()
"""The verdicts on calibrations that are still there."""


def judge_result(result: Result, check: Callable[[], None] | None = None) -> Verdict:
    """Return the verdict on a result; trying what would make it better may take some seconds.

    Args:
        result: any result.
        check: a function that is called now and then, and raises to abandon the work.

    Raises:
        CalibrationError: if the camera was not estimated, but is known from a file.
    """
    with _lock:
        if (known := recall_verdict(result)) is not None:
            return known
        names = [view.name for view in result.used]
        verdict = judge_calibration(result.calibration, result.observations(), names, check)
        keep_verdict(result, verdict)
        return verdict


def recall_verdict(result: Result) -> Verdict | None:
    """Return the verdict on a result if it is known, None if it is still to be found out."""
    return _verdicts.get(result.calibration)


def keep_verdict(result: Result, verdict: Verdict) -> None:
    """Keep the verdict on a result for all who ask."""
    _verdicts[result.calibration] = verdict
