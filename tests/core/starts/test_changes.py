"""Why starts have changed: supply, load and rotor told apart on simulated starts of two motors."""

from dataclasses import replace

import pytest

from core.machines.parameters import Motor
from core.starts.changes import compare_starts, reference_starts
from core.starts.compared import ChangeState, Quantity, StartCause
from core.starts.examined import ExaminedStart
from core.starts.examining import examine_start
from testing.machines.motors import LARGE, MEDIUM
from testing.machines.starts import StartRecord, with_parameters
from testing.service.starts import START

DRIVING = with_parameters(MEDIUM, inertia_kgm2=8.0 * MEDIUM.parameters.inertia_kgm2)
USUAL = StartRecord(load_level=0.4, duration_s=1.5, snr_db=45.0)


@pytest.fixture(scope="module", params=[DRIVING, LARGE], ids=lambda motor: motor.name)
def motor(request: pytest.FixtureRequest) -> Motor:
    found: Motor = request.param
    return found


@pytest.fixture(scope="module")
def reference(motor: Motor) -> list[ExaminedStart]:
    starts = [replace(USUAL, switched_at_s=at_s, seed=k) for k, at_s in enumerate((0.003, 0.014))]
    return [examine_start(one.of(motor), motor) for one in starts]


@pytest.mark.parametrize(
    ("record", "causes"),
    [
        (replace(USUAL, seed=9), set()),
        (replace(USUAL, voltage=0.91), {StartCause.SUPPLY}),
        (replace(USUAL, load_level=0.65), {StartCause.LOAD}),
        (replace(USUAL, resistances=(1.0, 1.5)), {StartCause.ROTOR}),
        (replace(USUAL, resistances=(1.24, 1.24)), {StartCause.WARMTH}),
        (replace(USUAL, voltage=0.91, load_level=0.65), {StartCause.SUPPLY, StartCause.LOAD}),
    ],
    ids=["as before", "weak supply", "sticking load", "rotor", "warm", "supply and load"],
)
def test_the_cause_is_told(
    motor: Motor, reference: list[ExaminedStart], record: StartRecord, causes: set[StartCause]
) -> None:
    changes = compare_starts([examine_start(record.of(motor), motor)], reference)

    assert set(changes.causes) == causes
    faults = causes - {StartCause.WARMTH}
    assert changes.state is (ChangeState.CHANGED if faults else ChangeState.AS_BEFORE)
    for one in changes.changes:
        assert one.ci95[0] <= one.change <= one.ci95[1]


def test_a_weaker_supply_explains_the_time(motor: Motor, reference: list[ExaminedStart]) -> None:
    late = examine_start(replace(USUAL, voltage=0.91).of(motor), motor)

    changes = compare_starts([late], reference)

    (time,) = (one for one in changes.changes if one.quantity is Quantity.ACCELERATION)
    assert changes.voltage_effect is not None
    low, high = changes.voltage_effect
    assert low - 0.15 <= time.change <= high + 0.15
    assert low > 0.1


def test_figures_alone_do_not_tell_load_and_rotor_apart() -> None:
    without = ExaminedStart(replace(START, lowest_voltage_V=None, curve=replace(START.curve, voltage_V=None)))
    later = replace(without, figures=replace(without.figures, acceleration_s=1.8))

    changes = compare_starts([later], [without, without])

    assert changes.state is ChangeState.NOT_TOLD_APART
    assert set(changes.possible) == set(StartCause)
    assert "not told apart" in changes.reasons[-1]


def test_a_report_s_voltage_tells_a_weak_supply() -> None:
    plain = ExaminedStart(START)
    weak = replace(START.curve, voltage_V=tuple(0.9 * one for one in START.curve.voltage_V or ()))
    later = ExaminedStart(replace(START, acceleration_s=1.6, curve=weak))

    changes = compare_starts([later], [plain, plain, plain])

    assert changes.causes == (StartCause.SUPPLY,)


def test_one_start_that_scatters_is_no_change() -> None:
    times = (1.2, 1.3, 1.1, 1.25)
    before = [ExaminedStart(replace(START, acceleration_s=one)) for one in times]

    changes = compare_starts([ExaminedStart(replace(START, acceleration_s=1.35))], before)

    assert changes.state is ChangeState.AS_BEFORE


def test_a_motor_that_does_not_come_to_speed_is_no_motor_as_before() -> None:
    hangs = ExaminedStart(replace(START, acceleration_s=None, running_current_A=None, i2t_over_s=2.0))
    short = ExaminedStart(replace(START, acceleration_s=None, running_current_A=None, i2t_over_s=0.5))
    before = [ExaminedStart(START)] * 3

    assert compare_starts([hangs], before).state is ChangeState.NOT_TOLD_APART
    assert "before the motor is up to speed" in " ".join(compare_starts([hangs], before).reasons)
    assert compare_starts([short], before).state is ChangeState.AS_BEFORE


def test_the_reference_is_the_first_whole_starts() -> None:
    part = ExaminedStart(replace(START, acceleration_s=None))
    whole = [ExaminedStart(replace(START, acceleration_s=float(k))) for k in range(1, 9)]

    assert reference_starts([part, *whole]) == whole[:5]
    assert compare_starts(whole, []).state is ChangeState.UNKNOWN
