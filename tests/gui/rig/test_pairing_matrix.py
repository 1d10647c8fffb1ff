"""The matrix of photographs says how well each instant fits."""

from __future__ import annotations

import numpy as np
import pytest
from pytestqt.qtbot import QtBot

from calibgui.app.rig.pairing import recall_pairing
from calibgui.gui.rig.pairing_matrix import PairingMatrix
from tests.formats.rigs import make_result


def test_instants_of_a_wide_rig_have_their_residuals(qtbot: QtBot) -> None:
    matrix = PairingMatrix()
    qtbot.addWidget(matrix)
    for count in (2, 4):
        result = make_result(count=count)
        pairing = recall_pairing(result)
        matrix.show_pairing(pairing, {}, result)
        for row, instant in enumerate(pairing.instants):
            header = matrix.verticalHeaderItem(row)
            assert header is not None
            views = [view for view in result.rig.views if view.instant == instant]
            residuals = np.concatenate([view.residuals for view in views])
            rms = np.sqrt(np.mean(np.sum(residuals**2, axis=1)))
            name, _, fit = header.text().partition("  ")
            assert name == f"{instant:04d}"
            assert (fit == "") == (count == 2)
            if fit:
                assert float(fit.removesuffix(" px")) == pytest.approx(rms, rel=0.05)
