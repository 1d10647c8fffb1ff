"""Poses of views in other frames move as their covariances say."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.geometry.rotations import rotation_from_vector, vector_from_rotation
from calibgui.engine.rig.consensus import Relation, ViewPoses

RELATION = Relation(rotation_from_vector(np.array([0.3, -0.8, 0.5])), np.array([30.0, -20.0, 15.0]))
CHANGES: dict[str, Callable[[ViewPoses], ViewPoses]] = {
    "express_on": lambda poses: poses.express_on(RELATION),
    "see_from": lambda poses: poses.see_from(RELATION),
    "invert": ViewPoses.invert,
}


def make_poses() -> ViewPoses:
    rng = np.random.default_rng(0)
    roots = rng.normal(0, 1, (3, 6, 6))
    return ViewPoses(
        rotation_from_vector(rng.normal(0, 0.8, (3, 3))),
        rng.normal(0, 100, (3, 3)),
        roots @ np.swapaxes(roots, 1, 2),
        np.arange(3),
    )


def move(poses: ViewPoses, step: Array) -> ViewPoses:
    """The poses after a local (w, tau)."""
    return replace(poses, R=rotation_from_vector(step[:3]) @ poses.R, T=poses.T + step[3:])


@pytest.mark.parametrize("name", CHANGES)
def test_covariances_are_those_of_central_differences(name: str) -> None:
    poses, change = make_poses(), CHANGES[name]
    there, columns = change(poses), []
    for i in range(6):
        step = 1e-6 * np.eye(6)[i]
        after, before = change(move(poses, step)), change(move(poses, -step))
        w = vector_from_rotation(after.R @ np.swapaxes(before.R, 1, 2))
        columns.append(np.concatenate([w, after.T - before.T], axis=1) / 2e-6)
    J = np.stack(columns, axis=2)
    wanted = J @ poses.covariance @ np.swapaxes(J, 1, 2)
    np.testing.assert_allclose(there.covariance, wanted, rtol=1e-5, atol=1e-4)
    if name == "express_on":
        np.testing.assert_allclose(poses.carry_to(RELATION), J, atol=1e-5)


def test_frames_lead_back() -> None:
    poses = make_poses()
    back = poses.invert().invert()
    np.testing.assert_allclose(back.covariance, poses.covariance, atol=1e-9)
    again = poses.see_from(RELATION).see_from(RELATION.invert())
    np.testing.assert_allclose(again.T, poses.T, atol=1e-10)
    point = np.array([1.0, 2.0, 3.0])  # of the body, seen by the camera both ways
    there = poses.express_on(RELATION)
    on_board = RELATION.R @ point + RELATION.T
    np.testing.assert_allclose(there.R @ point + there.T, poses.R @ on_board + poses.T)
