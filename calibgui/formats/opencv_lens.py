"""OpenCV's lens models in files: a camera matrix, and a list of coefficients that has no names.

The number of coefficients tells the model, and their order is that of our models of these names:

    4   k1 k2 p1 p2                              brown-conrady-4
    5   k1 k2 p1 p2 k3                           brown-conrady
    8   k1 k2 p1 p2 k3 k4 k5 k6                  rational
    12  k1 k2 p1 p2 k3 k4 k5 k6 s1 s2 s3 s4      thin-prism
    14  and the two angles of a tilted sensor, which must be 0 here: thin-prism

and of cv2.fisheye 4, k1 k2 k3 k4 (kannala-brandt), which only another entry of the file can tell
from the first. Pixels are the array frame's. OpenCV projects without the skew of the camera matrix.
"""

from __future__ import annotations

import numpy as np

from calibgui.dataset import StereoRectification
from calibgui.engine.arrays import Array, Size
from calibgui.engine.camera import Camera, list_parameter_names
from calibgui.formats.importer import CameraText
from calibgui.formats.node import Node
from calibgui.formats.opencv_storage import read_matrix

FISHEYE = "kannala-brandt"
"""Id of the model of cv2.fisheye, and of what ROS and Kalibr call equidistant."""
PERSPECTIVE_MODELS = ("brown-conrady", "brown-conrady-4", "pinhole", "rational", "thin-prism")
"""Ids of the models of cv2.projectPoints."""
_MODEL_BY_COUNT = {
    0: "pinhole",
    1: "pinhole",  # OpenCV's own writers put a single 0
    4: "brown-conrady-4",
    5: "brown-conrady",
    8: "rational",
    12: "thin-prism",
    14: "thin-prism",
}


def read_rectification(
    R: Node | None, P: Node | None, camera: Camera
) -> StereoRectification | None:
    """Return the rectification of a stereo pair that a file holds; None if there is none, or that
    of one camera.

    Args:
        R: the entry of the rectification, 3 x 3.
        P: that of the projection, 3 x 4.
        camera: the camera of the file.

    Raises:
        CalibrationError: if the matrices have other sizes.
    """
    if R is None or P is None:
        return None
    turn, projection = read_matrix(R), read_matrix(P)
    if len(turn) != 9:
        R.fail("a matrix of 3 x 3 numbers")
    if len(projection) != 12:
        P.fail("a matrix of 3 x 4 numbers")
    if not (turn.any() and projection.any()):  # as of cameras that nobody has rectified
        return None
    found = StereoRectification(turn.reshape(3, 3), projection.reshape(3, 4))
    return None if found.is_of_one_camera(camera) else found


def list_coefficients(camera: Camera) -> Array:
    """Return a camera's coefficients as OpenCV lists them; five zeros for a pinhole camera."""
    if camera.model == "pinhole":
        return np.zeros(5)
    return camera.coefficients[: _count_coefficients(camera)]


def list_coefficient_names(camera: Camera) -> str:
    """Return the names of OpenCV's coefficients of a camera, separated by blanks."""
    if camera.model == "pinhole":
        return "k1 k2 p1 p2 k3"
    return " ".join(camera.names[4:][: _count_coefficients(camera)])


def _count_coefficients(camera: Camera) -> int:
    """Return the number of a camera's coefficients before the skew, which OpenCV does not have."""
    return sum(name != "skew" for name in camera.names[4:])


def make_opencv_camera(
    source: CameraText, size: Size, matrix: Array, coefficients: Array, fisheye: bool
) -> Camera:
    """Return the camera of a camera matrix and a list of coefficients.

    Args:
        source: the file.
        size: width and height of its images, px.
        matrix: (9,) the camera matrix, row by row.
        coefficients: (n,) in OpenCV's order.
        fisheye: whether they are of cv2.fisheye.

    Raises:
        CalibrationError: if the matrix is none of a camera, the number of coefficients none of
            OpenCV's, or the model none of ours.
    """
    fx, skew, cx, zero, fy, cy, *last = matrix.tolist()
    if zero != 0 or last != [0, 0, 1]:
        source.fail("has a camera matrix that is not [fx s cx; 0 fy cy; 0 0 1].")
    model = _find_model(source, coefficients, fisheye)
    names = [name for name in list_parameter_names(model)[4:] if name != "skew"]
    values = {"fx": fx, "fy": fy, "cx": cx, "cy": cy}
    values |= dict(zip(names, coefficients.tolist(), strict=False))
    if skew != 0:
        if "skew" not in list_parameter_names(model):
            source.fail(
                f"has a camera matrix with the skew {skew:g} px, which the lens model {model} "
                "does not have.",
                "Calibrate without skew.",
            )
        if fx > 0:
            values["skew"] = skew / fx
    return source.make_camera(size, model, values)


def _find_model(source: CameraText, coefficients: Array, fisheye: bool) -> str:
    """Return our id of the model of a list of coefficients."""
    count = len(coefficients)
    if fisheye:
        if count != 4:
            source.fail(f"has {count} coefficients; OpenCV's fisheye model has 4.")
        return FISHEYE
    if count not in _MODEL_BY_COUNT:
        source.fail(
            f"has {count} coefficients of the distortion.",
            "OpenCV's models have 4, 5, 8 or 12 of them, or 14 of which the last two are 0.",
        )
    if coefficients[12:].any():
        source.refuse_model(
            "of 14 coefficients with a tilted sensor",
            ["OpenCV's models of 4, 5, 8 and 12 coefficients"],
            "the tilt (its last two coefficients) is not 0",
        )
    if count == 1 and coefficients.any():
        source.fail("has 1 coefficient of the distortion, which is no model of OpenCV.")
    return _MODEL_BY_COUNT[count]
