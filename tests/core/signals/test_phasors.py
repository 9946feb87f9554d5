from math import pi, sqrt

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.signals import SignalError, clarke, fundamental_frequency, fundamental_phasors, harmonic_phasors
from tests.core.signals.waveforms import three_phase

phasor = st.builds(
    lambda magnitude, angle: complex(magnitude * np.exp(1j * angle)), st.floats(0.1, 1e4), st.floats(-pi, pi)
)
MILLIHERTZ = 1e-3


@given(phasor, st.floats(45, 65), st.integers(150, 2_000), st.floats(-100, 100))
def test_a_sine_gives_its_phasor_whatever_part_of_a_cycle_and_offset(
    x: complex, frequency_hz: float, samples: int, offset: float
) -> None:
    t = np.arange(samples) / 10_000
    wave = sqrt(2) * abs(x) * np.cos(2 * pi * frequency_hz * t + np.angle(x)) + offset
    found = fundamental_phasors(wave, frequency_hz, 10_000)
    assert found == pytest.approx(x, abs=1e-6 * max(abs(x), 1))


def test_phasors_of_many_rows_keep_their_shape() -> None:
    x_abc = three_phase(10 + 5j, 1j)
    a = np.exp(2j * pi / 3)
    found = fundamental_phasors(x_abc, 50, 10_000)
    expected = [10 + 5j + 1j, (10 + 5j) / a + 1j * a, (10 + 5j) * a + 1j / a]
    assert found == pytest.approx(expected)
    assert harmonic_phasors(x_abc, 50, 10_000, (1, 5, 7)).shape == (3, 3)


def test_named_harmonics_are_told_apart_in_a_record_of_one_and_a_half_cycles() -> None:
    x_abc = three_phase(100, 3, harmonics={-5: 4j, 7: 2}, samples=300)
    found = harmonic_phasors(x_abc[0], 50, 10_000, (1, 5, 7))
    assert found == pytest.approx([103, 4j, 2])


def test_phasors_refuse_what_they_cannot_tell() -> None:
    with pytest.raises(SignalError, match="2 samples"):
        fundamental_phasors(np.ones(2), 50, 10_000)
    with pytest.raises(SignalError, match="missing values"):
        fundamental_phasors(np.array([1.0, np.nan, 1.0, 2.0]), 50, 10_000)
    with pytest.raises(SignalError, match="told apart"):
        harmonic_phasors(np.ones(100), 50, 1_000, (1, 21))


@settings(max_examples=30, deadline=None)
@given(
    frequency_hz=st.floats(45, 65),
    positive=phasor,
    unbalance=st.floats(0, 0.5),
    angle=st.floats(-pi, pi),
    acb=st.booleans(),
    samples=st.integers(5_000, 6_000),
)
def test_half_a_second_without_noise_gives_the_frequency_to_a_microhertz(
    *, frequency_hz: float, positive: complex, unbalance: float, angle: float, acb: bool, samples: int
) -> None:
    negative = unbalance * positive * np.exp(1j * angle)
    harmonics = {-5: 0.05 * positive, 7: 0.03 * positive, 3: 0.02 * positive, -11: 0.01 * positive}
    supply = (negative, positive) if acb else (positive, negative)
    v_abc = three_phase(*supply, frequency_hz=frequency_hz, harmonics=harmonics, samples=samples)
    assert fundamental_frequency(clarke(v_abc), 10_000) == pytest.approx(frequency_hz, abs=1e-6)


def test_harmonics_outside_the_model_cost_less_than_a_millihertz() -> None:
    v_abc = three_phase(230, 5, frequency_hz=50.03, harmonics={-2: 2, 4: 1, -17: 3, 19: 3}, samples=5_000)
    assert fundamental_frequency(clarke(v_abc), 10_000) == pytest.approx(50.03, abs=MILLIHERTZ)


@pytest.mark.parametrize("samples", [1_000, 5_000, 10_000])
def test_under_noise_the_estimate_reaches_the_cramer_rao_bound(samples: int) -> None:
    """Noise 20 dB below the voltages; no bias, and a spread at most half above the bound.

    The bound of a rotating vector of amplitude A in complex noise of variance s2 is
    var(f) >= 6 s2 / (A^2 n^3) (fs / 2 pi)^2.
    """
    rng = np.random.default_rng(7)
    rms, sample_rate_hz = 230.0, 10_000.0
    sigma = rms * 10 ** (-20 / 20)
    v_abc = three_phase(rms, frequency_hz=49.91, samples=samples)
    errors = np.array(
        [
            fundamental_frequency(clarke(v_abc + sigma * rng.standard_normal(v_abc.shape)), sample_rate_hz)
            - 49.91
            for _ in range(60)
        ]
    )
    amplitude = sqrt(3) * rms
    bound_hz = sqrt(6 * 2 * sigma**2 / amplitude**2 / samples**3) * sample_rate_hz / (2 * pi)
    assert errors.std() < 1.5 * bound_hz
    assert abs(errors.mean()) < 4 * bound_hz / sqrt(60)


def test_a_relay_of_16_samples_a_cycle_is_enough() -> None:
    v_abc = three_phase(230, 4, frequency_hz=60.02, sample_rate_hz=960, samples=240, harmonics={-5: 5, 7: 3})
    assert fundamental_frequency(clarke(v_abc), 960) == pytest.approx(60.02, abs=MILLIHERTZ)


def test_a_single_phase_is_still_a_frequency() -> None:
    v_ab = clarke(three_phase(100, 100, frequency_hz=50.4))
    assert fundamental_frequency(v_ab, 10_000) == pytest.approx(50.4, abs=MILLIHERTZ)


@pytest.mark.parametrize(
    ("v_ab", "reason"),
    [
        (np.zeros((2, 5_000)), "is the supply connected"),
        (clarke(three_phase(50, harmonics={8: 100})), "20% of the voltages' energy"),
        (clarke(three_phase(230, samples=200)), "cycles"),
        (np.full((2, 5_000), np.nan), "missing values"),
    ],
    ids=["dead", "mostly 400 Hz", "one cycle", "missing"],
)
def test_no_frequency_where_there_is_none(v_ab: np.ndarray, reason: str) -> None:
    with pytest.raises(SignalError, match=reason):
        fundamental_frequency(v_ab, 10_000)


@pytest.mark.parametrize("seed", range(10))
def test_noise_has_no_frequency(seed: int) -> None:
    noise = np.random.default_rng(seed).standard_normal((2, 2_000))
    with pytest.raises(SignalError, match=r"settle|energy"):
        fundamental_frequency(noise, 10_000)


def test_a_frequency_near_half_the_sampling_rate_is_refused() -> None:
    with pytest.raises(SignalError, match="samples a cycle"):
        fundamental_frequency(clarke(three_phase(230, frequency_hz=59, sample_rate_hz=130, samples=500)), 130)


def test_a_voltage_that_changes_its_frequency_is_no_fundamental() -> None:
    v_ab = np.concatenate(
        [clarke(three_phase(230, frequency_hz=40)), -clarke(three_phase(231, frequency_hz=60))], axis=1
    )
    with pytest.raises(SignalError):
        fundamental_frequency(v_ab, 10_000)
