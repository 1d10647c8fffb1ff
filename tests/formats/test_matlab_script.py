"""MATLAB's scripts: arguments by position, pixels from 1, rows before columns, transposed K."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from calibgui.dataset import Result
from calibgui.engine.arrays import Array
from calibgui.engine.camera.projection import pixels_from_rays, rays_from_pixels
from calibgui.engine.errors import CalibrationError
from calibgui.formats import read_camera
from calibgui.formats.matlab_script import write_matlab
from tests.formats.cameras import RAYS, example, holding


def _arguments(text: str) -> tuple[str, list[Array], dict[str, Array]]:
    """Name, positional and named arguments of the written call."""
    text = text.replace("...", " ")
    call = re.fullmatch(r"intrinsics = (\w+)\((.*)\);\n", text.split("down.\n")[1], re.DOTALL)
    named, positional = {}, []
    for name, matrix in re.findall(r"(?:'(\w+)', )?(\[[^]]*\]|[-\d.e]+)", call[2]):
        rows = [[float(x) for x in row.split()] for row in matrix.strip("[]").split(";")]
        if name:
            named[name] = np.array(rows)
        else:
            positional.append(np.array(rows))
    return call[1], positional, named


@pytest.mark.parametrize("model", ["pinhole", "brown-conrady-4", "brown-conrady"])
def test_matlabs_formula_projects_to_our_pixels(tmp_path: Path, result: Result, model: str) -> None:
    camera = example(model, skew=2e-3)
    report = write_matlab(holding(result, camera), tmp_path / "camera.m")
    name, (focal, principal, size), named = _arguments(report.path.read_text())
    assert name == "cameraIntrinsics"
    assert size.tolist() == [[480, 640]]
    K = np.diag([*focal[0], 1.0])
    K[:2, 2] = principal
    x, y = (RAYS[:, :2] / RAYS[:, 2:]).T
    if model != "pinhole":
        K[0, 1] = named["Skew"][0, 0]
        (k1, k2, *k3), (p1, p2) = named["RadialDistortion"][0], named["TangentialDistortion"][0]
        assert len(k3) == (model == "brown-conrady")
        r2 = x**2 + y**2
        radial = 1 + k1 * r2 + k2 * r2**2 + sum(k3) * r2**3
        x, y = (
            x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x**2),
            y * radial + p1 * (r2 + 2 * y**2) + 2 * p2 * x * y,
        )
    seen = np.column_stack([x, y, np.ones_like(x)]) @ K.T
    assert np.abs(seen[:, :2] - 1 - pixels_from_rays(RAYS, camera)).max() < 1e-9


def test_a_fisheyes_rays_are_ours(tmp_path: Path, result: Result) -> None:
    camera = example("scaramuzza")
    report = write_matlab(holding(result, camera), tmp_path / "camera.m")
    name, (mapping, size, centre, stretch), named = _arguments(report.path.read_text())
    assert name == "fisheyeIntrinsics" and not named
    assert size.tolist() == [[480, 640]]
    uv = np.random.default_rng(0).uniform([0, 0], [640, 480], (50, 2))
    # Sensor and image are related by [u; v] = stretch [x; y] + centre.
    x, y = np.linalg.solve(stretch, (uv + 1 - centre).T)
    rho = np.hypot(x, y)
    a0, a2, a3, a4 = mapping[0]
    rays = np.column_stack([x, y, a0 + a2 * rho**2 + a3 * rho**3 + a4 * rho**4])
    rays /= np.linalg.norm(rays, axis=1)[:, None]
    assert np.abs(rays - rays_from_pixels(uv, camera)).max() < 1e-12


_SCRIPTS = {
    "by variables": """
        % Calibrated yesterday: cameraIntrinsics are below
        focalLength = [800.5, 801.5];  principal = 1;
        focalLength = [800.5, 801.5];
        principalPoint = [320.5 ...
                          240.5];
        imageSize = [480 640]';
        intrinsics = cameraIntrinsics(focalLength, principalPoint, imageSize, ...
            "RadialDistortion", [-0.3 0.1], 'TangentialDistortion', [1e-3 -2e-3]);
    """,
    "by the transposed matrix": """
        IntrinsicMatrix = [800.5 0 0; 0 801.5 0; 320.5 240.5 1];
        params = cameraParameters('IntrinsicMatrix', IntrinsicMatrix, ...
            'RadialDistortion', [-0.3 0.1], 'TangentialDistortion', [1e-3 -2e-3], ...
            'ImageSize', [480 640]);
    """,
    "by K": """
        K = [800.5 0 320.5
             0 801.5 240.5
             0 0 1];
        params = cameraParameters('K', K, 'RadialDistortion', [-0.3; 0.1], ...
            'TangentialDistortion', [1e-3 -2e-3], 'ImageSize', [480 640]);
    """,
    "by K transposed twice": """
        K = [800.5 0 0; 0 801.5 0; 320.5 240.5 1]';
        params = cameraParameters('IntrinsicMatrix', K', 'ImageSize', [480, 640], ...
            'RadialDistortion', [-0.3 0.1], 'TangentialDistortion', [1e-3 -2e-3]);
    """,
}


@pytest.mark.parametrize("name", _SCRIPTS)
def test_scripts_of_others_are_read(tmp_path: Path, name: str) -> None:
    file = tmp_path / "a.m"
    file.write_text(_SCRIPTS[name])
    camera = read_camera(file).camera
    assert (camera.model, camera.size) == ("brown-conrady-4", (640, 480))
    expected = [800.5, 801.5, 319.5, 239.5, -0.3, 0.1, 1e-3, -2e-3, 0.0]
    assert camera.params.tolist() == expected


def test_the_example_of_matlabs_manual_is_read(tmp_path: Path) -> None:
    (tmp_path / "a.m").write_text(
        "imageSize = [1500 2000];\nmappingCoefficients = [880 -3e-4 0 0];\n"
        "distortionCenter = [1000 750];\n"
        "intrinsics = fisheyeIntrinsics(mappingCoefficients,imageSize,distortionCenter);\n"
    )
    camera = read_camera(tmp_path / "a.m").camera
    assert (camera.model, camera.size) == ("scaramuzza", (2000, 1500))
    np.testing.assert_allclose(camera.params, [880, 880, 999, 749, -0.264, 0, 0], rtol=1e-15)


_CALL = "cameraIntrinsics([800 800], [320 240], [480 640], 'RadialDistortion', [0.1 0.2])"


@pytest.mark.parametrize(
    ("script", "message"),
    [
        (_CALL.replace("[800 800]", "f"), "FocalLength that is no matrix of numbers: f"),
        (_CALL.replace("[800 800]", "[800 800 1]"), "FocalLength of 3 numbers, not 1 or 2"),
        (_CALL.replace("[0.1 0.2]", "[0.1]"), "RadialDistortion of 1 numbers, not 2 or 3"),
        (_CALL.replace("[0.1 0.2]", "zeros(1, 2)"), "an argument that is no matrix"),
        (_CALL.replace("[480 640]", "[480 640], 7"), "too many arguments"),
        (_CALL.replace("[800 800]", "[0 800]"), "focal length that is not above 0"),
        (_CALL.replace("[800 800]", "[1e999 800]"), "not finite"),
        (_CALL.replace("[480 640], ", ""), "does not say how large its images are"),
        (_CALL[:30], "an argument that is no matrix"),
        ("cameraParameters('K', [1 2; 3 4])", "intrinsic matrix that is not that of a camera"),
        ("cameraIntrinsics([800 800])", "states no PrincipalPoint"),
        (
            "fisheyeIntrinsics([880 -3e-4 0 0], [480 640], [320 240], [1 0.1; 0 1])",
            "turns the image about the axis",
        ),
    ],
)
def test_errors_name_file_and_fault(tmp_path: Path, script: str, message: str) -> None:
    file = tmp_path / "a.m"
    file.write_text(f"x = {script};\n")
    with pytest.raises(CalibrationError, match=message) as caught:
        read_camera(file)
    assert str(file) in caught.value.message


def test_a_script_without_a_size_takes_the_users(tmp_path: Path) -> None:
    (tmp_path / "a.m").write_text("p = cameraParameters('K', [800 2 320; 0 810 240; 0 0 1]);\n")
    camera = read_camera(tmp_path / "a.m", size=(640, 480)).camera
    assert camera.size == (640, 480)
    assert camera.params[-1] == 2 / 800  # MATLAB's skew is in px
