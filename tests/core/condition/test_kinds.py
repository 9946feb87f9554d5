"""What moves the impedance of a motor with no parameter of it."""

import pytest

from core.condition.kinds import Kind, State, moves_impedance


@pytest.mark.parametrize(
    ("state", "kind", "candidates", "moves"),
    [
        (State.FAULT, Kind.SHORTED_TURNS, (), True),
        (State.WATCH, Kind.UNCLEAR, (Kind.CONNECTION, Kind.SUPPLY), True),
        (State.WATCH, Kind.PARAMETERS, (), False),
        (State.WATCH, Kind.SUPPLY, (), False),
        (State.HEALTHY, Kind.CONNECTION, (), False),
        (State.UNKNOWN, Kind.NONE, (), False),
    ],
)
def test_a_change_that_is_no_parameter_moves_the_impedance(
    state: State, kind: Kind, candidates: tuple[Kind, ...], *, moves: bool
) -> None:
    assert moves_impedance(state, kind, candidates) is moves
