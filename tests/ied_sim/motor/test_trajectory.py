"""Windows that follow each other: the motor goes on where it was, as a motor does."""

import numpy as np
import pytest

from ied_sim.motor.contactor import Contactor
from ied_sim.motor.load import Load, Pulsation
from ied_sim.motor.plant import MotorPlant
from ied_sim.motor.sensors import Sensors
from ied_sim.motor.supply import Supply
from ied_sim.motor.trajectory import Trajectory
from testing.machines.motors import REFERENCE

RATE_HZ = 5_000.0


def broken_bar(trajectory: Trajectory | None, contactor: Contactor | None = None) -> MotorPlant:
    """A motor whose rotor angle shows: a broken bar, and a load that pulsates with the shaft."""
    return MotorPlant(
        motor=REFERENCE,
        supply=Supply(380.0, 50.0),
        load=Load(0.8, pulsations=(Pulsation(0.1, per_turn=0.3),)),
        sensors=Sensors(20.0, 700.0),
        broken_bars=1 / 28,
        contactor=contactor,
        trajectory=trajectory,
    )


def apart(plant: MotorPlant, later_s: float) -> float:
    """Largest difference of the currents [A] in what two windows of half a second have in common."""
    first = plant.window(20.0, 0.5, RATE_HZ)[:3]
    second = plant.window(later_s, 0.5, RATE_HZ)[:3]
    common = round((20.5 - later_s) * RATE_HZ)
    return float(np.abs(first[:, -common:] - second[:, :common]).max())


def test_windows_that_overlap_show_the_same_waveform_of_a_broken_bar() -> None:
    assert apart(broken_bar(Trajectory()), 20.3) < 2e-3
    assert apart(broken_bar(None), 20.3) > 2e-2


def test_a_window_between_the_samples_of_the_one_before_goes_on_too() -> None:
    plant = broken_bar(Trajectory())
    first = plant.window(20.0, 0.5, RATE_HZ)[0]
    second = plant.window(20.3 + 0.4 / RATE_HZ, 0.5, RATE_HZ)[0]
    times = np.arange(first.size) / RATE_HZ
    there = np.arange(300) / RATE_HZ + 0.3 + 0.4 / RATE_HZ
    steepest_A = 2 * np.pi * 50 / RATE_HZ * np.abs(first).max()
    assert np.abs(np.interp(there, times, first) - second[:300]).max() < 0.05 * steepest_A


def test_a_window_soon_after_goes_on_without_a_step() -> None:
    plant = broken_bar(Trajectory())
    whole = broken_bar(Trajectory()).window(20.0, 1.0, RATE_HZ)[0]
    plant.window(20.0, 0.3, RATE_HZ)
    assert plant.window(20.6, 0.4, RATE_HZ)[0] == pytest.approx(whole[3000:], abs=2e-3)


def test_a_motor_that_was_switched_meanwhile_goes_on_from_no_earlier_closure() -> None:
    contactor = Contactor()
    plant = broken_bar(Trajectory(), contactor)
    plant.window(20.0, 0.5, RATE_HZ)
    contactor.open(20.2)
    contactor.close(20.3)
    currents = plant.window(20.25, 0.2, RATE_HZ)[:3]
    assert np.abs(currents[:, :200]).max() < 0.01  # at rest until it is closed
    assert np.abs(currents[:, 300:]).max() > 5.0  # and then it starts
