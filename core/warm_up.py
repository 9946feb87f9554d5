"""Compile the numbers' inner loops once, so that nothing waits for them: python -m core.warm_up."""

from dataclasses import fields
from functools import cache

import numpy as np

from core.condition.following.follower import Follower
from core.condition.forecast.forecast import forecast
from core.condition.observation import Observation, VoltageChannels
from core.diagnosis.estimates import estimates_of
from core.diagnosis.record_figures import RecordFigures
from core.diagnosis.stator_evidence import weigh_stator
from core.machines.candidates import Candidates
from core.machines.coil_fault import SequencePair, air_gap, faulty_currents
from core.machines.deep_bar_starts import DeepBarCandidates, DeepBarStartPlayback
from core.machines.parameters import MachineParameters, Motor, Nameplate
from core.machines.playback import Playback, window_of_record
from core.machines.split_winding import SplitWinding
from core.machines.starting import start_candidate
from core.machines.supply import Supply, supply
from core.signals.sequence import PhaseSequence
from core.units import NANOSECONDS_PER_DAY

FOLLOWED = 40
"""Records that are followed."""


@cache
def warm_up() -> None:
    """Run a few cycles, and a few records, of the thesis's motor through every compiled function, once."""
    motor = Motor(
        "warm-up",
        Nameplate(rated_power_W=800.0, rated_voltage_V=380.0, rated_frequency_Hz=50.0, pole_pairs=2),
        MachineParameters(8.4, 8.2, 0.0328, 0.0328, 0.4377, 0.0229),
    )
    rate, samples = 10_000.0, 1_600
    angle = 2.0 * np.pi * 50.0 / rate * np.arange(samples)
    voltage = 380.0 * np.stack([np.cos(angle), np.sin(angle)])
    feed = supply(voltage, rate, 50.0, 380.0 * np.array([1.0 + 0.0j, -1.0j], dtype=np.complex128))
    playback = Playback(SplitWinding(), motor, feed, window_of_record(samples, rate, 50.0, 1.0))
    one = np.ones(1)
    candidate = Candidates(0.05 * one, np.zeros(1, np.int64), 0.5 * one, 0.0 * one)
    playback.squared_error(candidate, np.zeros((2, samples)))
    playback.trajectories(candidate)
    _start(motor, feed, samples)
    gap = air_gap(complex(8.4, 10.3), 206.0, 8.2, 10.3, 0.03, *motor.backward_rotor)
    faulty_currents(gap, SequencePair(1.0 + 0.0j, 0.0j), complex(168.0, 40.0), 1.0 + 0.0j, 1.0 + 0.0j, 0.0, 0)
    estimates = estimates_of(weigh_stator(_figures(), motor))
    if not np.isfinite([*estimates.level_ci95, *estimates.load_ci95, estimates.detection_limit]).all():
        raise ArithmeticError("the figures of the record that warms up are not finite")
    follower = Follower(motor)
    for k in range(FOLLOWED):
        follower.fold(_record(k))
        if k == FOLLOWED // 2:  # what the records would show is told only while nothing is called
            follower.assessment()
    follower.assessment()
    forecast([(k * NANOSECONDS_PER_DAY, 0.0) for k in range(FOLLOWED)], motor.limits.fault_level)


def _start(motor: Motor, feed: Supply, samples: int) -> None:
    """Play a start of a motor that changes until it runs."""
    one = start_candidate(motor.parameters, 0.5)
    known = {each.name: getattr(one, each.name) for each in fields(one)}
    change = {each.name: np.ones(1) for each in fields(DeepBarCandidates) if each.name not in known}
    change |= {"resistance_ratio": np.full(1, 2.0), "leakage_share": np.full(1, 0.5)}
    candidate = DeepBarCandidates(**known, **change)
    DeepBarStartPlayback(motor.nameplate, feed, 10, (10, samples - 10)).trajectories(candidate)


def _figures() -> RecordFigures:
    """Return the figures of a record with shorted turns, which are looked at coarsely and finely."""
    return RecordFigures(
        angular_frequency=2.0 * np.pi * 50.0,
        positive_voltage_V=380.0,
        relative_voltage=1.0,
        admittance=0.006 - 0.005j,
        negative_current_S=-0.0004 + 0.0004j,
        negative_voltage=0.001 + 0.0j,
        zero_voltage=0.0j,
        zero_current=0.0j,
        sequence=PhaseSequence.ABC,
        voltage_channels=VoltageChannels.PHASE,
        noise=1e-12 * np.eye(6),
        cycles=20,
    )


def _record(k: int) -> Observation:
    """Return one of a motor's records; the later half has an asymmetry that the first lacks."""
    return Observation(
        time_ns=k * 3_600_000_000_000,
        recorder="",
        sequence=PhaseSequence.ABC,
        voltage_channels=VoltageChannels.PHASE,
        frequency_hz=50.0,
        positive_voltage_V=310.0 + 0.0j,
        negative_voltage_V=0.31 + 0.0j,
        zero_voltage_V=0.0j,
        positive_current_A=1.5 - 0.7j,
        negative_current_A=(0.001 + 0.3j * (k > FOLLOWED // 2)),
        zero_current_A=0.0j,
        scatter=1e-8,
        cycles=20,
    )


if __name__ == "__main__":
    warm_up()
