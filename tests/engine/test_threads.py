"""BLAS has one thread, whichever part of SciPy has been loaded before."""

from __future__ import annotations

import subprocess
import sys


def test_the_blas_that_scipy_brings_along_is_limited_too() -> None:
    """In a process of its own, in which no part of SciPy is loaded yet."""
    code = (
        "import sys\n"
        "from threadpoolctl import threadpool_info\n"
        "from calibgui.engine.threads import limit_blas_threads\n"
        "assert 'scipy.linalg' not in sys.modules\n"
        "with limit_blas_threads():\n"
        "    import scipy.stats\n"
        "    assert {pool['num_threads'] for pool in threadpool_info()} == {1}\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
