"""Words about a camera that may have changed."""

from __future__ import annotations

from types import SimpleNamespace
from typing import cast

from calibgui.engine.assessment import Drift
from calibgui.report.series import describe_drift


def test_large_changes_and_small_probabilities_are_told_plainly() -> None:
    for probability, told in ((0.0, "less than 0.0001."), (0.02, "0.02.")):
        drift = SimpleNamespace(
            difference=SimpleNamespace(rms=66.7, worst=219.4),
            has_changed=True,
            probability=probability,
            expected=1.0,
        )
        text = describe_drift(cast(Drift, drift), None)
        assert "by 67 px rms, 220 px at most" in text
        assert text.endswith(f"with a probability of {told}")
