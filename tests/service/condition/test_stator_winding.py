"""A stator winding in what is stored of a motor: read again as it was, and as the file says now."""

import json
from dataclasses import replace

import pytest

from core.machines.parameters import Motor
from core.machines.stator_winding import StatorWinding, WindingKind
from service.condition.motor_data import document_of, motor_known, motor_of
from testing.machines.motors import MEDIUM

LAP = replace(MEDIUM, winding=StatorWinding(WindingKind.LAP, 36, 2, 8))
CONCENTRIC = replace(MEDIUM, winding=StatorWinding(WindingKind.CONCENTRIC, 48, 1))


@pytest.mark.parametrize("motor", [MEDIUM, LAP, CONCENTRIC])
def test_what_is_stored_is_the_motor(motor: Motor) -> None:
    document = document_of(motor)
    stored = json.loads(json.dumps(document))
    assert stored == document
    assert motor_of(replace(motor, winding=None), stored) == motor
    assert motor_known(motor.name, stored) == motor


def test_an_unknown_winding_is_not_stored() -> None:
    assert "winding" not in document_of(MEDIUM)
