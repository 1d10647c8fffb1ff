"""The verdict on a result, which is found out once for all who ask."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from threading import Lock

from calibgui.dataset.result import Result
from calibgui.engine.assessment import Verdict, judge_calibration

_lock = Lock()
_judged: deque[tuple[Result, Verdict]] = deque(maxlen=8)
"""The results that were judged last, with their verdicts."""


def judge_result(result: Result, check: Callable[[], None] | None = None) -> Verdict:
    """Return the verdict on a result; trying what would make it better may take some seconds.

    Args:
        result: any result.
        check: a function that is called now and then, and raises to abandon the work.
    """
    with _lock:
        for known, verdict in _judged:
            if known.calibration is result.calibration and known.views is result.views:
                return verdict
        names = [view.name for view in result.used]
        verdict = judge_calibration(result.calibration, result.observations(), names, check)
        _judged.append((result, verdict))
        return verdict
