import pytest
from scipy import stats

from core.diagnosis.student_t import student_t_quantile


@pytest.mark.parametrize("degrees_of_freedom", [*range(1, 12), 19, 48, 59, 60, 1000])
@pytest.mark.parametrize("probability", [0.6, 0.9, 0.975, 0.9995])
def test_it_equals_scipys(probability: float, degrees_of_freedom: int) -> None:
    expected = float(stats.t.ppf(probability, degrees_of_freedom))
    assert student_t_quantile(probability, degrees_of_freedom) == pytest.approx(expected, rel=1e-11)
