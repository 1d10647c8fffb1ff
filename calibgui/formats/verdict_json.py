"""A verdict with its findings, as result.json and project files hold it.

    verdict     grade, reason, times_better (that of the first finding), error_px (of a pixel: at
                the centre, covered by corners, along the edge, worst, worst_covered, median; null
                where it is not known), mm_per_px, distance_mm
    findings    cause, message, evidence, remedy, harm_px, views (their images), action (kind,
                views, parameters, model), times_better

Cannot hold: the camera without a cause (``Finding.without``), which only judging takes.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from calibgui.dataset import Result
from calibgui.engine.assessment import (
    Action,
    ActionKind,
    Cause,
    Finding,
    Grade,
    PixelError,
    Verdict,
)
from calibgui.formats.node import Node

_ERRORS = ("centre", "covered", "edge", "worst", "worst_covered", "median")


def encode_verdict(verdict: Verdict, result: Result) -> dict[str, Any]:
    """Return the verdict on a result, and the findings."""
    names = [view.image for view in result.used]
    return {
        "verdict": {
            "grade": verdict.grade,
            "reason": verdict.reason,
            "times_better": verdict.times_better,
            "error_px": {name: getattr(verdict.error, name) for name in _ERRORS},
            "mm_per_px": verdict.mm_per_pixel,
            "distance_mm": verdict.distance,
        },
        "findings": [_encode_finding(finding, names) for finding in verdict.findings],
    }


def _encode_finding(finding: Finding, names: Sequence[str]) -> dict[str, Any]:
    return {
        "cause": finding.cause,
        "message": finding.message,
        "evidence": finding.evidence,
        "remedy": finding.remedy,
        "harm_px": finding.harm,
        "views": [names[k] for k in finding.views],
        "action": None if finding.action is None else _encode_action(finding.action, names),
        "times_better": finding.times_better,
    }


def _encode_action(action: Action, names: Sequence[str]) -> dict[str, Any]:
    return {
        "kind": action.kind,
        "views": [names[k] for k in action.views],
        "parameters": action.parameters,
        "model": action.model or None,
    }


def decode_verdict(node: Node, result: Result) -> Verdict:
    """Return the verdict on a result.

    Raises:
        CalibrationError: if something in it is wrong; the message names the place.
    """
    names = [view.image for view in result.used]
    verdict = node["verdict"]
    return Verdict(
        Grade(verdict["grade"].choice(list(Grade))),
        verdict["reason"].text(),
        _decode_error(verdict["error_px"]),
        verdict["mm_per_px"].number(nullable=True),
        verdict["distance_mm"].number(nullable=True),
        tuple(_decode_finding(finding, names) for finding in node["findings"].items()),
    )


def _decode_error(node: Node) -> PixelError:
    """Return the error of pixels: where none is known the camera is not determined."""
    values = {name: node[name].number(nullable=True) for name in _ERRORS}
    if np.isnan(list(values.values())).all():
        values = dict.fromkeys(_ERRORS, np.inf)
    return PixelError(**values)


def _decode_finding(node: Node, names: Sequence[str]) -> Finding:
    action = node["action"]
    return Finding(
        Cause(node["cause"].choice(list(Cause))),
        node["message"].text(),
        node["evidence"].text(),
        node["remedy"].text(),
        node["harm_px"].number(nullable=True),
        _decode_views(node["views"], names),
        None if action.value is None else _decode_action(action, names),
        node["times_better"].number(nullable=True),
    )


def _decode_action(node: Node, names: Sequence[str]) -> Action:
    model = node["model"]
    return Action(
        ActionKind(node["kind"].choice(list(ActionKind))),
        _decode_views(node["views"], names),
        tuple(name.text() for name in node["parameters"].items()),
        "" if model.value is None else model.text(),
    )


def _decode_views(node: Node, names: Sequence[str]) -> tuple[int, ...]:
    return tuple(names.index(image.choice(names)) for image in node.items())
