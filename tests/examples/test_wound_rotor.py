"""The example of a wound rotor: its scenario recorded, and `mcc diagnose` with its motor file."""

import json
from dataclasses import replace
from math import sqrt
from pathlib import Path
from typing import Any

import pytest

from core.diagnosis.judgement import SLIP_RINGS
from core.machines.motor_file.reader import read_motor
from core.machines.typical import atypical
from core.recordings import Channel, Quantity, Recording, comtrade
from ied_sim.motor.fault import FaultCourse
from ied_sim.motor.plant import MotorPlant
from ied_sim.scenario.scenario import read_scenario
from service.cli import main

EXAMPLES = Path(__file__).parents[2] / "examples"
MOTOR = EXAMPLES / "hoist_wound_rotor.toml"
SAMPLE_RATE_HZ, DURATION_S = 5_000.0, 4.2


def _diagnosed(plant: MotorPlant, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> dict[str, Any]:
    sensors = plant.sensors
    scales = (sensors.full_scale_A, sensors.full_scale_V)
    record = Recording(
        plant.window(0.0, DURATION_S, SAMPLE_RATE_HZ),
        SAMPLE_RATE_HZ,
        1_767_603_600_000_000_000,
        (
            *(Channel(f"I{x}", Quantity.CURRENT, x, "A", scales[0]) for x in "abc"),
            *(Channel(f"V{x}", Quantity.PHASE_VOLTAGE, x, "V", scales[1]) for x in "abc"),
        ),
        nominal_frequency_hz=50.0,
    )
    path = comtrade.write(tmp_path / "HOIST.CFG", record)
    assert main(["diagnose", str(path), "--motor", str(MOTOR), "--json"]) == 0
    found: dict[str, Any] = json.loads(capsys.readouterr().out)
    return found


@pytest.fixture
def plant() -> MotorPlant:
    """The hoist of the scenario; it does not start while it is recorded."""
    return replace(read_scenario(EXAMPLES / "wound_rotor_scenario.toml")["HOIST"].plant, contactor=None)


def test_its_figures_are_those_of_real_motors() -> None:
    motor = read_motor(MOTOR)
    assert motor.wound_rotor is not None
    power = sqrt(3.0) * motor.wound_rotor.open_circuit_voltage_V * motor.wound_rotor.rated_current_A
    assert 1.0 < power / motor.nameplate.rated_power_W < 1.3
    assert atypical(motor) == ()


def test_the_bad_contact_is_found_and_the_stator_is_healthy(
    plant: MotorPlant, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    found = _diagnosed(plant, tmp_path, capsys)
    assert found["verdict"] == "healthy"
    assert found["load_level"] == pytest.approx(0.6, abs=0.03)
    rotor = found["rotor"]
    assert rotor["state"] == "fault"
    assert "rotor winding" in rotor["reasons"][0]
    assert any(reason.endswith("between the slip rings and their star point") for reason in rotor["reasons"])


def test_shorted_turns_beside_it_are_found_without_their_phase(
    plant: MotorPlant, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    ill = replace(plant, fault=FaultCourse(2, ((0.0, 0.04),), 0.0))
    found = _diagnosed(ill, tmp_path, capsys)
    assert found["verdict"] == "fault"
    assert (found["phase"], found["theta_f"], found["phase_probabilities"]) == (None, None, None)
    assert SLIP_RINGS in found["reasons"]
    low, high = found["mu_f_ci95"]
    assert low < 0.04 < high
    assert found["rotor"]["state"] == "fault"


def test_it_starts_in_the_steps_of_its_starter() -> None:
    plant = read_scenario(EXAMPLES / "wound_rotor_scenario.toml")["HOIST"].plant
    start = plant.start_up(0.0, 6.0, 2_000.0)
    rms_A = (start.currents_A.reshape(3, -1, 40) ** 2).mean(axis=(0, 2)) ** 0.5
    # It jumps up where resistance is taken out, and falls as the motor runs up in between.
    assert (rms_A[[80, 155]] > 1.1 * rms_A[[73, 148]]).all()
    synchronous = 2.0 * 3.14159265 * 25.0
    assert start.speed_rad_s[-1] / synchronous == pytest.approx(0.935, abs=0.01)
