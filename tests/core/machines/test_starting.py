"""Starts of machines that all differ: against the playback of one motor and against independent physics."""

from dataclasses import fields, replace

import numpy as np
import pytest

from core.machines.candidates import LoadLaw
from core.machines.starting import StartCandidates, StartPlayback, start_candidate
from core.machines.supply import Supply, supply
from core.signals.clarke import clarke
from ied_sim.motor.load import Load
from ied_sim.motor.plant import MotorPlant
from ied_sim.motor.sensors import Sensors
from ied_sim.motor.supply import Supply as Busbar
from testing.machines.motors import MEDIUM, REFERENCE

W_S = 2.0 * np.pi * 50.0
FIRST = 10


def feed(volts: float, rate: float, samples: int) -> Supply:
    angle = W_S * (np.arange(samples + 2 * FIRST) - FIRST) / rate
    return supply(
        volts * np.array([np.cos(angle), np.sin(angle)]), rate, 50.0, np.zeros(2, dtype=np.complex128)
    )


def together(candidates: list[StartCandidates]) -> StartCandidates:
    columns = {
        field.name: np.concatenate([getattr(one, field.name) for one in candidates])
        for field in fields(StartCandidates)
    }
    return StartCandidates(**columns)


def test_machines_in_one_batch_start_like_the_simulators_windings() -> None:
    """Three machines at once, each against its own integration in phase variables."""
    machines = [
        REFERENCE.parameters,
        replace(REFERENCE.parameters, inertia_kgm2=0.05, rotor_resistance_ohm=12.0),
        replace(REFERENCE.parameters, stator_leakage_H=0.02, rotor_leakage_H=0.04, stator_resistance_ohm=6.0),
    ]
    loads = [0.0, 0.5, 1.0]
    playback = StartPlayback(REFERENCE.nameplate, feed(380.0, 10_000.0, 5_000), FIRST, (FIRST, FIRST + 5_000))
    batch = together([start_candidate(*pair) for pair in zip(machines, loads, strict=True)])
    found = playback.trajectories(batch)
    for row, (machine, load) in enumerate(zip(machines, loads, strict=True)):
        plant = MotorPlant(
            replace(REFERENCE, parameters=machine), Busbar(380.0, 50.0), Load(load), Sensors(1.0, 1.0)
        )
        true = plant.start_up(0.0, 0.5, 10_000.0)
        current = clarke(true.currents_A)
        assert np.abs(found.current[row] - current).max() < 1e-3 * np.abs(current).max()
        assert found.speed[row] == pytest.approx(2.0 * true.speed_rad_s, abs=0.1)


def test_a_batch_is_what_its_machines_are_one_by_one() -> None:
    """But for the length of the blocks between two looks at the speed, which a batch shares."""
    random = np.random.default_rng(4)
    candidates = []
    for _ in range(21):
        machine = replace(
            MEDIUM.parameters,
            stator_resistance_ohm=random.uniform(0.3, 2.0),
            inertia_kgm2=10.0 ** random.uniform(-2.5, 0.0),
        )
        one = start_candidate(machine, random.uniform(0.0, 1.0), random.uniform(-2e-4, 8e-4))
        candidates.append(replace(one, switching_flux_Vs=random.normal(size=(1, 2))))
    playback = StartPlayback(
        MEDIUM.nameplate, feed(400.0, 10_000.0, 800), FIRST, (FIRST + 100, FIRST + 800), LoadLaw.QUADRATIC
    )
    measured = random.standard_normal((2, 700))
    alone = [float(playback.squared_error(one, measured)[0]) for one in candidates]
    assert playback.squared_error(together(candidates), measured) == pytest.approx(alone, rel=2e-5)


@pytest.mark.parametrize("rate", [800.0, 10_000.0])
def test_a_start_between_two_samples_begins_there(rate: float) -> None:
    """Switched on a quarter of a fine step later: the same currents, seen from that instant."""
    volts = feed(380.0, rate, round(0.3 * rate))
    late = FIRST * volts.substeps + 1
    samples = (FIRST + 1, FIRST + round(0.3 * rate))
    found = StartPlayback(REFERENCE.nameplate, volts, late, samples).trajectories(
        start_candidate(REFERENCE.parameters, 0.5)
    )
    plant = MotorPlant(REFERENCE, Busbar(380.0, 50.0), Load(0.5), Sensors(1.0, 1.0))
    true = clarke(plant.start_up(volts.step_s, 0.3, 1.0 / volts.step_s).currents_A)
    first = samples[0] * volts.substeps - late
    assert (
        np.abs(found.current[0] - true[:, first :: volts.substeps][:, : found.current.shape[2]]).max()
        < 2e-3 * np.abs(true).max()
    )


def test_an_offset_beyond_the_voltages_and_samples_before_the_start_are_refused() -> None:
    volts = feed(380.0, 10_000.0, 500)
    playback = StartPlayback(REFERENCE.nameplate, volts, FIRST, (FIRST, FIRST + 400))
    with pytest.raises(ValueError, match="time offsets: expected"):
        playback.trajectories(start_candidate(REFERENCE.parameters, 0.5, 0.002))
    with pytest.raises(ValueError, match="samples compared"):
        StartPlayback(REFERENCE.nameplate, volts, FIRST, (FIRST - 1, FIRST + 400))
