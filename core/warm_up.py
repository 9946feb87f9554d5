"""Compile the models once, so that the first diagnosis need not wait: python -m core.warm_up."""

import numpy as np

from core.machines.candidates import Candidates
from core.machines.parameters import MachineParameters, Motor, Nameplate
from core.machines.playback import Playback, window_of_record
from core.machines.split_winding import SplitWinding
from core.machines.supply import supply


def warm_up() -> None:
    """Run a few cycles of the thesis's motor through every compiled function."""
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


if __name__ == "__main__":
    warm_up()
