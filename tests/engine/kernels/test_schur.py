"""The compiled Schur complement against the readable one."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.calibration.refinement import schur


def test_the_compiled_roots_are_the_readable_ones() -> None:
    rng = np.random.default_rng(0)
    J = rng.normal(size=(50, 20, 6)) * [1, 1, 1, 1e-3, 1e-3, 1e-3]
    V = np.swapaxes(J, 1, 2) @ J
    before = V.copy()
    truth = schur.invert_roots.reference(V)
    scale = np.abs(truth).max(axis=(1, 2), keepdims=True)
    found = schur.invert_roots.kernel(V)
    np.testing.assert_allclose(found / scale, truth / scale, atol=1e-13)
    np.testing.assert_array_equal(V, before)
    for hopeless in (0.0, -1.0):
        V[30, 5, 5] = hopeless
        for invert in (schur.invert_roots.kernel, schur.invert_roots.reference):
            with pytest.raises(np.linalg.LinAlgError):
                invert(V)
    V[30, 5, 5] = np.nan  # which is told further on
    assert np.isnan(schur.invert_roots.kernel(V)[30, 5, 5])


def test_the_compiled_complement_is_the_readable_one() -> None:
    rng = np.random.default_rng(0)
    for share in (0.0, 0.05, 0.3, 1.0):
        W = rng.normal(size=(20, 150, 6)) * (rng.random((20, 150, 1)) < share)
        W[3, 40:60] = rng.normal(size=(20, 6))
        root = rng.normal(size=(150, 150))
        U, roots = root @ root.T, np.tril(rng.normal(size=(20, 6, 6)))
        before = U.copy()
        truth = U - sum((w @ L.T @ L @ w.T for w, L in zip(W, roots, strict=True)), np.zeros(()))
        for subtract in (schur.subtract_squares.kernel, schur.subtract_squares.reference):
            np.testing.assert_allclose(subtract(U, W, roots), truth, atol=1e-11)
        np.testing.assert_array_equal(U, before)


def test_a_kernel_takes_only_what_is_small_or_mostly_zero() -> None:
    W = np.ones((5, 200, 6))
    U = np.eye(200)
    assert not schur._touches_few_parameters(U, W, np.zeros(0))
    W[:, 50:] = 0
    assert schur._touches_few_parameters(U, W, np.zeros(0))
    assert not schur._touches_few_parameters(U[:60, :60], W[:, :60], np.zeros(0))
    assert schur._touches_few_parameters(U[:9, :9], W[:, :9], np.zeros(0))
