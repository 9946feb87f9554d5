"""The shunt that is added to measured currents against a machine that has the shorted turns."""

import numpy as np
import pytest

from benchmarks.accuracy.measured_records import MILL, MILL_RATE_HZ
from benchmarks.condition.mill import Shunt, shunted
from testing.machines.phase_circuits import Fault, recording, running


@pytest.mark.parametrize("shunt", [Shunt(0.01, 1, 0.0), Shunt(0.005, 2, 3.0)])
def test_shunted_currents_are_those_of_shorted_turns(shunt: Shunt) -> None:
    healthy = running(MILL, 0.4, unbalance=0.005j, reverse=True)
    samples = recording(healthy, frequency_hz=60.0, sample_rate_hz=MILL_RATE_HZ, seconds=0.5).samples
    turns = shunt.level * (1.0 + shunt.path_ratio)
    path_ohm = shunt.path_ratio * turns * MILL.parameters.stator_resistance_ohm
    faulty = running(MILL, 0.4, fault=Fault(turns, shunt.phase, path_ohm), unbalance=0.005j, reverse=True)

    added = (shunted(samples, shunt) - samples)[:3]

    cycles = added[:, -2_000:]  # fifteen whole cycles, when the loop has settled
    turning = np.exp(-2j * np.pi * 60.0 / MILL_RATE_HZ * np.arange(samples.shape[1])[-2_000:])
    phasors = np.sqrt(2.0) * (cycles * turning).mean(axis=1)
    expected = faulty.line_current - healthy.line_current
    # The faulty machine turns a little slower, and so draws a little more in all phases.
    np.testing.assert_allclose(phasors, expected, atol=0.03 * np.abs(expected).max())
    np.testing.assert_allclose(added.sum(axis=0), 0.0, atol=1e-9)
