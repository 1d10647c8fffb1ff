"""The start of Stage II: what it needs of a lens model comes from the model, not from its name."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.calibration.initialisation.stage_one import register_views
from calibgui.engine.calibration.initialisation.start import (
    check_facing,
    convert_to_paper_frame,
    initialise_stage_two,
)
from calibgui.engine.calibration.observations import (
    REFERENCE_PITCH,
    measure_pitch,
    name_views,
    pack_observations,
)
from calibgui.engine.calibration.problem import resolve_held_parameters
from calibgui.engine.camera.models import MODELS, find_model
from tests.engine.random_lenses import example_scene


@pytest.mark.parametrize(
    ("model", "scene", "fix"),
    [
        ("brown-conrady", "brown-conrady", ()),
        ("eucm", "eucm", ()),
        ("eucm", "pinhole", ()),
        ("double-sphere", "double-sphere", ()),
        ("mei", "mei", ("xi",)),
        ("splined-stereographic-9x9-160", "kannala-brandt", ()),
    ],
)
def test_a_model_starts_alike_by_any_name(
    model: str, scene: str, fix: tuple[str, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Under another name it has no kernels, which round differently."""
    monkeypatch.setitem(MODELS, "new", find_model(model))
    made = example_scene(scene)
    views = pack_observations(made.views)
    scale = REFERENCE_PITCH / measure_pitch(views)
    facing = check_facing(views, name_views(len(made.views)))
    first = register_views(*convert_to_paper_frame(views, scale, made.size, facing))
    starts = [
        initialise_stage_two(
            views, first, made.size, name, resolve_held_parameters(fix, (), name, made.size)
        )
        for name in (model, "new")
    ]
    by_name, by_data = (np.concatenate([start.params, start.T.ravel()]) for start in starts)
    np.testing.assert_allclose(by_data, by_name, rtol=1e-6, atol=1e-6)
