"""Pitfalls of judging a motor over time, each with the records that show who has walked into it.

Two that take a machine of its own, saturation and deep bars, are in tests/benchmarks/condition.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import pytest

from core.condition.assessment import Assessment
from core.condition.changes.hypotheses import Cause, hypotheses_of
from core.condition.events import Event, EventKind
from core.condition.filter.kalman import predict
from core.condition.filter.state import FILTER
from core.condition.following.follower import Follower
from core.condition.kinds import Kind, State
from core.condition.observation import Observation, VoltageChannels
from core.condition.verdict.condition import Condition
from core.condition.verdict.judging import condition_of
from core.machines.parameters import Connection
from core.signals.sequence import PhaseSequence
from tests.core.condition.simulated import HOUR_NS, PARAMETERS, Z2, Plant, follow, motor_of

BEFORE = 60


def assessed(follower: Follower) -> Assessment:
    assessment = follower.assessment()
    assert assessment is not None
    return assessment


def told(follower: Follower, plant: Plant) -> Condition:
    return condition_of(follower.motor, follower.assessment(), plant.time_ns)


def greatest_statistic(records: Sequence[Observation]) -> float:
    """The detector's statistic at its greatest, over its threshold."""
    follower, greatest = Follower(motor_of()), 0.0
    for record in records:
        follower.fold(record)
        assessment = assessed(follower)
        greatest = max(greatest, assessment.statistic / assessment.threshold)
    return greatest


@dataclass
class WarmingPlant(Plant):
    """A winding that warms and cools within hours."""

    warmth: float = 0.0

    def backward_impedance(self) -> complex:
        kept = np.exp(-1.0 / 3.0)
        self.warmth = kept * self.warmth + np.sqrt(1.0 - kept**2) * 0.08 * self.random.normal()
        return Z2 + abs(Z2) * self.warmth


# Temperature rho too high: false alarms.


@pytest.mark.parametrize("seed", [0, 3, 4])
def test_temperature_rho_too_high_takes_warm_hours_for_a_change(seed: int) -> None:
    plant = WarmingPlant(seed=seed, unbalance=0.002 + 0j, supply_swing=0.001)
    records = plant.records(100)
    plant.unbalance = 0.04 + 0j
    # Where it is forgotten too slowly, half of the threshold is reached at once.
    assert greatest_statistic(records + plant.records(40)) < 0.25


@pytest.mark.parametrize(("hours", "least", "most"), [(1.0, 0.6, 0.8), (24.0, 0.0, 0.3)])
def test_temperature_rho_is_that_of_hours(hours: float, least: float, most: float) -> None:
    state = np.zeros(1, FILTER).view(np.recarray)[0]
    assert least <= predict(state, 3600.0 * hours) <= most


# Starting noise too small: motors cross the threshold.


def test_starting_noise_too_small_raises_alarms_where_no_single_record_shows_the_noise() -> None:
    for seed in range(4):
        plant = Plant(noise=2e-3, seed=seed)
        records = [replace(one, scatter=1e-10) for one in plant.records(100)]
        assert greatest_statistic(records) < 1.0


def test_noise_ten_times_that_of_measured_motors_raises_no_alarm() -> None:
    assert greatest_statistic(Plant(noise=2e-3).records(300)) < 1.0


# An outlier as first record fakes a change: the first eight are sorted.


@pytest.mark.parametrize("first", [0, 3])
def test_an_outlier_among_the_first_records_fakes_no_change(first: int) -> None:
    plant = Plant()
    records = plant.records(first)
    plant.noise = 2e-2
    records += plant.records(1)
    plant.noise = 2e-4
    assert greatest_statistic(records + plant.records(60)) < 1.0


@pytest.mark.parametrize("seed", range(2))
def test_an_outlier_as_first_record_does_not_pass_for_noise_either(seed: int) -> None:
    plant = Plant(seed=seed, level=0.01)
    records = plant.records(1)
    plant.level = 0.0
    records += plant.records(60)
    usual, with_outlier = (assessed(follow(motor_of(), one)).reference for one in (records[1:], records))
    assert usual.detectable is not None
    assert with_outlier.detectable == pytest.approx(usual.detectable, rel=0.3)


# I0 and V0 not regressed: faults are named current channel, and a supply that jumps a voltage channel.


@pytest.mark.parametrize("seed", range(2))
def test_I0_not_regressed_on_I2_would_name_shorted_turns_a_current_channel(seed: int) -> None:
    current = [1.008 + 0.008j, 0.992 + 0j, 0.995 - 0.008j]
    plant = Plant(seed=seed, noise=2e-5, supply_swing=0.01, current=current)
    follower = follow(motor_of(), plant.records(BEFORE))
    plant.level, plant.path = 0.03, 0.0
    for record in plant.records(12):
        follower.fold(record)
    change = assessed(follower).change
    assert change is not None
    assert change.probabilities[Kind.CURRENT_CHANNEL] < 1e-6
    assert told(follower, plant).state is State.FAULT


def test_V0_not_regressed_on_V2_would_find_a_supply_s_jump_in_a_voltage_channel() -> None:
    plant = Plant(supply_swing=0.004)
    follower = follow(motor_of(), plant.records(BEFORE))
    plant.unbalance = -0.03 + 0.02j
    plant.level = 0.01
    for record in plant.records(12):
        follower.fold(record)
    change = assessed(follower).change
    assert change is not None
    assert change.probabilities[Kind.VOLTAGE_CHANNEL] < 0.01
    assert Kind.SHORTED_TURNS in change.named


# Steps alone take a slow drift for a late step: ramps, and a window of 64 records.


@pytest.mark.parametrize("seed", range(2))
def test_steps_alone_would_take_a_slow_growth_for_a_late_step(seed: int) -> None:
    plant = Plant(seed=seed)
    follower = follow(motor_of(), plant.records(BEFORE))
    for k in range(100):
        plant.level = 1e-4 * k
        follower.fold(plant.record())
    assessment = assessed(follower)
    assert assessment.change is not None
    assert Kind.SHORTED_TURNS in assessment.change.named
    assert assessment.change.level.value == pytest.approx(0.01, abs=0.002)
    times = [time for time, _ in assessment.levels]
    assert times == sorted(times)
    assert assessment.levels[-1][1] > assessment.levels[0][1] + 0.004


@pytest.mark.parametrize("seed", range(2))
def test_steps_alone_would_date_a_slow_drift_of_a_voltage_channel_too_late(seed: int) -> None:
    plant = Plant(seed=seed)
    follower = follow(motor_of(), plant.records(BEFORE))
    first = plant.time_ns
    for k in range(64):
        plant.voltage[2] = 1.001 + 0.0003 * k
        follower.fold(plant.record())
    change = assessed(follower).change
    assert change is not None
    assert change.named == (Kind.VOLTAGE_CHANNEL,)
    assert change.channel == 2
    assert change.since_ns - first < 16 * HOUR_NS


# A suspected drift of a voltage channel is never taken off without a bus or a person: it may be the fault.


@pytest.mark.parametrize("what", ["growing fault", "drifting channel"])
def test_a_suspected_drift_of_a_voltage_channel_is_never_taken_off(what: str) -> None:
    plant = Plant(with_zero_voltage=False, supply_swing=0.02)
    follower = follow(motor_of(), plant.records(BEFORE))
    states = []
    for k in range(150):
        grown = min(k / 60, 1.0)
        if what == "growing fault":
            plant.level = 0.006 * grown
        else:
            plant.voltage[0] = 1.004 - 0.015 * grown
        follower.fold(plant.record())
        states.append(told(follower, plant).state)
    seen = states.index(State.WATCH)
    assert seen < 60
    assert State.HEALTHY not in states[seen:]
    if what == "growing fault":
        interval = told(follower, plant).mu_f_ci95
        assert interval is not None
        assert interval[1] > 0.006


def test_a_drift_that_was_named_stays_told_until_a_person_knows_better() -> None:
    plant = Plant()
    follower = follow(motor_of(), plant.records(BEFORE))
    for k in range(220):
        plant.voltage[2] = 1.001 + 0.0005 * min(k, 30)
        follower.fold(plant.record())
    condition = told(follower, plant)
    assert (condition.state, condition.kind, condition.phase) == (State.WATCH, Kind.VOLTAGE_CHANNEL, "c")
    follower.apply(Event(plant.time_ns, EventKind.MAINTENANCE, "fuse of the voltage transformer replaced"))
    for record in plant.records(12):
        follower.fold(record)
    assert told(follower, plant).state is State.HEALTHY


# A direction tolerance on every signature: motors are never just as their files say.


@pytest.mark.parametrize("connection", Connection)
@pytest.mark.parametrize("channels", VoltageChannels)
def test_every_signature_has_a_direction_tolerance(connection: Connection, channels: VoltageChannels) -> None:
    hypotheses = hypotheses_of(motor_of(connection), PhaseSequence.ABC, channels, 25.0)
    assert {Cause(one) for one in hypotheses["cause"]} == {one for one in Cause if one < Cause.IMPEDANCE}
    assert hypotheses["direction"].min() >= 0.02
    of_channels = np.isin(hypotheses["cause"], [Cause.VOLTAGE_CHANNEL, Cause.CURRENT_CHANNEL])
    assert hypotheses["direction"][of_channels].tolist() == [0.12] * int(of_channels.sum())


@pytest.mark.parametrize("turn", [-0.2, 0.2])
def test_a_channel_that_errs_in_phase_too_is_named_all_the_same(turn: float) -> None:
    plant = Plant()
    follower = follow(motor_of(), plant.records(BEFORE))
    plant.voltage[1] *= 1.0 + 0.02 * np.exp(1j * turn)
    for record in plant.records(30):
        follower.fold(record)
    change = assessed(follower).change
    assert change is not None
    assert (change.named, change.channel) == ((Kind.VOLTAGE_CHANNEL,), 1)
    assert told(follower, plant).state is State.WATCH


@pytest.mark.parametrize("figure", ["stator_resistance_ohm", "stator_leakage_H"])
@pytest.mark.parametrize("ratio", [0.8, 1.25])
@pytest.mark.parametrize("path", [0.0, 3.0])
def test_shorted_turns_of_a_motor_whose_file_is_off_are_named_in_their_phase(
    figure: str, ratio: float, path: float
) -> None:
    plant = Plant(path=path)
    filed = replace(PARAMETERS, **{figure: ratio * getattr(PARAMETERS, figure)})
    follower = follow(replace(motor_of(), parameters=filed), plant.records(BEFORE))
    plant.level, plant.winding = 0.015, 1
    for record in plant.records(20):
        follower.fold(record)
    condition = told(follower, plant)
    assert (condition.state, condition.phase) == (State.FAULT, "b")
