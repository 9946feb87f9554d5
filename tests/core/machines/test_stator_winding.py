"""Axes and linkages of the coils of a stator, against the star of slots, coil by coil."""

import cmath
from math import cos, degrees, pi, radians

import pytest
from hypothesis import given, reject
from hypothesis import strategies as st

from core.machines.stator_winding import StatorWinding, WindingError, WindingKind, check_winding

LAP, CONCENTRIC = WindingKind.LAP, WindingKind.CONCENTRIC


def slot_phasor(slot: int, slots: int, pole_pairs: int) -> complex:
    return cmath.exp(2j * pi * pole_pairs * slot / slots)


def flux_of_coil(start: int, end: int, slots: int, pole_pairs: int) -> complex:
    """Flux of the fundamental field through a turn from slot to slot, 1 where it spans a pole.

    The turn's MMF is a step up at one side and a step down at the other one; its fundamental is their
    difference, a quarter of a turn behind.
    """
    return (slot_phasor(end, slots, pole_pairs) - slot_phasor(start, slots, pole_pairs)) / 2j


def coils_of_a_phase(slots: int, pole_pairs: int, pitch: int) -> list[complex]:
    """Coils of two layers that start in the sectors of the star of slots of one phase, as each is wound."""
    found = []
    for slot in range(slots):
        # A hundredth of a slot keeps phasors off the borders of the sectors.
        angle = (360.0 * pole_pairs * slot / slots + 0.01 * 360.0 / slots) % 360.0
        if angle < 60.0:
            found.append(flux_of_coil(slot, slot + pitch, slots, pole_pairs))
        elif 180.0 <= angle < 240.0:
            found.append(-flux_of_coil(slot, slot + pitch, slots, pole_pairs))
    return found


def axes_and_linkages(coils: list[complex]) -> dict[int, float]:
    """Linkage of a turn over that of the mean one, by its axis in ten-thousandths of a degree."""
    mean = sum(coils) / len(coils)
    return {round(1e4 * degrees(cmath.phase(one / mean))): abs(one) / abs(mean) for one in coils}


def computed(winding: StatorWinding, pole_pairs: int) -> dict[int, float]:
    return {round(1e4 * degrees(one.angle_rad)): one.linkage for one in winding.coil_axes(pole_pairs)}


def compare(found: dict[int, float], expected: dict[int, float]) -> None:
    assert found.keys() == expected.keys()
    for axis, linkage in expected.items():
        assert found[axis] == pytest.approx(linkage, rel=1e-9)


@pytest.mark.parametrize(
    ("slots", "poles", "axes_deg", "distribution"),
    [
        (24, 4, (-15.0, 15.0), 0.966),
        (36, 4, (-20.0, 0.0, 20.0), 0.960),
        (48, 4, (-22.5, -7.5, 7.5, 22.5), 0.958),
        (36, 2, (-25.0, -15.0, -5.0, 5.0, 15.0, 25.0), 0.956),
        (54, 6, (-20.0, 0.0, 20.0), 0.960),
    ],
)
def test_axes_of_usual_lap_windings(
    slots: int, poles: int, axes_deg: tuple[float, ...], distribution: float
) -> None:
    axes = StatorWinding(LAP, slots).coil_axes(poles // 2)
    assert [degrees(one.angle_rad) for one in axes] == pytest.approx(list(axes_deg))
    for one in axes:
        assert 1.0 / one.linkage == pytest.approx(distribution, abs=5e-4)


@pytest.mark.parametrize(
    ("slots", "pole_pairs"),
    [
        (24, 2),
        (36, 2),
        (48, 2),
        (36, 1),
        (54, 3),
        (72, 4),
        (27, 3),
        (30, 2),
        (45, 3),
        (54, 4),
        (36, 5),
        (42, 4),
    ],
)
@pytest.mark.parametrize("shortened", [0, 1, 2])
def test_lap_windings_against_the_star_of_slots(slots: int, pole_pairs: int, shortened: int) -> None:
    pitch = max(1, round(slots / (2 * pole_pairs)) - shortened)
    winding = StatorWinding(LAP, slots, coil_pitch_slots=pitch)
    coils = coils_of_a_phase(slots, pole_pairs, pitch)
    assert len(coils) == winding.coils_per_phase
    compare(computed(winding, pole_pairs), axes_and_linkages(coils))


@given(pole_pairs=st.integers(1, 12), thirds=st.integers(1, 60))
def test_every_balanced_winding_is_as_the_star_of_slots_has_it(pole_pairs: int, thirds: int) -> None:
    winding = StatorWinding(LAP, 3 * thirds)
    try:
        check_winding(winding, pole_pairs)
    except WindingError:
        reject()
    coils = coils_of_a_phase(winding.slots, pole_pairs, max(1, round(winding.slots / (2 * pole_pairs))))
    assert len(coils) == winding.coils_per_phase
    compare(computed(winding, pole_pairs), axes_and_linkages(coils))
    axes = winding.coil_axes(pole_pairs)
    assert sum(one.linkage * cos(one.angle_rad) for one in axes) == pytest.approx(len(axes))


@pytest.mark.parametrize(
    ("slots", "pole_pairs", "pitch", "coils"),
    [
        (24, 2, 6, [(0, 6), (1, 7)]),
        (24, 2, 5, [(1, 6), (7, 12)]),
        (48, 2, 10, [(2, 12), (3, 13), (14, 24), (15, 25)]),
        (48, 2, 11, [(1, 12), (3, 14), (13, 24), (15, 26)]),
        (36, 2, 8, [(1, 9), (2, 10), (11, 18)]),
        (36, 2, 7, [(1, 9), (2, 10), (11, 18)]),
        (36, 3, 5, [(1, 6), (7, 12)]),
    ],
)
def test_one_layer_against_its_coils(
    slots: int, pole_pairs: int, pitch: int, coils: list[tuple[int, int]]
) -> None:
    """Coils that begin on the second pole are wound the other way round."""
    pole = slots // (2 * pole_pairs)
    turns = [
        (1 if start < pole else -1) * flux_of_coil(start, end, slots, pole_pairs) for start, end in coils
    ]
    winding = StatorWinding(LAP, slots, layers=1, coil_pitch_slots=pitch)
    compare(computed(winding, pole_pairs), axes_and_linkages(turns))


def test_one_layer_of_unknown_pitch_may_be_a_chain() -> None:
    axes = StatorWinding(LAP, 36, layers=1).coil_axes(2)
    assert [round(degrees(one.angle_rad)) for one in axes] == [-20, -10, 0, 0, 10, 20]


def test_concentric_coils_lie_on_the_axis_of_their_phase() -> None:
    (axis,) = StatorWinding(CONCENTRIC, 36, layers=1).coil_axes(2)
    assert (axis.angle_rad, axis.linkage) == (0.0, 1.0)


@pytest.mark.parametrize(("layers", "coils"), [(2, 12), (1, 6)])
def test_coils_of_a_phase(layers: int, coils: int) -> None:
    assert StatorWinding(LAP, 36, layers=layers).coils_per_phase == coils


@pytest.mark.parametrize(("pitch", "is_full"), [(9, True), (8, False), (None, False)])
def test_full_pitch(pitch: int | None, is_full: bool) -> None:
    assert StatorWinding(LAP, 36, coil_pitch_slots=pitch).is_full_pitch(2) is is_full


@pytest.mark.parametrize(
    ("winding", "pole_pairs", "figure", "words"),
    [
        (StatorWinding(LAP, 36, layers=3), 2, "layers", "1 or 2"),
        (StatorWinding(LAP, 35), 2, "slots", "a multiple of 3"),
        (StatorWinding(LAP, 27), 5, "slots", "at least 30 for 10 poles"),
        (StatorWinding(LAP, 6), 2, "slots", "at least 12 for 4 poles"),
        (StatorWinding(LAP, 27, layers=1), 3, "slots", "a multiple of 6"),
        (StatorWinding(LAP, 63), 9, "slots", "three phases of 18 poles are alike, such as 54 or 108"),
        (StatorWinding(LAP, 30), 3, "slots", "such as 18 or 36"),
        (StatorWinding(LAP, 36, coil_pitch_slots=19), 2, "coil_pitch_slots", "a pole has 9"),
        (StatorWinding(LAP, 36, coil_pitch_slots=0), 2, "coil_pitch_slots", "1 to 18"),
    ],
)
def test_a_winding_that_cannot_be_wound(
    winding: StatorWinding, pole_pairs: int, figure: str, words: str
) -> None:
    with pytest.raises(WindingError) as refused:
        winding.coil_axes(pole_pairs)
    assert refused.value.figure == figure
    assert words in refused.value.expected
    assert str(refused.value).startswith(f"{figure} is {refused.value.found}: expected ")


def test_axes_are_in_the_order_of_their_angles() -> None:
    for winding in (StatorWinding(LAP, 48), StatorWinding(LAP, 48, 1), StatorWinding(LAP, 36, 1, 8)):
        angles = [one.angle_rad for one in winding.coil_axes(2)]
        assert angles == sorted(angles)
        assert max(angles) <= radians(30.0)
