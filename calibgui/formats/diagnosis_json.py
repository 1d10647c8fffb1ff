"""Why views do not determine a camera and what was assumed, as result.json holds it.

    {"kind", "message", "hint", "assumed": [{"name", "value", "sigma"}, ...]}

`kind` is one of ``Degeneracy``. `sigma` is one standard deviation of what a value may be off by.
"""

from __future__ import annotations

from typing import Any

from calibgui.engine.calibration import Assumed, Degeneracy, Diagnosis
from calibgui.formats.json_document import Node


def diagnosis_record(diagnosis: Diagnosis | None) -> dict[str, Any] | None:
    """A diagnosis as a result holds it; null for a whole calibration."""
    if diagnosis is None:
        return None
    return {
        "kind": diagnosis.kind,
        "message": diagnosis.message,
        "hint": diagnosis.hint,
        "assumed": [
            {"name": a.name, "value": a.value, "sigma": a.doubt} for a in diagnosis.assumed
        ],
    }


def read_diagnosis(node: Node | None) -> Diagnosis | None:
    """The inverse of `diagnosis_record`; None for older results, which have none."""
    if node is None or node.value is None:
        return None
    return Diagnosis(
        Degeneracy(node["kind"].choice(list(Degeneracy))),
        node["message"].text(),
        node["hint"].text(),
        tuple(
            Assumed(n["name"].text(), n["value"].number(), n["sigma"].number())
            for n in node["assumed"].items()
        ),
    )
