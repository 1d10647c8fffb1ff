"""Metashape's calibrations, projected by the formulas of its manual: it has no reader on PyPI."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest

from calibgui.dataset import Result
from calibgui.engine.arrays import Array
from calibgui.engine.camera.projection import pixels_from_rays
from calibgui.engine.errors import CalibrationError
from calibgui.formats import read_camera
from calibgui.formats.metashape_xml import EXPORTER, write_metashape
from tests.formats.cameras import RAYS, example, holding, rays_for


def project(calibration: ET.Element, rays: Array, width: int, height: int, kind: str) -> Array:
    """Pixels (n, 2), counted from the first one's corner, by the manual's camera models."""
    value = {
        entry.tag: float(entry.text or 0) for entry in calibration if entry.tag != "projection"
    }
    f, cx, cy = value["f"], value["cx"], value["cy"]
    k1, k2, k3, k4, p1, p2, b1, b2 = (
        value.get(name, 0.0) for name in ("k1", "k2", "k3", "k4", "p1", "p2", "b1", "b2")
    )
    x, y = rays[:, 0] / rays[:, 2], rays[:, 1] / rays[:, 2]
    if kind == "fisheye":
        r0 = np.hypot(x, y)
        stretch = np.divide(np.arctan(r0), r0, out=np.ones_like(r0), where=r0 > 0)
        x, y = x * stretch, y * stretch
    r2 = x * x + y * y
    radial = 1 + k1 * r2 + k2 * r2**2 + k3 * r2**3 + k4 * r2**4
    there_x = x * radial + p1 * (r2 + 2 * x * x) + 2 * p2 * x * y
    there_y = y * radial + p2 * (r2 + 2 * y * y) + 2 * p1 * x * y
    u = width * 0.5 + cx + there_x * f + there_x * b1 + there_y * b2
    v = height * 0.5 + cy + there_y * f
    return np.column_stack([u, v])


@pytest.mark.parametrize("model", EXPORTER.models)
def test_metashape_projects_each_model_to_our_pixels(
    tmp_path: Path, result: Result, model: str
) -> None:
    camera = example(model, skew=2e-3)
    path = write_metashape(holding(result, camera), tmp_path / "camera.xml").path
    root = ET.parse(path).getroot()
    size = [int(root.findtext(side, "")) for side in ("width", "height")]
    assert tuple(size) == camera.size
    kind = root.findtext("projection", "")
    assert kind == ("fisheye" if "kannala" in model else "frame")
    rays = rays_for(camera)
    theirs = project(root, rays, *camera.size, kind)
    assert np.abs(theirs - 0.5 - pixels_from_rays(rays, camera)).max() < 1e-9
    assert read_camera(path).camera.model in (model, "brown-conrady", "kannala-brandt-decentering")


_SENSOR = """\
  <sensor id="{id}" label="{label}" type="frame">
   <resolution width="640" height="480"/>
   <property name="focal_length" value="15"/>
   <bands><band label="Red"/></bands>
   <calibration type="frame" class="initial">
    <resolution width="640" height="480"/>
    <f>600</f>
   </calibration>
   {adjusted}
   <covariance><params>f cx cy</params><coeffs>1 0 0 0 1 0 0 0 1</coeffs></covariance>
  </sensor>
"""
_ADJUSTED = """\
<calibration type="frame" class="adjusted">
    <resolution width="640" height="480"/>
    <f>610.5</f><cx>13.25</cx><cy>-7.5</cy><k1>-0.05</k1><k2>0.02</k2><k3>-0.01</k3>
    <b1>1.5</b1><b2>0.25</b2><p1>-0.0011</p1><p2>0.0008</p2>
   </calibration>"""


def write_cameras(path: Path, *sensors: str) -> Path:
    path.write_text(
        '<?xml version="1.0" encoding="UTF-8"?>\n<document version="2.0.0">\n'
        f' <chunk label="Chunk 1">\n <sensors next_id="1">\n{"".join(sensors)} </sensors>\n'
        ' <cameras><camera id="0" sensor_id="0" label="a"/></cameras>\n </chunk>\n</document>\n'
    )
    return path


def test_the_adjusted_calibration_is_read_not_the_one_before_it(tmp_path: Path) -> None:
    file = write_cameras(
        tmp_path / "cameras.xml", _SENSOR.format(id=0, label="P1", adjusted=_ADJUSTED)
    )
    read = read_camera(file)
    assert read.notes == () and read.camera.size == (640, 480)
    theirs = project(ET.fromstring(_ADJUSTED), RAYS, 640, 480, "frame")
    assert np.abs(theirs - 0.5 - pixels_from_rays(RAYS, read.camera)).max() < 1e-9


def test_cameras_are_chosen_by_their_labels(tmp_path: Path) -> None:
    sensors = [
        _SENSOR.format(id=0, label="P1", adjusted=_ADJUSTED),
        _SENSOR.format(id=1, label="P1", adjusted=""),
    ]
    file = write_cameras(tmp_path / "cameras.xml", *sensors)
    with pytest.raises(CalibrationError, match=r"holds 2 cameras: P1, P1 \(1\)"):
        read_camera(file)
    assert read_camera(file, "P1").camera.params[1] == 610.5
    initial = read_camera(file, "P1 (1)")
    assert initial.camera.params[:4].tolist() == [600, 600, 319.5, 239.5]
    assert "has not adjusted" in initial.notes[1]


_FILE = (
    "<calibration><projection>{}</projection><width>640</width><height>480</height>{}</calibration>"
)


@pytest.mark.parametrize(
    ("kind", "entries", "message"),
    [
        ("frame", "<f>600</f><k4>0.1</k4>", "its k4 is not 0"),
        ("frame", "<f>600</f><p3>0.1</p3>", "its p3 is not 0"),
        ("fisheye", "<f>600</f><b2>0.1</b2>", "its b2 is not 0"),
        ("spherical", "<f>600</f>", "lens model spherical, which cannot be read"),
        ("frame", "<f>six</f>", "f is not a finite number"),
        ("frame", "<f>-600</f>", "focal length that is not above 0"),
        ("frame", "<fx>600</fx><fy>600</fy>", r"PhotoScan before 1\.2"),
        ("frame", "<cx>3</cx>", "f is missing"),
    ],
)
def test_errors_name_file_and_fault(tmp_path: Path, kind: str, entries: str, message: str) -> None:
    file = tmp_path / "camera.xml"
    file.write_text(_FILE.format(kind, entries))
    with pytest.raises(CalibrationError, match=message) as caught:
        read_camera(file)
    assert str(file) in caught.value.message
