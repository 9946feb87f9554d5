"""When a motor's running costs more than it should, and that this says nothing of its health."""

from dataclasses import replace

import pytest

from core.condition.kinds import State
from core.losses.figures import LossFigures
from core.motor_condition.efficiency import efficiency_part
from core.motor_condition.parts import Part, counting
from tests.core.losses.test_cost import FIGURES

COSTLY = replace(FIGURES, losses_W=900.0, unbalance_loss_W=150.0)
UNTOLD = LossFigures.untold("no voltages recorded")


def test_a_motor_that_runs_as_it_should_is_told_with_its_efficiency() -> None:
    part = efficiency_part((FIGURES,) * 3, (0.8,) * 20)
    assert (part.part, part.state, part.counts) == (Part.EFFICIENCY, State.HEALTHY, False)
    assert part.reasons == ("efficiency 90.0%, losses 750 W",)


@pytest.mark.parametrize(
    ("latest", "state"),
    [((COSTLY, FIGURES, COSTLY), State.WATCH), ((COSTLY, FIGURES, FIGURES), State.HEALTHY)],
)
def test_two_of_three_records_tell_that_it_loses_too_much(
    latest: tuple[LossFigures, ...], state: State
) -> None:
    part = efficiency_part(latest, ())
    assert part.state is state
    if state is State.WATCH:
        assert part.finding == "more losses than it should have"
        assert part.reasons[0] == ("20% more losses than at a good supply: unbalance of the supply 150 W")


@pytest.mark.parametrize(
    ("loads", "state"),
    [
        ((0.3,) * 12, State.WATCH),
        ((0.3,) * 11, State.HEALTHY),  # too few of them
        ((0.3,) * 11 + (0.8,) * 9, State.HEALTHY),  # about half of the time
        ((0.3,) * 16 + (0.8,) * 4, State.WATCH),
        ((0.45,) * 30, State.HEALTHY),
    ],
)
def test_a_small_load_most_of_the_time_is_told(loads: tuple[float, ...], state: State) -> None:
    assert efficiency_part((FIGURES,), loads).state is state


def test_it_is_no_state_of_the_motor() -> None:
    part = efficiency_part((COSTLY,) * 3, (0.1,) * 60)
    assert part.counts
    assert part.advice
    assert counting([part]) == []


def test_records_without_losses_tell_nothing() -> None:
    assert efficiency_part((UNTOLD,) * 3, ()).state is State.UNKNOWN
