"""A start with all that it shows, and in words what it does not."""

import json
from pathlib import Path

import pytest

from core.machines.parameters import Motor
from core.recordings import read
from core.starts.examining import examine_start
from testing.machines.motors import LARGE, MEDIUM
from testing.machines.starts import StartRecord, with_parameters


@pytest.mark.parametrize("motor", [MEDIUM, LARGE], ids=lambda motor: motor.name)
def test_parameters_of_a_start_are_those_of_the_motor(motor: Motor) -> None:
    guessed = with_parameters(motor, rotor_resistance_ohm=0.8 * motor.parameters.rotor_resistance_ohm)

    found = examine_start(StartRecord(snr_db=45.0).of(motor), guessed)

    assert found.remark is None
    assert found.parameters is not None
    true = motor.parameters.rotor_resistance_ohm
    low, high = found.parameters.ci95["rotor_resistance_ohm"]
    assert found.parameters.values["rotor_resistance_ohm"] == pytest.approx(true, rel=0.01)
    assert high - low < 0.05 * true
    assert found.torque is not None
    document = json.loads(json.dumps(found.model_as_dict(), allow_nan=False))
    assert set(document) == {"torque", "parameters", "sideband", "stress", "remark"}


def test_a_start_that_began_before_the_record_has_figures_and_a_remark() -> None:
    whole = StartRecord(before_s=0.0, duration_s=1.0).of(LARGE)
    late = type(whole)(
        whole.samples[:, 1500:], whole.sample_rate_hz, 0, whole.channels, source="late", trigger_index=0
    )

    found = examine_start(late, LARGE)

    assert found.torque is None
    assert found.parameters is None
    assert found.sideband is None
    assert found.remark is not None
    assert "pre-trigger" in found.remark


def test_a_motor_that_is_switched_on_again_while_it_turns_has_figures_and_a_remark() -> None:
    # The nearest that the model comes has a thirtieth of the inertia: under a load that grows with the square
    # of the speed its current has no bound.
    record = read(Path(__file__).parent / "records" / "restart_at_speed.cfg")

    found = examine_start(record, MEDIUM)

    assert found.figures.peak_current_A > 5.0 * found.figures.rated_current_A
    assert found.parameters is None
    assert found.remark is not None
    assert "unexplained" in found.remark
