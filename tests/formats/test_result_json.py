"""result.json: complete, exact, described by its schema, and safe to read."""

from __future__ import annotations

import copy
import functools
import json
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest

from calibgui import engine
from calibgui.dataset import Hardware, Result, View, ViewStatus
from calibgui.engine.boards.kinds import KINDS
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.result import Cost, DegenerateError, Undetermined
from calibgui.engine.camera import SensorMode
from calibgui.engine.camera.image_circle import ImageCircle
from calibgui.engine.camera.models import MODELS
from calibgui.engine.errors import CalibrationError
from calibgui.formats import export, read_camera
from calibgui.formats.json_document import dumps
from calibgui.formats.result_json import encode_result, read_result, write_result
from tests.engine import scenes
from tests.formats.cameras import example, holding, splined
from tests.formats.conftest import solved
from tests.formats.records import same

_SCHEMA = Path(__file__).parents[2] / "resources" / "schema" / "result-1.schema.json"
_ALL = pytest.mark.parametrize("name", ["result", "weighted", "forward_result", "paper_result"])


@functools.cache
def _validator() -> jsonschema.Draft202012Validator:
    schema = json.loads(_SCHEMA.read_text())
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator(schema)


def _content(result: Result) -> Any:
    return json.loads(dumps(encode_result(result)))


@pytest.fixture(scope="module")
def paper_result() -> Result:
    """The printed method, on its own grid."""
    return solved(scenes.barrel(), cost=Cost.PAPER)


@_ALL
def test_every_bit_reads_back(tmp_path: Path, name: str, request: pytest.FixtureRequest) -> None:
    result = request.getfixturevalue(name)
    write_result(result, tmp_path / "result.json")
    assert same(read_result(tmp_path / "result.json"), result)


def test_a_mode_reads_back_and_makes_the_camera_of_its_stream(
    tmp_path: Path, result: Result
) -> None:
    camera = result.calibration.camera
    mode = SensorMode.identity(camera.size).crop(10, 20, (600, 400)).flip(along_u=True)
    stream = replace(result, mode=mode)
    write_result(stream, tmp_path / "result.json")
    assert same(read_result(tmp_path / "result.json"), stream)
    _validator().validate(_content(stream))
    read = read_camera(tmp_path / "result.json")
    np.testing.assert_array_equal(read.camera.params, mode.adapt_camera(camera).params)
    assert read.covariance is not None
    np.testing.assert_allclose(np.diag(read.covariance), np.diag(result.calibration.covariance))
    without = {k: v for k, v in _content(stream).items() if k != "sensor_mode"}
    with pytest.raises(jsonschema.ValidationError):
        _validator().validate(without)


def test_a_partial_calibration_reads_back_as_such(tmp_path: Path) -> None:
    made = scenes.scene(scenes.barrel(), 1)
    with pytest.raises(DegenerateError) as caught:
        calibrate(made.noisy(0.3, np.random.default_rng(0)), made.size)
    partial = caught.value.partial
    assert partial is not None
    assert partial.diagnosis is not None
    assert partial.diagnosis.assumptions
    view = View("0.png", ViewStatus.FOUND, points=made.views[0])
    result = Result(partial, (view,), None)
    _validator().validate(_content(result))
    write_result(result, tmp_path / "result.json")
    assert same(read_result(tmp_path / "result.json"), result)
    with pytest.raises(CalibrationError, match="would take a partial calibration for a whole"):
        export(result, "ros", tmp_path / "camera.yaml")


def test_what_is_undetermined_reads_back_as_such(tmp_path: Path, result: Result) -> None:
    sigma, covariance = result.calibration.sigma.copy(), result.calibration.covariance.copy()
    sigma[6] = np.nan
    covariance[6] = covariance[:, 6] = np.nan
    calibration = replace(
        result.calibration,
        sigma=sigma,
        covariance=covariance,
        undetermined=(Undetermined("k3", "no corner depends on it"),),
        warnings=("The views cover half of the image.",),
    )
    partly = replace(result, calibration=calibration)
    write_result(partly, tmp_path / "result.json")
    assert same(read_result(tmp_path / "result.json"), partly)
    _validator().validate(_content(partly))


def test_findings_are_written_with_the_names_of_their_images(tmp_path: Path) -> None:
    made = scenes.scene(scenes.barrel(), 10, seed=3)
    views = made.noisy(0.1, np.random.default_rng(1))
    moved = views[2].uv.copy()
    moved[:6] += 30.0
    views[2] = Observation(moved, views[2].xy)
    points = [View(f"{k}.png", ViewStatus.FOUND, points=view) for k, view in enumerate(views)]
    wrong = Result(calibrate(views, made.size), tuple(points), None)
    write_result(wrong, tmp_path / "result.json")
    content = json.loads((tmp_path / "result.json").read_text())
    _validator().validate(content)
    finding = content["findings"][0]
    assert finding["cause"] == "misplaced-corners"
    assert finding["views"] == ["2.png"]
    assert "2.png" in finding["message"]
    assert same(read_result(tmp_path / "result.json"), wrong)


def test_a_lens_error_is_kept_and_0_where_a_file_has_none(tmp_path: Path, result: Result) -> None:
    wrong = replace(result, calibration=replace(result.calibration, lens_error=0.375))
    _validator().validate(_content(wrong))
    file = tmp_path / "result.json"
    write_result(wrong, file)
    assert read_result(file).calibration.lens_error == 0.375
    content = json.loads(file.read_text())
    assert content.pop("lens_error_px") == 0.375
    file.write_text(json.dumps(content))
    assert read_result(file).calibration.lens_error == 0


def test_a_corner_beyond_the_lenss_fold_reads_back_as_such(tmp_path: Path, result: Result) -> None:
    first, *others = result.calibration.residuals
    reference = first.reference.copy()
    reference[3] = np.nan
    folded = replace(result.calibration, residuals=(replace(first, reference=reference), *others))
    result = replace(result, calibration=folded)
    _validator().validate(_content(result))
    write_result(result, tmp_path / "result.json")
    assert same(read_result(tmp_path / "result.json"), result)


@_ALL
def test_results_follow_the_schema(name: str, request: pytest.FixtureRequest) -> None:
    _validator().validate(_content(request.getfixturevalue(name)))


@pytest.mark.data
def test_a_real_result_follows_the_schema_and_reads_back(bouguet: Path, tmp_path: Path) -> None:
    points, size = scenes.stored(
        bouguet / "corners_and_results" / "corners_25img__benJephunneh.json"
    )
    views = [View(f"{k}", ViewStatus.FOUND, points=p) for k, p in enumerate(points)]
    result = Result(engine.calibrate(points, size), tuple(views))
    _validator().validate(_content(result))
    write_result(result, tmp_path / "result.json")
    assert same(read_result(tmp_path / "result.json"), result)


def _places(schema: Any, content: Any, place: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """Where in `content` an object must hold certain members: (..., member)."""
    found = [(*place, key) for key in schema.get("required", ())]
    for key, inner in schema.get("properties", {}).items():
        if isinstance(content.get(key), dict):
            found += _places(inner, content[key], (*place, key))
    return found


def test_the_schema_refuses_what_is_missing_or_unknown(result: Result) -> None:
    content = _content(result)
    places = _places(_validator().schema, content)
    assert len(places) > 30
    for place in places:
        damaged = copy.deepcopy(content)
        holder = functools.reduce(lambda node, key: node[key], place[:-1], damaged)
        del holder[place[-1]]
        assert not _validator().is_valid(damaged), place
    strict: list[list[Any]] = [[], ["camera"], ["paper"], ["residuals"], ["views", 0], ["target"]]
    for path in strict:
        damaged = copy.deepcopy(content)
        functools.reduce(lambda node, key: node[key], path, damaged)["typo"] = 1
        assert not _validator().is_valid(damaged), path
    for path in (["camera", "params", "p3"], ["views", 1, "residuals_px"], ["stage_one", 0, "k1"]):
        damaged = copy.deepcopy(content)
        del functools.reduce(lambda node, key: node[key], path[:-1], damaged)[path[-1]]
        assert not _validator().is_valid(damaged), path


def test_the_schema_names_every_lens_model_and_every_kind_of_board() -> None:
    schema = _validator().schema
    models = schema["properties"]["camera"]["properties"]["model"]["description"]
    assert set(MODELS) <= set(re.findall(r"[a-z]+(?:-[a-z0-9]+)*", models))
    assert schema["$defs"]["pattern"]["properties"]["kind"]["enum"] == list(KINDS)


def test_the_figures_are_those_of_the_calibration(result: Result) -> None:
    """Each public figure against its definition, from the raw numbers."""
    content = _content(result)
    camera, paper = content["camera"], content["paper"]
    params, sigma = camera["params"], camera["sigma"]
    assert camera["size"] == [640, 480]
    assert list(params) == ["fx", "fy", "cx", "cy", "k1", "k2", "k3", "p1", "p2", "p3"]
    assert list(params.values()) == result.calibration.camera.params.tolist()
    assert sigma["p3"] == params["p3"] == 0.0 and camera["fixed"] == ["p3"]
    assert paper["xp"] == params["cx"] - 319.5 and paper["yp"] == 239.5 - params["cy"]
    assert paper["k2"] == pytest.approx(params["k2"] / params["fx"] ** 4, rel=1e-12)
    assert paper["sigma"]["xp"] == pytest.approx(sigma["cx"], rel=1e-12)

    residuals = np.concatenate([view.image for view in result.calibration.residuals])
    assert content["residuals"]["count"] == len(residuals) == 5 * 48 - 5
    rms = np.sqrt(np.mean(residuals[:, 0] ** 2 + residuals[:, 1] ** 2))
    assert content["residuals"]["rms_px"] == pytest.approx(rms, rel=1e-12)
    assert content["residuals"]["sigma_x_px"] == pytest.approx(residuals[:, 0].std(), rel=1e-12)

    views = content["views"]
    assert [view["corners"] for view in views] == [0, 48, 43, 48, 48, 48, 48, 0]
    assert [view["rvec"] is None for view in views] == [1, 0, 0, 0, 1, 0, 0, 1]
    assert views[0]["reason"] == "No board: the image is dark."
    assert views[5]["tvec_mm"] == result.calibration.poses[3].tvec.tolist()
    assert views[5]["sigma_rvec"][1] == np.sqrt(result.calibration.pose_covariances[3, 1, 1])
    assert views[5]["sigma_tvec_mm"][2] == np.sqrt(result.calibration.pose_covariances[3, 5, 5])
    assert [row["image"] for row in content["stage_one"]] == [view.image for view in result.used]
    assert content["versions"].keys() == {"calibgui", "numpy", "scipy", "opencv", "python"}


@pytest.mark.parametrize("name", ["result", "weighted"])
def test_a_result_can_be_solved_again_from_its_own_file(
    tmp_path: Path, name: str, request: pytest.FixtureRequest
) -> None:
    result = request.getfixturevalue(name)
    write_result(result, tmp_path / "result.json")
    kept = read_result(tmp_path / "result.json")
    settings = kept.calibration.settings
    again = engine.calibrate(
        kept.observations(),
        kept.calibration.camera.size,
        cost=settings.cost,
        model=settings.model,
        fix=settings.fixed,
        free={"p3"} - settings.fixed.keys(),
    )
    assert again.digest == result.calibration.digest
    assert np.array_equal(again.camera.params, result.calibration.camera.params)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"version": 3}, "version 3 .* knows versions up to 2"),
        ({"format": "calibgui-project"}, "is not the result of a calibration"),
        ({"format": None}, "holds corners, but no calibration"),
        ({"views": []}, "views is not a list with usable views"),
        (
            {"settings": {"cost": "image", "fixed": {"p3": "0"}}},
            "settings.fixed.p3 is not a finite",
        ),
        ({"stage_one": None}, "stage_one is not a list"),
    ],
)
def test_files_that_cannot_be_used_say_why(
    tmp_path: Path, result: Result, change: dict[str, Any], message: str
) -> None:
    file = tmp_path / "result.json"
    file.write_text(json.dumps(_content(result) | change))
    with pytest.raises(CalibrationError, match=message) as caught:
        read_result(file)
    assert str(file) in caught.value.message
    assert caught.value.hint


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("fx", 0, "camera.params.fx is not a focal length above 0"),
        ("fy", -5.0, "camera.params.fy is not a focal length above 0"),
        ("k1", None, "camera.params.k1 is not a finite number"),
    ],
)
def test_a_camera_that_cannot_be_is_refused(
    tmp_path: Path, result: Result, name: str, value: float | None, message: str
) -> None:
    content = _content(result)
    content["camera"]["params"][name] = value
    file = tmp_path / "result.json"
    file.write_text(json.dumps(content))
    with pytest.raises(CalibrationError, match=message):
        read_result(file)


@pytest.mark.parametrize("model", [*scenes.LENSES, "splined"])
def test_cameras_of_every_model_are_read_back(tmp_path: Path, result: Result, model: str) -> None:
    held = holding(result, splined() if model == "splined" else example(model))
    export(held, "result", tmp_path / "result.json")
    camera = read_result(tmp_path / "result.json").calibration.camera
    assert camera.model == held.calibration.camera.model
    np.testing.assert_array_equal(camera.params, held.calibration.camera.params)


def test_the_image_circle_is_read_back(tmp_path: Path, result: Result) -> None:
    circle = ImageCircle(320.5, 240.25, 200.0)
    camera = replace(result.calibration.camera, circle=circle)
    views = tuple(replace(view, circle=circle) for view in result.views)
    held = replace(result, calibration=replace(result.calibration, camera=camera), views=views)
    export(held, "result", tmp_path / "result.json")
    content = json.loads((tmp_path / "result.json").read_text())
    _validator().validate(content)
    found = read_result(tmp_path / "result.json")
    assert found.calibration.camera.circle == circle
    assert {view.circle for view in found.views} == {circle}
    content["camera"]["circle"][2] = 0
    (tmp_path / "none.json").write_text(json.dumps(content))
    with pytest.raises(CalibrationError, match="circle is not a column, a row and a radius"):
        read_result(tmp_path / "none.json")


def test_camera_and_lens_that_were_stated_are_read_back(tmp_path: Path, result: Result) -> None:
    stated = Hardware("Acme", "X-1", lens="18 mm", mount="Fuji X", crop=1.5, type="fisheye")
    export(replace(result, hardware=stated), "result", tmp_path / "result.json")
    content = json.loads((tmp_path / "result.json").read_text())
    _validator().validate(content)
    assert read_result(tmp_path / "result.json").hardware == stated
    for name, wrong in (("crop", 0), ("type", "round"), ("maker", 3)):
        broken = {**content, "hardware": {name: wrong}}
        (tmp_path / "broken.json").write_text(json.dumps(broken))
        with pytest.raises(CalibrationError, match=name):
            read_result(tmp_path / "broken.json")


def test_an_older_name_of_the_lens_model_is_read(tmp_path: Path, forward_result: Result) -> None:
    content = _content(forward_result)
    assert content["camera"]["model"] == content["settings"]["model"] == "brown-conrady"
    content["camera"]["model"] = content["settings"]["model"] = "opencv"
    _validator().validate(content)
    (tmp_path / "old.json").write_text(json.dumps(content))
    assert same(read_result(tmp_path / "old.json"), forward_result)
    content["camera"]["model"] = "odd"
    (tmp_path / "odd.json").write_text(json.dumps(content))
    with pytest.raises(CalibrationError, match=r"camera\.model is not one of lucchese"):
        read_result(tmp_path / "odd.json")


def test_a_file_from_before_a_coefficient_was_added_holds_it(
    tmp_path: Path, forward_result: Result
) -> None:
    """Brown and Conrady's model had no skew in earlier versions."""
    content = _content(forward_result)
    camera, covariance = content["camera"], content["covariance"]
    for values in (camera["params"], camera["sigma"], camera["sigma_by_noise"]):
        assert values.pop("skew") == 0.0
    camera["fixed"].remove("skew")
    assert content["settings"]["fixed"].pop("skew") == 0.0
    assert covariance["parameters"].pop() == "skew"
    for name in ("matrix", "matrix_by_noise"):
        covariance[name] = [row[:-1] for row in covariance[name][:-1]]
    _validator().validate(content)
    (tmp_path / "old.json").write_text(json.dumps(content))
    assert same(read_result(tmp_path / "old.json"), forward_result)
    del camera["params"]["k3"]
    (tmp_path / "less.json").write_text(json.dumps(content))
    with pytest.raises(CalibrationError, match=r"camera\.params\.k3 is missing"):
        read_result(tmp_path / "less.json")


def test_a_file_cut_anywhere_is_refused(tmp_path: Path, result: Result) -> None:
    text = dumps(encode_result(result))
    for length in np.linspace(0, len(text) - 1, 60).astype(int):
        (tmp_path / "cut.json").write_text(text[:length], encoding="utf-8")
        with pytest.raises(
            CalibrationError, match=r"cut\.json is (cut short|empty|not a JSON file)"
        ):
            read_result(tmp_path / "cut.json")


def test_a_missing_row_of_stage_one_and_an_impossible_name_are_refused(
    tmp_path: Path, result: Result
) -> None:
    path, whole = tmp_path / "result.json", _content(result)
    rows = len(whole["stage_one"])
    path.write_text(json.dumps(whole | {"stage_one": whole["stage_one"][1:]}))
    wanted = rf"result\.json: stage_one is not a list of {rows} entries \(it has {rows - 1}\)"
    with pytest.raises(CalibrationError, match=wanted):
        read_result(path)
    whole["views"][1]["image"] = "a\0b.png"
    path.write_text(json.dumps(whole))
    with pytest.raises(CalibrationError, match=r"view 2\.image is not the name of a file: .* NUL"):
        read_result(path)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("max_iterations", -1),
        ("max_iterations", 1.5),
        ("method", ["lucchese"]),
        ("method", "nobody's"),
        ("plate", {}),
        ("plate_held", 1),
        ("outliers", "3"),
        ("model_reason", [1]),
        ("robust", "yes"),
    ],
)
def test_settings_are_of_their_types(
    tmp_path: Path, result: Result, name: str, value: object
) -> None:
    content = _content(result)
    content["settings"][name] = value
    (tmp_path / "result.json").write_text(json.dumps(content))
    with pytest.raises(CalibrationError, match=rf"result\.json: settings\.{name} is not"):
        read_result(tmp_path / "result.json")


@pytest.mark.parametrize("entry", [[0, 1], [1, 0]])
def test_a_covariance_that_is_not_symmetric_is_refused(
    tmp_path: Path, result: Result, entry: list[int]
) -> None:
    content = _content(result)
    content["covariance"]["matrix"][entry[0]][entry[1]] *= 1.01
    (tmp_path / "result.json").write_text(json.dumps(content))
    with pytest.raises(CalibrationError, match=r"covariance\.matrix .* not symmetric"):
        read_result(tmp_path / "result.json")
