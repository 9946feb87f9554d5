"""What is told of the coil: its axis where the winding is known, and no phase behind slip rings."""

from dataclasses import replace
from math import radians

import numpy as np
import pytest

from core.condition.kinds import Kind, State
from core.condition.verdict.condition import Condition
from core.condition.verdict.judging import condition_of
from core.machines.parameters import Motor, WoundRotor
from core.machines.stator_winding import StatorWinding, WindingKind
from core.signals.sequence import PhaseSequence
from tests.core.condition.simulated import Plant, follow, motor_of

LAP = StatorWinding(WindingKind.LAP, 36, 2, 8)
OUTER_LINKAGE = LAP.coil_axes(2)[0].linkage


def condition_after(motor: Motor, plant: Plant, **what: object) -> Condition:
    """The condition some records after something has changed."""
    follower = follow(motor, plant.records(40))
    for name, value in what.items():
        setattr(plant, name, value)
    for record in plant.records(16):
        follower.fold(record)
    assessment = follower.assessment()
    assert assessment is not None
    return condition_of(motor, assessment, plant.time_ns)


@pytest.mark.parametrize("sequence", list(PhaseSequence))
@pytest.mark.parametrize("axis_deg", [-20.0, 20.0])
def test_the_axis_of_the_coil_is_told_with_its_sign_whatever_the_sequence(
    sequence: PhaseSequence, axis_deg: float
) -> None:
    plant = Plant(sequence=sequence, load=(0.3, 1.0))
    found = condition_after(
        replace(motor_of(), winding=LAP), plant, level=0.03, axis_deg=axis_deg, linkage=OUTER_LINKAGE
    )
    assert found.kind is Kind.SHORTED_TURNS
    assert found.axis_deg == pytest.approx(axis_deg)
    assert any(f"in coils of the axis {axis_deg:+.0f} degrees" in reason for reason in found.reasons)


def test_no_axis_is_told_without_the_winding() -> None:
    found = condition_after(motor_of(), Plant(load=(0.3, 1.0)), level=0.03, axis_deg=20.0)
    assert found.kind is Kind.SHORTED_TURNS
    assert found.axis_deg is None
    assert not any("axis" in reason for reason in found.reasons)


def test_behind_slip_rings_no_phase_is_named_and_the_reasons_say_why() -> None:
    wound = replace(motor_of(), wound_rotor=WoundRotor(120.0, 4.0))
    found = condition_after(wound, Plant(load=(0.3, 1.0)), level=0.03)
    assert found.state in {State.FAULT, State.WATCH}
    assert found.phase is None
    assert any("slip rings does not damp" in reason for reason in found.reasons)


@pytest.mark.parametrize("turned_deg", [40.0, 160.0, 280.0])
def test_an_asymmetry_that_leaves_the_forward_current_alone_is_called_neither_turns_nor_a_channel(
    turned_deg: float,
) -> None:
    shown = 0.02 * np.exp(1j * radians(turned_deg))
    found = condition_after(motor_of(), Plant(load=(0.3, 1.0)), asymmetry=complex(shown))
    assert found.kind in {Kind.ASYMMETRY, Kind.UNCLEAR}
    assert Kind.ASYMMETRY in {found.kind, *found.candidates}
    assert found.state is State.WATCH
