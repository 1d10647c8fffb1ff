"""The diagnosis of a partial calibration, as result.json holds it.

    {"kind", "message", "hint", "assumed": [{"name", "value", "sigma"}, ...]}

`kind` is one of ``Degeneracy``. `sigma` is one standard deviation of the error of an assumed value.
"""

from __future__ import annotations

from typing import Any

from calibgui.engine.calibration import Assumption, Degeneracy, Diagnosis
from calibgui.formats.node import Node


def encode_diagnosis(diagnosis: Diagnosis | None) -> dict[str, Any] | None:
    """Return the JSON object of a diagnosis; null for a whole calibration."""
    if diagnosis is None:
        return None
    return {
        "kind": diagnosis.kind,
        "message": diagnosis.message,
        "hint": diagnosis.hint,
        "assumed": [
            {"name": a.name, "value": a.value, "sigma": a.sigma} for a in diagnosis.assumptions
        ],
    }


def decode_diagnosis(node: Node | None) -> Diagnosis | None:
    """Return the diagnosis of a JSON object; None where an older result has none."""
    if node is None or node.value is None:
        return None
    return Diagnosis(
        Degeneracy(node["kind"].choice(list(Degeneracy))),
        node["message"].text(),
        node["hint"].text(),
        tuple(
            Assumption(n["name"].text(), n["value"].number(), n["sigma"].number())
            for n in node["assumed"].items()
        ),
    )
