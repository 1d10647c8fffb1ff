"""The record that is kept and exported."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from calibgui.dataset import Result
from calibgui.engine.geometry import frames


def test_poses_belong_to_the_usable_views(result: Result) -> None:
    names = [view.image for view in result.views]
    assert [view.image for view in result.used] == [names[i] for i in (1, 2, 3, 5, 6)]
    with pytest.raises(ValueError, match="5 poses do not answer 4 usable views"):
        replace(result, views=result.views[2:])


def test_the_papers_poses_are_the_poses(result: Result) -> None:
    """Back from eq. 6 and 21, about the board's centre."""
    centre = np.array([7 * 30.0, 5 * 30.0]) / 2
    for pose, paper in zip(result.calibration.poses, result.paper_poses(), strict=True):
        back = frames.pose_from_paper(paper, centre)
        assert np.allclose(back.rvec, pose.rvec, rtol=0, atol=1e-12)
        assert np.allclose(back.tvec, pose.tvec, rtol=0, atol=1e-9)
        # eq. 30: at L + f a square of 30 mm is 30 reference px wide.
        assert paper.distance == pytest.approx(result.calibration.camera.focal[0], rel=1e-6)
