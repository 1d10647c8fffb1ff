"""Calibration: from corners to a camera, with poses, standard deviations and a diagnosis.

`calibrate` takes `Observation` records and returns a `Calibration`; `METHODS` lists the methods
that it can use. `locate_board` gives the pose of a board under a known camera. `refit` expresses a
calibration in another lens model, `convert_camera` a camera without corners; `recover_arguments`
gives the arguments that repeat a calibration on other views. The remaining functions analyse views
and results for reports: copies among the views, the paper's tables, correlations.

    >>> import numpy as np
    >>> from calibgui.engine.boards import Board
    >>> from calibgui.engine.calibration import calibrate, compute_correlations
    >>> from calibgui.engine.camera import Camera, project_points
    >>> from calibgui.engine.geometry import Pose
    >>> camera, xy = Camera((640, 480), [650, 650, 320, 240] + 6 * [0]), Board(6, 7, 30.0).points()
    >>> rng = np.random.default_rng(0)
    >>> views = []
    >>> for tilt in [(0.5, 0, 0), (-0.5, 0, 0), (0, 0.5, 0), (0, -0.5, 0), (0.3, 0.4, 0)]:
    ...     uv = project_points(xy, camera, Pose(tilt, (-90, -75, 500)))
    ...     views.append((uv + rng.normal(scale=0.1, size=uv.shape), xy))
    >>> found = calibrate(views, camera.size, fix=["k2", "k3", "p1", "p2"])
    >>> bool(abs(found.camera.params[0] - 650) < 3 * found.sigma[0])
    True
    >>> bool(compute_correlations(found.covariance)[0, 1] > 0.5)  # fx and fy
    True
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from calibgui.engine.faces import load_on_demand

if TYPE_CHECKING:
    from calibgui.engine.calibration.board_poses import (
        BoardPose as BoardPose,
        locate_board as locate_board,
    )
    from calibgui.engine.calibration.calibrate import calibrate as calibrate
    from calibgui.engine.calibration.conversion import (
        Conversion as Conversion,
        convert_camera as convert_camera,
        find_followed_angle as find_followed_angle,
    )
    from calibgui.engine.calibration.held_camera import hold_camera as hold_camera
    from calibgui.engine.calibration.initialisation.single_view_pose import (
        evaluate_cosines_equation as evaluate_cosines_equation,
    )
    from calibgui.engine.calibration.methods import (
        METHODS as METHODS,
        check_method as check_method,
    )
    from calibgui.engine.calibration.methods.method import Method as Method
    from calibgui.engine.calibration.observations import (
        Observation as Observation,
        make_observation as make_observation,
    )
    from calibgui.engine.calibration.partial.degeneracy import (
        find_copies as find_copies,
        is_in_one_spot as is_in_one_spot,
    )
    from calibgui.engine.calibration.problem import (
        is_held as is_held,
        recover_arguments as recover_arguments,
    )
    from calibgui.engine.calibration.refinement.covariances import (
        compute_correlations as compute_correlations,
        make_paper_table as make_paper_table,
    )
    from calibgui.engine.calibration.refit import Refit as Refit, refit as refit
    from calibgui.engine.calibration.scaling import (
        compute_scale_covariance as compute_scale_covariance,
        has_own_lengths as has_own_lengths,
        scale_lengths as scale_lengths,
    )
    from calibgui.engine.calibration.result import (
        DEFAULT_METHOD as DEFAULT_METHOD,
        Assumption as Assumption,
        Calibration as Calibration,
        CalibrationSettings as CalibrationSettings,
        Cost as Cost,
        Degeneracy as Degeneracy,
        DegenerateError as DegenerateError,
        Diagnosis as Diagnosis,
        Iteration as Iteration,
        Report as Report,
        StageOne as StageOne,
        Status as Status,
        Undetermined as Undetermined,
        ViewResiduals as ViewResiduals,
    )

load_on_demand(
    __name__,
    {
        "board_poses": ["BoardPose", "locate_board"],
        "calibrate": ["calibrate"],
        "conversion": ["Conversion", "convert_camera", "find_followed_angle"],
        "held_camera": ["hold_camera"],
        "initialisation.single_view_pose": ["evaluate_cosines_equation"],
        "methods": ["METHODS", "check_method"],
        "methods.method": ["Method"],
        "observations": ["Observation", "make_observation"],
        "partial.degeneracy": ["find_copies", "is_in_one_spot"],
        "problem": ["is_held", "recover_arguments"],
        "refinement.covariances": ["compute_correlations", "make_paper_table"],
        "refit": ["Refit", "refit"],
        "result": [
            "DEFAULT_METHOD",
            "Assumption",
            "Calibration",
            "CalibrationSettings",
            "Cost",
            "Degeneracy",
            "DegenerateError",
            "Diagnosis",
            "Iteration",
            "Report",
            "StageOne",
            "Status",
            "Undetermined",
            "ViewResiduals",
        ],
        "scaling": ["compute_scale_covariance", "has_own_lengths", "scale_lengths"],
    },
)
