"""The compiled models against phasors, against each other and against the thesis's figures."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from core.machines.base import StatorModel
from core.machines.candidates import Candidates
from core.machines.high_resistance import HighResistanceConnection
from core.machines.parameters import Connection, Motor
from core.machines.playback import Playback, electrical_to_rpm, window_of_record
from core.machines.shorted_winding import ShortedWinding
from core.machines.split_winding import SplitWinding
from core.machines.supply import Supply, supply
from core.signals.clarke import clarke
from testing.machines.motors import ALL, LARGE, MEDIUM, REFERENCE
from testing.machines.phase_circuits import Fault, Operation, running

Array = NDArray[np.float64]
MODELS: tuple[StatorModel, ...] = (ShortedWinding(), SplitWinding())
W_S = 2.0 * np.pi * 50.0
FIFTH, NEGATIVE = 0.02, 0.03


def voltage_at(motor: Motor, t: Array | float) -> Array:
    """A supply with unbalance and a fifth harmonic, in Clarke axes."""
    volts = motor.nameplate.rated_voltage_V
    angle = W_S * np.asarray(t)
    forward = np.array([np.cos(angle), np.sin(angle)])
    backward = NEGATIVE * np.array([np.cos(angle + 0.7), -np.sin(angle + 0.7)])
    fifth = FIFTH * np.array([np.cos(5 * angle), -np.sin(5 * angle)])
    return volts * (forward + backward + fifth)


def feed(motor: Motor, rate: float, samples: int, *, clean: bool = False) -> Supply:
    t = np.arange(samples) / rate
    volts = motor.nameplate.rated_voltage_V
    forward = volts * np.array([1.0 + 0.0j, -1.0j], dtype=np.complex128)
    if clean:
        return supply(volts * np.array([np.cos(W_S * t), np.sin(W_S * t)]), rate, 50.0, forward)
    phasor: NDArray[np.complex128] = forward + NEGATIVE * np.exp(0.7j) * forward.conj()
    return supply(voltage_at(motor, t), rate, 50.0, phasor)


def candidate(mu: float, winding: int, load: float, delay: float = 0.0) -> Candidates:
    one = np.ones(1)
    return Candidates(mu * one, np.array([winding]), load * one, delay * one)


@pytest.mark.parametrize(("load", "rpm", "amps"), [
    (0.0, 1500.0, 1.012), (0.25, 1480.7, 1.056), (0.5, 1460.4, 1.203), (0.75, 1438.6, 1.429),
    (1.0, 1415.2, 1.714),
])  # fmt: skip
def test_reference_machine_runs_as_its_equations_say(load: float, rpm: float, amps: float) -> None:
    playback = Playback(SplitWinding(), REFERENCE, feed(REFERENCE, 10_000.0, 1_000, clean=True),
                        window_of_record(1_000, 10_000.0, 50.0, 1.0))  # fmt: skip
    state = playback.steady_state(candidate(0.0, 0, load))
    assert electrical_to_rpm(state.mean_speed, 2)[0] == pytest.approx(rpm, abs=0.06)
    assert np.abs(state.current[0, 0]) / np.sqrt(3.0) == pytest.approx(amps, abs=6e-4)


@pytest.mark.parametrize(
    ("model", "expected"), [(MODELS[0], (1.486, 2.075, 1.883)), (MODELS[1], (1.542, 2.378, 1.619))]
)
def test_the_two_fault_models_differ_as_stated(
    model: StatorModel, expected: tuple[float, float, float]
) -> None:
    playback = Playback(model, REFERENCE, feed(REFERENCE, 10_000.0, 1_000, clean=True),
                        window_of_record(1_000, 10_000.0, 50.0, 1.0))  # fmt: skip
    current = playback.steady_state(candidate(0.1, 1, 0.5)).current[:, 0]
    inverse_clarke = np.sqrt(2 / 3) * np.array([[1, 0], [-0.5, np.sqrt(3) / 2], [-0.5, -np.sqrt(3) / 2]])
    assert np.abs(inverse_clarke @ current) / np.sqrt(2) == pytest.approx(expected, rel=1e-3)


@pytest.mark.parametrize("model", MODELS, ids=lambda model: model.name)
def test_no_fault_is_the_healthy_machine_and_small_faults_tend_to_it(model: StatorModel) -> None:
    playback = Playback(model, REFERENCE, feed(REFERENCE, 10_000.0, 1_500),
                        window_of_record(1_500, 10_000.0, 50.0, 1.0))  # fmt: skip
    levels = np.array([0.0, 1e-12, 1e-9, 1e-6, 1e-4])
    ones = np.ones(levels.size)
    track = playback.trajectories(Candidates(levels, np.ones(levels.size, np.int64), 0.5 * ones, 0.0 * ones))
    distance = np.abs(track.current - track.current[0]).max(axis=(1, 2))
    assert np.isfinite(track.current).all()
    assert (distance <= 40.0 * levels + 1e-9).all()
    assert distance[-1] > 1e-4


@pytest.mark.parametrize("motor", ALL, ids=lambda motor: motor.name)
@pytest.mark.parametrize("path", [0.0, 0.6])
def test_split_winding_agrees_with_phase_circuits_in_star_and_delta(motor: Motor, path: float) -> None:
    level, ratio = 0.08, path
    fault = Fault(level, 2, ratio * level * motor.parameters.stator_resistance_ohm)
    truth = running(motor, 0.5, fault=fault, unbalance=0.02)
    one = np.ones(1)
    candidates = Candidates(
        level / (1 + ratio) * one, np.array([2]), 0.5 * one, 0.0 * one, leakage=one / (1 + ratio)
    )
    assert_same_phasors(SplitWinding(), motor, truth, candidates)


@pytest.mark.parametrize("motor", ALL, ids=lambda motor: motor.name)
@pytest.mark.parametrize("winding", [0, 1, 2])
def test_high_resistance_agrees_with_phase_circuits_in_star_and_delta(motor: Motor, winding: int) -> None:
    level = 0.3
    joint = (winding, level * motor.parameters.stator_resistance_ohm)
    truth = running(motor, 0.7, unbalance=0.02, joint=joint)
    assert_same_phasors(HighResistanceConnection(), motor, truth, candidate(level, winding, 0.7))


def assert_same_phasors(model: StatorModel, motor: Motor, truth: Operation, candidates: Candidates) -> None:
    """Phasors of an independent three-phase circuit, zero sequence included; its speed has no ripple."""

    def axes(phasors: NDArray[np.complex128]) -> NDArray[np.complex128]:
        return np.asarray(clarke(phasors.real) + 1j * clarke(phasors.imag), dtype=np.complex128)

    voltage, current = axes(truth.phase_voltage), axes(truth.line_current)
    if motor.nameplate.connection is Connection.DELTA:
        turn = np.array([[np.sqrt(3) / 2, -0.5], [0.5, np.sqrt(3) / 2]])
        voltage, current = turn @ voltage * np.sqrt(3), turn @ current / np.sqrt(3)
    t = np.arange(1_000) / 10_000.0
    samples = np.sqrt(2) * np.real(voltage[:, np.newaxis] * np.exp(1j * W_S * t))
    heavy = replace(motor, parameters=replace(motor.parameters, inertia_kgm2=1e9))
    playback = Playback(model, heavy, supply(samples, 10_000.0, 50.0, np.sqrt(2) * voltage),
                        window_of_record(1_000, 10_000.0, 50.0, 1.0))  # fmt: skip
    state = playback.steady_state(candidates)
    arrival = np.exp(1j * W_S * playback.window.first / 10_000.0)
    assert state.current[:, 0] == pytest.approx(np.sqrt(2) * current * arrival, rel=1e-6)


def test_a_delay_of_the_sensors_delays_the_currents() -> None:
    playback = Playback(SplitWinding(), REFERENCE, feed(REFERENCE, 10_000.0, 3_000, clean=True),
                        window_of_record(3_000, 10_000.0, 50.0, 1.0))  # fmt: skip
    delays = np.array([0.0, 3e-4, 3.37e-4, -2.5e-4, 0.0199])
    ones = np.ones(delays.size)
    track = playback.trajectories(Candidates(0.05 * ones, np.ones(delays.size, np.int64), 0.5 * ones, delays))
    vectors = track.current[:, 0] + 1j * track.current[:, 1]
    turned = np.angle(
        np.mean(vectors[:, 400:2000] * np.exp(-1j * W_S * np.arange(400, 2000) / 10_000.0), axis=1)
    )
    expected = np.angle(np.exp(1j * (turned[0] - W_S * delays)))
    assert turned == pytest.approx(expected, abs=1e-5)


@pytest.mark.parametrize("rate", [600.0, 800.0, 1_600.0, 8_000.0, 50_000.0])
def test_the_sample_rate_does_not_move_the_currents(rate: float) -> None:
    """Against phasors, with a clean supply, after the start: 2e-4 at 12 samples a cycle, 2e-5 from 32 on."""
    samples = round(0.4 * rate)
    playback = Playback(SplitWinding(), MEDIUM, feed(MEDIUM, rate, samples, clean=True),
                        window_of_record(samples, rate, 50.0, 1.0))  # fmt: skip
    one = candidate(0.05, 2, 0.7)
    state, track = playback.steady_state(one), playback.trajectories(one)
    t = np.arange(track.current.shape[2]) / rate
    expected = np.real(state.current[:, 0, np.newaxis] * np.exp(1j * W_S * t))
    # Torque ripple of the faulted machine gives the currents a small third harmonic: fit both away.
    fundamental = np.mean((track.current[0, 0] + 1j * track.current[0, 1]) * np.exp(-1j * W_S * t)) - np.mean(
        (expected[0] + 1j * expected[1]) * np.exp(-1j * W_S * t)
    )
    assert abs(fundamental) / np.abs(state.current[0, 0]) < (3e-4 if rate < 1_600 else 5e-5)


def test_many_candidates_equal_one_by_one() -> None:
    playback = Playback(SplitWinding(), LARGE, feed(LARGE, 10_000.0, 1_200),
                        window_of_record(1_200, 10_000.0, 50.0, 1.0))  # fmt: skip
    rng = np.random.default_rng(1)
    n = 37
    batch = Candidates(
        rng.uniform(0, 0.2, n),
        rng.integers(0, 3, n),
        rng.uniform(0, 1, n),
        rng.uniform(0, 0.02, n),
        leakage=rng.uniform(0.1, 1.5, n),
        axis_rad=rng.uniform(-0.4, 0.4, n),
        linkage=np.array([1.03]),
    )
    measured = rng.standard_normal((2, 1_200))
    together = playback.squared_error(batch, measured)
    alone = [playback.squared_error(batch.part(slice(k, k + 1)), measured)[0] for k in range(n)]
    assert together == pytest.approx(alone, rel=1e-9)
    window = playback.window
    compared = playback.trajectories(batch).current[:, :, window.compare_from - window.first :]
    residual = compared - measured[:, window.compare_from : window.last]
    assert together == pytest.approx((residual**2).sum(axis=(1, 2)), rel=1e-9)


def test_one_place_holds_for_all_candidates_and_some_other_number_of_places_is_refused() -> None:
    three = np.ones(3)
    batch = Candidates(three, np.zeros(3, np.int64), three, three, axis_rad=np.array([0.1]))
    assert batch.axis_rad.tolist() == [0.1, 0.1, 0.1]
    assert batch.leakage.tolist() == batch.linkage.tolist() == [1.0, 1.0, 1.0]
    with pytest.raises(ValueError, match="broadcast"):
        Candidates(three, np.zeros(3, np.int64), three, three, leakage=np.ones(2))


def test_a_load_beyond_pull_out_has_no_steady_state() -> None:
    playback = Playback(SplitWinding(), REFERENCE, feed(REFERENCE, 10_000.0, 1_000, clean=True),
                        window_of_record(1_000, 10_000.0, 50.0, 1.0))  # fmt: skip
    assert not playback.steady_state(candidate(0.0, 0, 9.0)).balanced[0]
