"""Text about a camera that varies with zoom, focus or temperature, or drifts with time."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from calibgui.dataset import LeftOut
from calibgui.engine.assessment import SPLINE, Drift, Series, UncertainCamera
from calibgui.engine.numbers import format_two_digits
from calibgui.report.numbers import format_with_sigma
from calibgui.report.tables import align_columns, format_bullet

_PARAMETERS_IN_ROW = 3
"""Number of parameters that fit beside each other in a terminal of 80 columns."""
_MIN_TOLD_PROBABILITY = 1e-4
"""The least probability that is told as it is: no model of the errors is true beyond."""


def tabulate_settings(
    series: Series,
    values: Sequence[str],
    drifts: Sequence[Drift],
    scalar: str,
    left_out: Sequence[str] = (),
) -> str:
    """Tabulate the parameters of all settings, and how far each camera is from the first.

    Args:
        series: the series.
        values: words for the value of each setting.
        drifts: the differences from the first setting, of all but the first; none to say nothing.
        scalar: name of the quantity that varies.
        left_out: words for the values of the settings that are left out, which stand last.
    """
    names = _list_free(series.settings[0].known)
    tables = []
    for k in range(0, len(names), _PARAMETERS_IN_ROW):
        listed = names[k : k + _PARAMETERS_IN_ROW]
        rows = [
            [value, *_format_parameters(setting.known, listed)]
            for value, setting in zip(values, series.settings, strict=True)
        ]
        rows += [[value, *["left out"] * len(listed)] for value in left_out]
        tables.append(align_columns([[scalar, *listed], *rows], left=(0,)))
    if drifts:
        rows = [
            [value, f"{drift.difference.rms:.3f}", f"{drift.expected:.3f}", f"{p:#.2g}"]
            for value, drift, p in zip(
                values[1:], drifts, [drift.probability for drift in drifts], strict=True
            )
        ]
        head = [scalar, "from the first, px rms", "explained, px", "probability if unchanged"]
        tables.append(align_columns([head, *rows], left=(0,)))
    return "\n\n".join(tables)


def tabulate_functions(series: Series) -> str:
    """Tabulate the errors of all functions on unseen settings."""
    rows = [
        [_name_function(name), f"{error:.3g}", "taken" if name == series.function else ""]
        for name, error in series.errors.items()
    ]
    head = ["function", "error on unseen settings, px rms", ""]
    return align_columns([head, *rows], left=(0, 2))


def describe_series(
    series: Series, drifts: Sequence[Drift], left_out: Sequence[LeftOut] = ()
) -> str:
    """Describe for a terminal what `list_sentences` lists."""
    sentences = list_sentences(series, drifts, [(one.file, one.reason) for one in left_out])
    return "\n".join(map(format_bullet, sentences))


def list_sentences(
    series: Series, drifts: Sequence[Drift], left_out: Sequence[tuple[str, str]] = ()
) -> list[str]:
    """List sentences on how well the function follows, and whether the camera has changed.

    Args:
        series: the series.
        drifts: the differences from the first setting, of all but the first; none to say nothing.
        left_out: names of the results that are left out, each with the reason.
    """
    return [
        *_judge_function(series),
        *_judge_changes(drifts),
        *(
            f"{name} is left out, as its photographs do not determine the camera. {reason}"
            for name, reason in left_out
        ),
    ]


def _judge_function(series: Series) -> list[str]:
    """Say how well the function of the setting predicts settings that it has not seen."""
    name, error = _name_function(series.function), series.errors[series.function]
    sentences = [
        f"{name[0].upper()}{name[1:]} describes the camera: at settings that it has not seen it is "
        f"off by {error:.2g} px rms."
    ]
    if series.inflation > 1:
        sentences.append(
            f"That is {np.sqrt(series.inflation):.1f} times what the calibrations' "
            "uncertainties explain; every ± between settings includes it."
        )
    return sentences


def _judge_changes(drifts: Sequence[Drift]) -> list[str]:
    """Say how many cameras differ from the first, and by how much."""
    if not drifts:
        return []
    changed = [drift for drift in drifts if drift.has_changed]
    if not changed:
        return ["No camera differs from the first by more than their uncertainties explain."]
    most = max(drift.difference.rms for drift in changed)
    return [
        f"{len(changed)} of {len(drifts)} cameras differ from the first by more than their "
        f"uncertainties explain, by up to {most:.2g} px rms."
    ]


def tabulate_camera_at(known: UncertainCamera, value: str) -> str:
    """Tabulate the camera at a value of the scalar."""
    names = _list_free(known)
    rows = [[n, text] for n, text in zip(names, _format_parameters(known, names), strict=True)]
    return f"At {value}, each value ± one standard deviation\n" + align_columns(rows, left=(0, 1))


def describe_drift(drift: Drift, limit: float | None) -> str:
    """Describe whether a camera has changed, and by how much against a limit, px."""
    found = drift.difference
    by = f"{format_two_digits(found.rms)} px rms, {format_two_digits(found.worst)} px at most"
    if drift.has_changed:
        least = _MIN_TOLD_PROBABILITY
        chance = f"{drift.probability:.2g}" if drift.probability > least else f"less than {least:g}"
        text = (
            "The two differ by more than their uncertainties explain (the camera has changed, or a "
            f"lens model does not follow the lens), by {by}: calibrations of an unchanged camera "
            f"differ as much with a probability of {chance}."
        )
    else:
        text = (
            f"The camera cannot be told from an unchanged one: the two differ by {by}, and their "
            f"uncertainties explain {drift.expected:.2g} px rms."
        )
    if limit is None:
        return text
    if has_drifted(drift, limit):
        return f"{text} The limit of {limit:g} px is exceeded."
    return f"{text} The limit of {limit:g} px is kept."


def has_drifted(drift: Drift, limit: float) -> bool:
    """Return whether a camera has changed by more than a limit, px, somewhere in the image."""
    return drift.has_changed and drift.difference.worst > limit


def _list_free(known: UncertainCamera) -> list[str]:
    """List the names of the parameters that are estimated."""
    sigma = np.diag(known.covariance)
    return [name for name, s in zip(known.camera.names, sigma, strict=True) if s > 0]


def _format_parameters(known: UncertainCamera, names: Sequence[str]) -> list[str]:
    sigma = np.sqrt(np.diag(known.covariance))
    index = [known.camera.names.index(name) for name in names]
    return [format_with_sigma(float(known.camera.params[i]), float(sigma[i])) for i in index]


def _name_function(name: str) -> str:
    """Return words for a function."""
    words = {
        SPLINE: "a monotone spline",
        "degree 0": "a constant",
        "degree 1": "a straight line",
    }
    return words.get(name, f"a polynomial of {name}")
