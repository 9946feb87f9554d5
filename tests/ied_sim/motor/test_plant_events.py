"""What happens to a simulated motor: starts, stops, warming, load cycles, supply events."""

from dataclasses import replace
from math import sqrt

import numpy as np
import pytest
from numpy.typing import NDArray

from ied_sim.monitoring.metering import meter
from ied_sim.monitoring.motor_monitor import MotorMonitor
from ied_sim.motor.contactor import Contactor
from ied_sim.motor.load import Load, LoadCycle
from ied_sim.motor.plant import MotorPlant, rated_current
from ied_sim.motor.supply import Supply, SupplyEvent
from ied_sim.motor.warming import ALUMINIUM_PER_K, COPPER_PER_K, Warming
from testing.machines.motors import REFERENCE
from tests.ied_sim.motor.plants import plant

RATE_HZ = 2_000.0


def rms(samples: NDArray[np.float64]) -> float:
    return float(np.sqrt(np.mean(samples**2)))


def switched(closed_s: float, opened_s: float | None = None) -> MotorPlant:
    """The reference motor, at rest until `closed_s`."""
    contactor = Contactor(open_at_first=True)
    assert contactor.close(closed_s) == closed_s
    if opened_s is not None:
        assert contactor.open(opened_s)
    return replace(plant(), contactor=contactor)


def test_a_window_across_the_closing_is_the_start_from_rest() -> None:
    window = switched(5.0).operation(4.9, 0.6, RATE_HZ)
    start = plant().start_up(5.0, 0.5, RATE_HZ)
    assert np.abs(window.currents_A[:, :200]).max() == 0
    assert window.currents_A[:, 200:] == pytest.approx(start.currents_A, abs=1e-6)
    assert window.speed_rad_s[200:] == pytest.approx(start.speed_rad_s, abs=1e-6)


def test_windows_of_a_start_agree_whatever_their_rate_and_begin() -> None:
    motor = switched(5.00013)
    whole = motor.operation(4.9, 0.4, 10_000.0).currents_A
    later = motor.operation(5.05, 0.2, 10_000.0).currents_A
    coarse = motor.operation(4.9, 0.4, 1_000.0).currents_A
    peak = np.abs(whole).max()
    assert peak > 5 * sqrt(2) * rated_current(REFERENCE) / 2
    assert np.abs(whole[:, 1500:3500] - later).max() < 1e-3 * peak
    assert np.abs(whole[:, ::10] - coarse).max() < 1e-3 * peak


def test_a_window_long_after_the_closing_is_steady_operation() -> None:
    late = switched(5.0).operation(30.0, 0.1, RATE_HZ).currents_A
    steady = plant().operation(30.0, 0.1, RATE_HZ).currents_A
    assert late == pytest.approx(steady, abs=1e-3)


def test_nothing_flows_once_it_is_opened() -> None:
    motor = switched(5.0, opened_s=6.0)
    window = motor.operation(5.95, 0.1, RATE_HZ)
    assert np.abs(window.currents_A[:, :100]).max() > 0.5
    assert np.abs(window.currents_A[:, 100:]).max() == 0
    assert rms(window.voltages_V[:, 100:]) == pytest.approx(380 / sqrt(3), rel=0.01)
    assert meter(motor, 7.0).current_A == 0


def test_a_contactor_is_closed_and_opened_once() -> None:
    contactor = Contactor()
    assert contactor.close(1.0) is None
    assert contactor.open(2.0)
    assert not contactor.open(3.0)
    assert contactor.close(4.0) == 4.0
    assert contactor.closure_at(3.0) is None
    assert [each.closed_s for each in contactor.closures(1.0, 5.0)] == [-np.inf, 4.0]


def test_a_start_is_seen_with_its_peak_and_its_length() -> None:
    motor = switched(5.0)
    monitor = MotorMonitor(motor, rated_current(REFERENCE))
    closure = monitor.closure(5.5)
    assert closure is not None
    start = monitor.start(closure)
    assert start.current_A.max() > 4 * rated_current(REFERENCE)
    assert start.duration_s is not None
    speed = motor.operation(5.0 + start.duration_s, 0.05, RATE_HZ).speed_rad_s
    assert speed.mean() > 0.9 * 2 * np.pi * 25
    assert monitor.measure(5.0 + 2.0).current_A == pytest.approx(1.203, rel=0.02)


def test_warm_windings_have_more_resistance() -> None:
    warming = Warming(rise_K=80.0, time_constant_s=600.0, begin_s=100.0)
    assert warming.factors(50.0, np.ones_like) == (1.0, 1.0)
    rise_K = 80 * (1 - np.exp(-1))
    assert warming.factors(700.0, np.ones_like) == pytest.approx(
        (1 + COPPER_PER_K * rise_K, 1 + ALUMINIUM_PER_K * rise_K)
    )
    warm = replace(plant(level=1.0), warming=Warming(80.0, 1.0, -1000.0))
    power_W = [meter(each, 100.0).complex_power_VA.real for each in (plant(level=1.0), warm)]
    assert power_W[1] > power_W[0]
    cold, hot = (each.circuit(100.0).resistance for each in (plant(), warm))
    assert hot[:2, :2] == pytest.approx(cold[:2, :2] * (1 + COPPER_PER_K * 80), rel=1e-6)
    assert hot[2:, 2:] == pytest.approx(cold[2:, 2:] * (1 + ALUMINIUM_PER_K * 80), rel=1e-6)


def test_a_load_cycle_repeats_in_straight_lines() -> None:
    cycle = LoadCycle(((0.0, 0.2), (10.0, 1.0), (10.1, 0.2)), 20.0)
    load = Load(0.5, cycle=cycle)
    assert load.levels(np.array([0.0, 5.0, 10.0, 15.0, 25.0, 205.0])) == pytest.approx(
        [0.2, 0.6, 1.0, 0.2, 0.6, 0.6]
    )
    currents_A = [meter(plant(load=load), time_s).current_A for time_s in (1.0, 9.9)]
    assert currents_A[1] > 1.1 * currents_A[0]


def test_a_dip_is_felt_by_its_phases_and_for_a_while_after() -> None:
    dip = SupplyEvent(at_s=2.0, duration_s=0.1, factor=0.5, phases=(0,))
    supply = Supply(380, 50, events=(dip,))
    window = plant(supply=supply).operation(1.9, 0.5, RATE_HZ)
    volts = window.voltages_V
    assert rms(volts[0, 200:400]) == pytest.approx(0.5 * rms(volts[0, :200]), rel=0.01)
    assert rms(volts[1, 200:400]) == pytest.approx(rms(volts[1, :200]), rel=0.01)
    assert np.abs(window.currents_A[:, 200:400]).max() > 2 * np.abs(window.currents_A[:, :200]).max()
    after = plant(supply=supply).operation(2.1, 0.3, RATE_HZ).currents_A
    # The steps of the two lie differently around the edges of the dip.
    assert after == pytest.approx(window.currents_A[:, 400:], abs=0.01 * np.abs(window.currents_A).max())


def test_events_come_again_and_are_remembered() -> None:
    event = SupplyEvent(10.0, 1.0, 0.0, every_s=60.0)
    times = np.array([9.0, 10.5, 11.5, 70.5, 71.5])
    assert event.under_way(times).tolist() == [False, True, False, True, False]
    supply = Supply(380, 50, events=(event,))
    assert supply.disturbed_since(72.0, 2.0) == 70.0
    assert supply.disturbed_since(75.0, 2.0) == 75.0
    assert supply.disturbed_since(5.0, 2.0) == 5.0
