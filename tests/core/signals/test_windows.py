import pytest
from scipy.signal.windows import tukey

from core.signals.windows import tukey_window


@pytest.mark.parametrize("samples", [2, 3, 50, 4999, 5000])
@pytest.mark.parametrize("tapered", [0.01, 0.25, 0.5, 1.0])
def test_it_equals_scipys(samples: int, tapered: float) -> None:
    assert tukey_window(samples, tapered) == pytest.approx(tukey(samples, tapered), abs=1e-13)
