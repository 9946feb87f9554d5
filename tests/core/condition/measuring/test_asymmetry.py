"""The picture of a motor's asymmetry: shorted turns point along the axis of their phase at the terminals."""

from cmath import phase
from math import degrees

import pytest

from core.condition.errors import ObservationError
from core.condition.measuring.asymmetry import asymmetry_of
from core.machines.parameters import Connection
from core.machines.winding_frame import terminal_winding
from core.signals.sequence import PhaseSequence
from tests.core.condition.simulated import Plant, motor_of


def ideal(
    connection: Connection = Connection.STAR, sequence: PhaseSequence = PhaseSequence.ABC, scale: float = 1.0
) -> Plant:
    """Return a sound motor on a balanced supply, with perfect channels."""
    return Plant(
        connection,
        sequence,
        voltage=[1.0] * 3,
        current=[1.0] * 3,
        noise=0.0,
        unbalance=0j,
        supply_swing=0.0,
        scale=scale,
    )


@pytest.mark.parametrize("winding", [0, 1, 2])
@pytest.mark.parametrize("sequence", PhaseSequence)
@pytest.mark.parametrize("connection", Connection)
def test_shorted_turns_lie_on_the_axis_of_their_phase(
    connection: Connection, sequence: PhaseSequence, winding: int
) -> None:
    plant = ideal(connection, sequence)
    plant.level, plant.winding, plant.path = 0.03, winding, 0.0

    seen = asymmetry_of(plant.record(), motor_of(connection))

    axis = 120.0 * terminal_winding(winding, sequence, connection)
    assert (degrees(phase(seen)) - axis + 180.0) % 360.0 - 180.0 == pytest.approx(0.0, abs=15.0)
    assert abs(seen) == pytest.approx(0.03, rel=0.15)


def test_a_sound_motor_on_an_unbalanced_supply_is_nearly_symmetrical() -> None:
    plant = ideal()
    plant.unbalance = 0.01 + 0j

    assert abs(asymmetry_of(plant.record(), motor_of())) < 0.0015


def test_a_record_of_a_motor_that_stands_has_none() -> None:
    plant = ideal(scale=1e-20)

    with pytest.raises(ObservationError):
        asymmetry_of(plant.record(), motor_of())
