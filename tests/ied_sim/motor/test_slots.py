"""Windings by slots: where their coils lie, and windings that do not exist."""

from collections import Counter

import numpy as np
import pytest

from core.machines.stator_winding import StatorWinding, WindingKind
from ied_sim.motor.coils import coils_of
from ied_sim.motor.slots import SlotWinding
from testing.machines.rated_motors import rated_motor

WINDINGS = [
    (SlotWinding("lap", 36, 2, 8), 2),
    (SlotWinding("lap", 48, 2, 10), 2),
    (SlotWinding("lap", 54, 2, 8), 3),
    (SlotWinding("lap", 24, 1, 6), 2),
    (SlotWinding("concentric", 36, 1), 2),
    (SlotWinding("concentric", 48, 2, 10), 2),
]


@pytest.mark.parametrize(("winding", "pole_pairs"), WINDINGS)
def test_every_slot_holds_one_coil_side_a_layer(winding: SlotWinding, pole_pairs: int) -> None:
    coils = winding.coils(pole_pairs)
    sides = Counter(side % winding.slots for coil in coils for side in (coil.go, coil.back))
    assert sides == dict.fromkeys(range(winding.slots), winding.layers)
    assert Counter(coil.phase for coil in coils) == dict.fromkeys(range(3), winding.coils_per_phase())


@pytest.mark.parametrize(
    ("slots", "pole_pairs", "pitch", "axes_deg"),
    [
        (36, 2, 8, [-20, 0, 20]),
        (48, 2, 10, [-22.5, -7.5, 7.5, 22.5]),
        (24, 2, 5, [-15, 15]),
        (36, 1, 15, [-25, -15, -5, 5, 15, 25]),
    ],
)
def test_axes_of_a_lap_group_lie_a_slot_apart(
    slots: int, pole_pairs: int, pitch: int, axes_deg: list[float]
) -> None:
    winding = SlotWinding("lap", slots, 2, pitch)
    q = winding.coils_per_group(pole_pairs)
    group = winding.coils(pole_pairs)[:q]
    axes = np.array([(coil.go + coil.back) / 2 for coil in group]) * 360 * pole_pairs / slots
    assert axes - axes.mean() == pytest.approx(axes_deg)


def test_a_concentric_group_has_one_axis_and_coils_of_different_pitch() -> None:
    group = SlotWinding("concentric", 36, 1).coils(2)[:3]
    assert [coil.pitch_slots for coil in group] == [11, 9, 7]
    assert len({coil.go + coil.back for coil in group}) == 1


def test_branches_are_neighbouring_groups() -> None:
    coils = SlotWinding("lap", 36, 2, 8, branches=2).coils(2)
    assert [coil.branch for coil in coils[:12]] == [0] * 6 + [1] * 6


@pytest.mark.parametrize(
    ("winding", "pole_pairs", "reason"),
    [
        (SlotWinding("lap", 40), 2, "no multiple of 12"),
        (SlotWinding("lap", 36, 2, 8, branches=3), 2, "no 3 equal branches"),
        (SlotWinding("lap", 36, 2, 10), 2, "pitch of 10 slots"),
        (SlotWinding("lap", 36, 2, 4), 2, "pitch of 4 slots"),
        (SlotWinding("lap", 36, 1, 8), 2, "pitch of 8 slots"),
    ],
)
def test_windings_that_do_not_exist_are_refused(winding: SlotWinding, pole_pairs: int, reason: str) -> None:
    with pytest.raises(ValueError, match=reason):
        winding.coils(pole_pairs)


@pytest.mark.parametrize(("winding", "pole_pairs"), WINDINGS)
def test_axes_and_linkages_are_those_of_the_motor_file(winding: SlotWinding, pole_pairs: int) -> None:
    """Two accounts of one winding that share no code: the slots of the simulator, and the diagnosis's."""
    sheet = StatorWinding(WindingKind(winding.kind), winding.slots, winding.layers, winding.coil_pitch_slots)
    coils = coils_of(rated_motor(160, 2 * pole_pairs), winding)
    N = winding.coils_per_phase()
    of_a = coils.fields[0, :N] * N
    assert sheet.coils_per_phase == N
    expected = sheet.coil_axes(pole_pairs)
    angles = sorted({round(float(angle), 9) for angle in np.angle(of_a)})
    assert angles == pytest.approx([axis.angle_rad for axis in expected], abs=1e-9)
    within = 0.2 if winding.kind == "concentric" else 1e-9  # the mean stands for all coils of a group there
    assert np.abs(of_a) == pytest.approx(np.full(N, expected[0].linkage), rel=within)
