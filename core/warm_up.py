"""Compile the numbers' inner loops once, so that nothing waits for them: python -m core.warm_up."""

import numpy as np

from core.condition.following.follower import Follower
from core.condition.forecast.forecast import forecast
from core.condition.observation import Observation, VoltageChannels
from core.machines.candidates import Candidates
from core.machines.parameters import MachineParameters, Motor, Nameplate
from core.machines.playback import Playback, window_of_record
from core.machines.split_winding import SplitWinding
from core.machines.supply import supply
from core.signals.sequence import PhaseSequence
from core.units import NANOSECONDS_PER_DAY

FOLLOWED = 40
"""Records that are followed."""


def warm_up() -> None:
    """Run a few cycles, and a few records, of the thesis's motor through every compiled function."""
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
    candidate = Candidates(0.05 * one, np.zeros(1, np.int64), 0.5 * one, 0.0 * one, 0.0 * one)
    playback.squared_error(candidate, np.zeros((2, samples)))
    playback.trajectories(candidate)
    follower = Follower(motor)
    for k in range(FOLLOWED):
        follower.fold(_record(k))
        if k == FOLLOWED // 2:  # what the records would show is told only while nothing is called
            follower.assessment()
    follower.assessment()
    forecast([(k * NANOSECONDS_PER_DAY, 0.0) for k in range(FOLLOWED)], motor.limits.fault_level)


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
