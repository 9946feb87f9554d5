import numpy as np
import pytest
from scipy import signal

from core.signals.decimation import decimate


@pytest.mark.parametrize("factor", [1, 2, 3, 5, 12])
@pytest.mark.parametrize("samples", [1, 40, 5000, 5001])
def test_it_equals_scipys(factor: int, samples: int) -> None:
    x = np.random.default_rng(factor).standard_normal((2, samples))
    if factor == 1:
        assert decimate(x, factor) == pytest.approx(x, abs=1e-14)
        return
    assert decimate(x, factor) == pytest.approx(signal.decimate(x, factor, ftype="fir", axis=1), abs=1e-13)
