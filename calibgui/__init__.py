"""Geometric camera calibration through multi-view rectification.

In a script or a notebook:

    >>> import calibgui
    >>> camera = calibgui.calibrate("photographs", square=25)  # doctest: +SKIP
    >>> print(camera)  # doctest: +SKIP

``from calibgui import engine`` is the interface for arrays: arrays in, frozen records out.
``calibgui.dataset`` keeps photographs with what was found in them, ``calibgui.formats`` reads and
writes the files of other programs, and ``python -m calibgui`` is the command line, whose arguments
may be photographs to open in the window.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from calibgui.engine.faces import load_on_demand
from calibgui.version import __version__ as __version__

if TYPE_CHECKING:
    from calibgui.scripting.calibrated_camera import CalibratedCamera as CalibratedCamera
    from calibgui.scripting.calibration import (
        calibrate as calibrate,
    )
    from calibgui.scripting.calibration import (
        calibrate_corners as calibrate_corners,
    )
    from calibgui.scripting.calibration import (
        load as load,
    )
    from calibgui.scripting.figures import (
        plot_board_shape as plot_board_shape,
    )
    from calibgui.scripting.figures import (
        plot_convergence as plot_convergence,
    )
    from calibgui.scripting.figures import (
        plot_distortion as plot_distortion,
    )
    from calibgui.scripting.figures import (
        plot_residuals as plot_residuals,
    )
    from calibgui.scripting.figures import (
        plot_uncertainty as plot_uncertainty,
    )
    from calibgui.scripting.hand_eye import calibrate_hand_eye as calibrate_hand_eye
    from calibgui.scripting.rig import (
        CalibratedRig as CalibratedRig,
    )
    from calibgui.scripting.rig import (
        calibrate_rig as calibrate_rig,
    )
    from calibgui.scripting.rig import (
        load_rig as load_rig,
    )

load_on_demand(
    __name__,
    {
        "scripting.calibrated_camera": ["CalibratedCamera"],
        "scripting.calibration": ["calibrate", "calibrate_corners", "load"],
        "scripting.figures": [
            "plot_board_shape",
            "plot_convergence",
            "plot_distortion",
            "plot_residuals",
            "plot_uncertainty",
        ],
        "scripting.hand_eye": ["calibrate_hand_eye"],
        "scripting.rig": ["CalibratedRig", "calibrate_rig", "load_rig"],
    },
)
