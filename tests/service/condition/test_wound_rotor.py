"""A wound rotor in what is stored of a motor: read again as it was, and compared with the file of now."""

import json
from dataclasses import replace

import pytest

from core.machines.parameters import Motor
from service.condition.motor_data import document_of, motor_known, motor_of
from testing.machines.motors import MEDIUM
from testing.machines.wound_rotors import HOIST, HOIST_WITH_UNKNOWN_RESISTANCE


@pytest.mark.parametrize("motor", [MEDIUM, HOIST, HOIST_WITH_UNKNOWN_RESISTANCE])
def test_what_is_stored_is_the_motor(motor: Motor) -> None:
    document = document_of(motor)
    stored = json.loads(json.dumps(document))
    assert stored == document
    assert motor_of(replace(motor, wound_rotor=None), stored) == motor
    assert motor_known(motor.name, stored) == motor


def test_a_cage_is_stored_as_ever() -> None:
    assert "wound_rotor" not in document_of(MEDIUM)
