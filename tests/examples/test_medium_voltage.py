"""The example motors of medium voltage: usual figures per unit, and records that are diagnosed right."""

from math import sqrt
from pathlib import Path

import pytest

from core.diagnosis.stator import diagnose
from core.machines.motor_file.reader import read_motor
from core.machines.typical import typical_parameters
from core.quality import circle_diagram
from core.recordings import Channel, Quantity, Recording
from ied_sim.scenario.scenario import read_scenario

EXAMPLES = Path(__file__).parents[2] / "examples"
SCENARIO = EXAMPLES / "medium_voltage_scenario.toml"
SAMPLE_RATE_HZ = 5_000.0


@pytest.mark.parametrize("name", ["pump_3300V", "mill_11kV"])
def test_their_figures_are_those_of_real_motors(name: str) -> None:
    motor = read_motor(EXAMPLES / f"{name}.toml")
    plate = motor.nameplate
    for parameter, (low, high) in typical_parameters(plate).intervals.items():
        assert low < getattr(motor.parameters, parameter) < high, parameter
    circle = circle_diagram(motor, plate.rated_frequency_Hz)
    locked = plate.rated_voltage_V**2 * circle.at_standstill / plate.rated_power_W
    assert 5.0 < locked < 7.0
    assert 2.5 < circle.pull_out_torque_Nm / plate.rated_torque_Nm < 3.0


@pytest.mark.parametrize(
    ("ied", "motor", "verdict", "phase"),
    [("PUMP_3300V", "pump_3300V", "healthy", None), ("MILL_11KV", "mill_11kV", "fault", "c")],
)
def test_records_of_the_scenario_are_diagnosed_right(
    ied: str, motor: str, verdict: str, phase: str | None
) -> None:
    plant = read_scenario(SCENARIO)[ied].plant
    plate = plant.motor.nameplate
    full_scale_V = 2.0 * sqrt(2.0 / 3.0) * plate.rated_voltage_V
    full_scale_A = 12.0 * sqrt(2.0 / 3.0) * plate.rated_power_W / plate.rated_voltage_V
    record = Recording(
        plant.window(0.0, 0.5, SAMPLE_RATE_HZ),
        SAMPLE_RATE_HZ,
        1_767_603_600_000_000_000,
        (
            *(Channel(f"I{x}", Quantity.CURRENT, x, "A", full_scale_A) for x in "abc"),
            *(Channel(f"V{x}", Quantity.PHASE_VOLTAGE, x, "V", full_scale_V) for x in "abc"),
        ),
        nominal_frequency_hz=50.0,
    )
    found = diagnose(record, read_motor(EXAMPLES / f"{motor}.toml"))
    assert (found.verdict, found.phase) == (verdict, phase), found.reasons
