"""A condition as the commands print it."""

from dataclasses import replace

from core.condition.kinds import Kind
from service.client.conditions import cause, state_text
from testing.service.conditions import DRIFTING, FAULT, OPEN_PHASE


def test_shorted_turns_in_no_sure_phase_have_the_likely_ones() -> None:
    assert str(state_text(FAULT.as_dict())) == "fault: shorted turns b"
    told = str(state_text(OPEN_PHASE.as_dict()))
    assert told == "fault: shorted turns in phase a (72 %) or c (28 %)"
    drifting = replace(DRIFTING, phase=None, phase_probabilities=OPEN_PHASE.phase_probabilities)
    told = cause(drifting.as_dict())
    assert told == "voltage channel or shorted turns in phase a (72 %) or c (28 %)"
    assert cause(replace(OPEN_PHASE, kind=Kind.CONNECTION).as_dict()) == "connection"
