"""Rules of the alarms of starts: hard ones are told, changed ones with their cause, and alike ones never."""

from collections.abc import Sequence
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.starts.changes import compare_starts
from core.starts.compared import Change, ChangeState, Quantity, StartCause, StartChanges
from core.starts.examined import ExaminedStart, StartParameters, StartTorque
from core.starts.notable import NOT_TOLD_APART, StartSeen, hard_starts, notable_change
from testing.service.starts import START

TIME_NS = 1_770_000_000_000_000_000
RATED_Nm = 100.0
INERTIA_Nms = 75.0


def start(time: float = 1.0, voltage: float = 1.0, load: float = 1.0, rotor: float = 1.0) -> ExaminedStart:
    """Return a start whose figures are so many times those of a usual one."""
    lasts_s = (START.acceleration_s or 0.0) * time
    volts = tuple(voltage * one for one in START.curve.voltage_V or ())
    load_Nm = 0.3 * RATED_Nm * load
    impulse_Nms = INERTIA_Nms + load_Nm * lasts_s
    torque = StartTorque(
        first_s=0.01,
        step_s=0.02,
        torque_Nm=(90.0,),
        speed=(None,),
        rated_torque_Nm=RATED_Nm,
        impulse_Nms=impulse_Nms,
        mean_torque_Nm=impulse_Nms / lasts_s,
        torque_at_rated_voltage_Nm=impulse_Nms / lasts_s / voltage**2,
        momentum_Nms=INERTIA_Nms,
        momentum_tolerance=0.0,
        load_torque_Nm=load_Nm,
        load_torque_Nm_ci95=None,
        running_torque_Nm=None,
    )
    values = {"rotor_resistance_ohm": 1.2 * rotor, "stator_resistance_ohm": 1.0}
    parameters = StartParameters(
        values, {name: (0.9 * one, 1.1 * one) for name, one in values.items()}, 0.3, None, "fan", 0.01, ()
    )
    figures = replace(START, acceleration_s=lasts_s, curve=replace(START.curve, voltage_V=volts))
    return ExaminedStart(figures, torque=torque, parameters=parameters)


SCATTER = st.floats(-1.0, 1.0)
ALIKE = st.builds(
    lambda time, voltage, load, rotor: start(
        1.0 + 0.03 * time, 1.0 + 0.005 * voltage, 1.0 + 0.05 * load, 1.0 + 0.03 * rotor
    ),
    SCATTER,
    SCATTER,
    SCATTER,
    SCATTER,
)
"""Starts that scatter by one and a half times what those of any motor do."""


@given(reference=st.lists(ALIKE, min_size=1, max_size=5), latest=st.lists(ALIKE, min_size=1, max_size=3))
def test_starts_that_are_alike_make_no_alarm(
    reference: Sequence[ExaminedStart], latest: Sequence[ExaminedStart]
) -> None:
    assert notable_change(compare_starts(latest, reference), len(latest)) is None


@given(
    within=st.integers(1, 50),
    allowed=st.none() | st.integers(1, 50),
    heat=st.none() | st.floats(0.0, 3.0),
)
def test_a_start_is_hard_by_its_limits_alone(within: int, allowed: int | None, heat: float | None) -> None:
    one = StartSeen(TIME_NS, within, allowed, heat, "motor file")
    is_hard = (allowed is not None and within > allowed) or (heat is not None and heat >= 0.9)
    assert bool(hard_starts([one])) is is_hard


def test_a_hard_start_says_how_often_and_how_hot() -> None:
    hard, usual = StartSeen(TIME_NS, 4, 2, 0.94, "motor file"), StartSeen(TIME_NS, 1, 2, 0.5)
    (found,) = hard_starts([usual, hard, usual])
    assert found.reasons == (
        "4 starts in the hour up to 2026-02-02T02:40:00Z, and 2 are allowed",
        "the start of 2026-02-02T02:40:00Z brought 94 % of the heat that the rotor withstands (motor file)",
    )
    assert hard_starts([usual, usual, usual, hard]) == []


@pytest.mark.parametrize(
    ("later", "causes", "words"),
    [
        (start(time=1.3, voltage=0.88), (StartCause.SUPPLY,), "Check the voltage"),
        (start(time=1.2, load=2.0), (StartCause.LOAD,), "Check what the motor drives"),
        (start(rotor=1.4), (StartCause.ROTOR,), "trend of the rotor"),
    ],
    ids=["weak supply", "sticking load", "worse rotor"],
)
def test_causes_are_told_with_what_to_do(
    later: ExaminedStart, causes: tuple[StartCause, ...], words: str
) -> None:
    found = compare_starts([later] * 3, [start()] * 5)
    told = notable_change(found, 3)
    assert told is not None
    assert told.causes == causes
    assert words in told.advice
    assert told.reason(TIME_NS, or_earlier=True).startswith(
        f"{causes[0].words}, since the start of 2026-02-02T02:40:00Z or earlier; "
    )
    assert told.is_seen_in(compare_starts([later], [start()] * 5))
    assert not told.is_seen_in(compare_starts([start()], [start()] * 5))
    assert notable_change(found, 1) is None


def test_longer_starts_without_a_cause_are_told_and_shorter_ones_not() -> None:
    bare = ExaminedStart(replace(START, lowest_voltage_V=None, curve=replace(START.curve, voltage_V=None)))

    def lasting(share: float) -> ExaminedStart:
        return replace(bare, figures=replace(bare.figures, acceleration_s=1.25 * share))

    longer = notable_change(compare_starts([lasting(1.5)] * 3, [bare] * 5), 3)
    assert longer is not None
    assert (longer.causes, longer.advice) == ((), NOT_TOLD_APART)
    assert notable_change(compare_starts([lasting(0.6)] * 3, [bare] * 5), 3) is None


@pytest.mark.parametrize("voltage", [0.97, 1.06], ids=["a little weaker", "stronger"])
def test_a_supply_that_makes_no_start_longer_is_no_alarm(voltage: float) -> None:
    found = compare_starts([start(voltage=voltage)] * 3, [start()] * 5)
    assert found.causes == (StartCause.SUPPLY,)
    assert notable_change(found, 3) is None


def test_warm_windings_are_no_alarm() -> None:
    warm = Change(Quantity.WARMTH, 1.2, 1.0, 0.2, (0.1, 0.3), 0.05)
    found = StartChanges(ChangeState.AS_BEFORE, (StartCause.WARMTH,), (), (warm,), None, None, (warm.words,))
    assert notable_change(found, 3) is None
