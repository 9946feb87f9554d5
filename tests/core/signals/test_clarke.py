import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from core.signals import clarke, clarke_from_line_voltages, inverse_clarke
from tests.core.signals.waveforms import three_phase

volts = st.floats(-1e4, 1e4, allow_subnormal=False)
two_by_n = arrays(np.float64, st.tuples(st.just(2), st.integers(1, 20)), elements=volts)
three_by_n = arrays(np.float64, st.tuples(st.just(3), st.integers(1, 20)), elements=volts)


@given(two_by_n)
def test_there_and_back_again(x_ab: np.ndarray) -> None:
    np.testing.assert_allclose(clarke(inverse_clarke(x_ab)), x_ab, atol=1e-9)


@given(three_by_n)
def test_phases_come_back_without_their_zero_sequence(x_abc: np.ndarray) -> None:
    np.testing.assert_allclose(inverse_clarke(clarke(x_abc)), x_abc - x_abc.mean(axis=0), atol=1e-8)


@given(two_by_n, st.data())
def test_power_is_the_same_in_both_frames(v_ab: np.ndarray, data: st.DataObject) -> None:
    i_ab = data.draw(arrays(np.float64, v_ab.shape, elements=volts))
    power = np.sum(inverse_clarke(v_ab) * inverse_clarke(i_ab), axis=0)
    np.testing.assert_allclose(power, np.sum(v_ab * i_ab, axis=0), atol=1e-6)


@given(three_by_n)
def test_line_voltages_give_what_phase_voltages_give(v_abc: np.ndarray) -> None:
    v_line = v_abc - np.roll(v_abc, -1, axis=0)
    np.testing.assert_allclose(clarke_from_line_voltages(v_line), clarke(v_abc), atol=1e-8)


def test_a_balanced_set_turns_on_a_circle_of_sqrt_3_times_its_rms() -> None:
    v_ab = clarke(three_phase(230.0))
    assert np.hypot(v_ab[0], v_ab[1]) == pytest.approx(np.full(5_000, np.sqrt(3) * 230))
    assert v_ab[:, 0] == pytest.approx([np.sqrt(3) * 230, 0], abs=1e-9)
    assert v_ab[:, 50] == pytest.approx([0, np.sqrt(3) * 230], abs=1e-9), "a quarter period: alpha to beta"
