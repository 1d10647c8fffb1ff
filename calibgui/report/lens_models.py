"""Each lens model is described by who reads it, and up to which field of view it holds.

The titles of the models are in the engine (``Lens.title``); this is what else a user wants to know
who chooses one.
"""

from __future__ import annotations

from calibgui.engine.camera import SplinedStereographic, find_model, resolve_model_id

_PURPOSES = {
    "lucchese": "The paper's: it corrects measured points, with radial, decentering and prism "
    "terms, and is undone without iteration. Up to about 120 degrees. Other programs get a fit.",
    "lucchese-pixels": "The paper's to the letter, with a radius in pixels.",
    "pinhole": "No distortion at all: for images that are undistorted already, and ideal cameras.",
    "brown-conrady-4": "Read by OpenCV, Kalibr (radtan), COLMAP (OPENCV) and MATLAB. Up to about "
    "100 degrees.",
    "brown-conrady": "The default of OpenCV and ROS (plumb_bob), and of most programs. Up to about "
    "100 degrees.",
    "rational": "Read by OpenCV, ROS (rational_polynomial) and COLMAP (FULL_OPENCV). Up to about "
    "150 degrees. Few views leave its coefficients undetermined.",
    "thin-prism": "Read by OpenCV (CALIB_THIN_PRISM_MODEL): rational, for a lens whose elements "
    "are tilted. Up to about 150 degrees. It needs many views.",
    "kannala-brandt": "The usual fisheye model: OpenCV (fisheye), ROS (equidistant), Kalibr "
    "(pinhole-equi), COLMAP (OPENCV_FISHEYE). Up to about 220 degrees.",
    "kannala-brandt-decentering": "Kannala-Brandt for a fisheye lens whose elements are not quite "
    "centred. Few programs read it; others get a fit. Up to about 220 degrees.",
    "ucm": "One coefficient for fisheye lenses and mirrors, undone without iteration. Up to about "
    "220 degrees.",
    "eucm": "Read by Kalibr (eucm-none) and Basalt; undone without iteration. Up to about 220 "
    "degrees.",
    "double-sphere": "Read by Basalt and Kalibr (ds-none); undone without iteration. Up to about "
    "220 degrees. Narrow lenses leave its coefficients undetermined.",
    "mei": "Read by Kalibr (omni-radtan) and OpenCV (omnidir): the unified model with Brown's "
    "distortion. Up to about 220 degrees. Narrow lenses leave xi undetermined.",
    "division": "One coefficient, read by COLMAP (DIVISION). Up to about 180 degrees, where a lens "
    "need not be followed closely.",
    "scaramuzza": "MATLAB's for fisheye lenses, and OCamCalib's. Up to about 190 degrees.",
    "splined-stereographic": "mrcal's: a smooth surface of hundreds of values, which follows any "
    "lens where there are corners. Up to about 220 degrees. It needs corners all over the image.",
}
"""By the id of the model; the splined models share theirs."""


def describe_lens_model(model: str) -> str:
    """Describe what a lens model is for in one to three sentences.

    Raises:
        CalibrationError: if there is no such model.
    """
    if isinstance(find_model(model), SplinedStereographic):
        return _PURPOSES["splined-stereographic"]
    return _PURPOSES[resolve_model_id(model)]


def get_lens_title(model: str) -> str:
    """Return the title of a lens model, with its numbers if it is a splined one of many.

    Raises:
        CalibrationError: if there is no such model.
    """
    lens = find_model(model)
    if isinstance(lens, SplinedStereographic):
        return f"{lens.title}, {lens.Nx} x {lens.Ny} over {lens.fov} degrees"
    return lens.title


def get_short_lens_title(model: str) -> str:
    """Return the title of a lens model without the programs that it is known from.

    Raises:
        CalibrationError: if there is no such model.
    """
    return find_model(model).short_title
