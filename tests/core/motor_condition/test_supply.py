"""The supply of a motor beside the limits of NEMA MG-1 and IEC 60034-1."""

from dataclasses import replace

import pytest

from core.condition.kinds import State
from core.motor_condition.supply import supply_condition
from testing.service.rotor_and_supply import SUPPLY

SOUND = replace(
    SUPPLY,
    voltage_deviation=0.01,
    voltage_unbalance_nema=0.004,
    frequency_hz=50.0,
    harmonic_voltage_factor=0.01,
)


@pytest.mark.parametrize(
    ("beyond", "state", "finding"),
    [
        ({}, State.HEALTHY, ""),
        ({"voltage_deviation": -0.115, "voltage_unbalance_nema": 0.023}, State.WATCH, "undervoltage"),
        ({"voltage_deviation": 0.11}, State.WATCH, "overvoltage"),
        ({"voltage_deviation": -0.16}, State.FAULT, "undervoltage"),
        ({"voltage_unbalance_nema": 0.06}, State.FAULT, "unbalanced voltage"),
        ({"frequency_hz": 51.6}, State.WATCH, "frequency off its rated value"),
        ({"frequency_hz": 48.0}, State.HEALTHY, ""),
        ({"harmonic_voltage_factor": 0.035}, State.WATCH, "distorted voltage"),
    ],
)
def test_what_is_beyond_a_limit_is_named(beyond: dict[str, float], state: State, finding: str) -> None:
    found = supply_condition([replace(SOUND, **beyond)] * 3, 50.0)  # type: ignore[arg-type]
    assert found.state is state
    assert found.findings[:1] == ((finding,) if finding else ())


def test_unbalance_and_undervoltage_are_both_told_with_what_is_left_of_the_power() -> None:
    poor = replace(SOUND, voltage_deviation=-0.115, voltage_unbalance_nema=0.023)
    found = supply_condition([SOUND, poor, poor], 50.0)
    assert found.findings == ("undervoltage", "unbalanced voltage")
    assert "-11.5%" in found.reasons[0]
    assert "93% of the rated power" in found.reasons[1]


def test_a_single_record_is_not_believed_where_others_disagree() -> None:
    poor = replace(SOUND, voltage_unbalance_nema=0.06)
    assert supply_condition([SOUND, SOUND, poor], 50.0).state is State.HEALTHY
    assert (
        supply_condition([SOUND, poor, replace(poor, voltage_unbalance_nema=0.03)], 50.0).state is State.WATCH
    )


def test_the_unbalance_of_a_wrong_voltage_channel_is_not_the_supplys() -> None:
    poor = replace(SOUND, voltage_unbalance_nema=0.06, voltage_deviation=-0.2)
    assert supply_condition([poor] * 3, 50.0, voltages_agree=False).state is State.HEALTHY


def test_without_a_record_nothing_is_known() -> None:
    assert supply_condition([], 50.0).state is State.UNKNOWN


def test_the_frequency_of_a_motor_without_a_rated_one_is_left_out() -> None:
    assert supply_condition([replace(SOUND, frequency_hz=60.0)] * 3, None).state is State.HEALTHY


def test_one_record_tells_nothing_and_two_that_disagree_are_not_added() -> None:
    poor = replace(SOUND, voltage_deviation=-0.16)
    assert supply_condition([poor], 50.0).state is State.UNKNOWN
    assert supply_condition([poor, replace(poor, voltage_deviation=0.12)], 50.0).state is State.HEALTHY
