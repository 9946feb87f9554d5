"""What a comparison of starts is worth, by the benchmark's own words."""

from dataclasses import replace

import pytest

from benchmarks.starts.causes import CASES, Case, outcome
from core.starts.compared import ChangeState, StartCause, StartChanges

NOTHING = StartChanges(ChangeState.AS_BEFORE, (), (), (), None, None, ())
BOTH = Case("supply and load", frozenset({StartCause.SUPPLY, StartCause.LOAD}))


@pytest.mark.parametrize(
    ("case", "changes", "worth"),
    [
        (CASES[0], NOTHING, "right"),
        (CASES[0], replace(NOTHING, causes=(StartCause.WARMTH,)), "right"),
        (CASES[0], replace(NOTHING, causes=(StartCause.LOAD,)), "wrong"),
        (CASES[0], replace(NOTHING, state=ChangeState.NOT_TOLD_APART), "not told apart"),
        (BOTH, replace(NOTHING, causes=(StartCause.LOAD, StartCause.SUPPLY)), "right"),
        (BOTH, replace(NOTHING, causes=(StartCause.LOAD,)), "partly"),
        (BOTH, replace(NOTHING, causes=(StartCause.ROTOR, StartCause.LOAD)), "wrong"),
        (BOTH, NOTHING, "missed"),
    ],
)
def test_outcomes(case: Case, changes: StartChanges, worth: str) -> None:
    assert outcome(changes, case) == worth
