"""Tells why starts have become other than they were: the supply, the load, the rotor, or not told apart.

    supply   mean voltage of the run-up over the rated one
    load     mean load torque of the run-up over the rated torque, by the balance of torque and momentum
    rotor    R_r' by commissioning over R_s of the same start, so that warmth common to both drops out; and
             the sideband's path, which shows broken bars long before R_r' does
    warmth   R_s by commissioning: no fault, but a warm motor starts in another time

Starts are compared with the first ones of the motor. The scatter of either side is pooled with what starts of
any motor scatter by at least (`USUAL_SCATTER`, worth four starts), so that two starts that happen to be alike
do not make a small difference a certain one. What a voltage or a load makes of the time follows from

    t = J w / (mean torque (V / V_0)^2 - load torque)
"""

from collections.abc import Callable, Sequence
from math import hypot, inf, isfinite, sqrt
from statistics import fmean
from typing import Final

from core.diagnosis.student_t import student_t_quantile
from core.rotor.finding import RotorState
from core.starts.compared import Change, ChangeState, Quantity, StartCause, StartChanges
from core.starts.examined import ExaminedStart, Interval
from core.starts.figures import MotorStart

REFERENCE_STARTS: Final = 5
"""First whole starts that later ones are compared with."""
USUAL_SCATTER: Final = {
    Quantity.ACCELERATION: 0.02,
    Quantity.VOLTAGE: 0.003,
    Quantity.LOAD: 0.015,
    Quantity.ROTOR: 0.015,
    Quantity.WARMTH: 0.01,
}
"""Standard deviation from start to start of a motor that stays as it is, as its figures are measured."""
WORTH: Final = 4
"""Starts that the usual scatter is worth."""
RELEVANT: Final = {
    Quantity.ACCELERATION: 0.1,
    Quantity.VOLTAGE: 0.02,
    Quantity.LOAD: 0.1,
    Quantity.ROTOR: 0.1,
    Quantity.WARMTH: 0.05,
}
"""Changes below these are not told. Shares; of the load, shares of the rated torque."""
CAGE_WARMER: Final = 0.1
"""Share by which the cage's resistance may differ with its temperature against the stator's: 25 K."""
CAGE_OR_WINDING_WARMER: Final = 0.25
"""The same where the stator's resistance is not known either."""
SIDEBAND_GROWN_dB: Final = 3.0
CAUSES: Final = {
    Quantity.VOLTAGE: StartCause.SUPPLY,
    Quantity.LOAD: StartCause.LOAD,
    Quantity.ROTOR: StartCause.ROTOR,
    Quantity.WARMTH: StartCause.WARMTH,
}


def reference_starts(starts: Sequence[ExaminedStart]) -> Sequence[ExaminedStart]:
    """Return the starts that later ones are compared with.

    Parameters
    ----------
    starts : sequence of ExaminedStart
        Starts of a motor in the order of time.

    Returns
    -------
    sequence of ExaminedStart
        The first few of those that were recorded from rest to speed.
    """
    whole = [one for one in starts if one.figures.is_from_rest and one.figures.acceleration_s is not None]
    return whole[:REFERENCE_STARTS]


def compare_starts(latest: Sequence[ExaminedStart], reference: Sequence[ExaminedStart]) -> StartChanges:
    """Compare starts with those of the reference.

    Parameters
    ----------
    latest : sequence of ExaminedStart
        One start, or a few that are taken together.
    reference : sequence of ExaminedStart
        Starts of the motor as it should be.

    Returns
    -------
    StartChanges
        What has changed, and why.
    """
    if not latest or not reference:
        return StartChanges.unknown("there is no start from rest to speed to compare with")
    momentum = _momentum(reference)
    changes = {
        Quantity.ACCELERATION: _share(Quantity.ACCELERATION, latest, reference, _run_up(reference)),
        Quantity.VOLTAGE: _share(Quantity.VOLTAGE, latest, reference, mean_voltage_V),
        Quantity.LOAD: _load_change(latest, reference, momentum),
        Quantity.ROTOR: _rotor_change(latest, reference),
        Quantity.WARMTH: _share(Quantity.WARMTH, latest, reference, _stator_resistance_ohm),
    }
    found = {quantity: one for quantity, one in changes.items() if one is not None}
    causes = [CAUSES[one] for one in found if one in CAUSES and found[one].is_told]
    reasons = [one.words for one in found.values() if one.is_told]
    sideband = _grown_sideband(latest, reference)
    if sideband is not None:
        reasons.append(sideband)
        if StartCause.ROTOR not in causes:
            causes.append(StartCause.ROTOR)
    if any(one.figures.is_from_rest and one.figures.acceleration_s is None for one in latest):
        reasons.append("the record ends before the motor is up to speed")
    possible: list[StartCause] = []
    acceleration = found.get(Quantity.ACCELERATION)
    if acceleration is not None and acceleration.is_told and not causes:
        possible = [CAUSES[one] for one in CAUSES if one not in found or found[one].may_be_relevant]
        reasons.append(_not_told_apart(possible, found))
    if set(causes) - {StartCause.WARMTH}:
        state = ChangeState.CHANGED
    elif causes:
        state = ChangeState.AS_BEFORE
    elif acceleration is not None and acceleration.is_told:
        state = ChangeState.NOT_TOLD_APART
    else:
        state = ChangeState.AS_BEFORE if found else ChangeState.UNKNOWN
    return StartChanges(
        state=state,
        causes=tuple(causes),
        possible=tuple(possible),
        changes=tuple(found.values()),
        voltage_effect=_voltage_effect(found.get(Quantity.VOLTAGE), reference, momentum),
        load_effect=_load_effect(found.get(Quantity.LOAD), reference, momentum),
        reasons=tuple(reasons),
    )


def mean_voltage_V(start: ExaminedStart) -> float | None:
    """Return the mean rms voltage of the run-up, line to line.

    Parameters
    ----------
    start : ExaminedStart
        The start.

    Returns
    -------
    float or None
        Voltage [V]; None where none was recorded.
    """
    figures: MotorStart = start.figures
    volts = figures.curve.voltage_V
    if not volts:
        return figures.lowest_voltage_V
    points = max(1, round(figures.i2t_over_s / figures.curve.step_s))
    return fmean(volts[:points])


def _run_up(reference: Sequence[ExaminedStart]) -> Callable[[ExaminedStart], float | None]:
    """Return what tells how long a start takes, or took at least where its record ends before it does."""
    usual_s = max(_known(reference, _acceleration), default=inf)

    def run_up(start: ExaminedStart) -> float | None:
        figures = start.figures
        if figures.acceleration_s is None and figures.is_from_rest and figures.i2t_over_s > usual_s:
            return figures.i2t_over_s
        return figures.acceleration_s

    return run_up


def _acceleration(start: ExaminedStart) -> float | None:
    return start.figures.acceleration_s


def _share(
    quantity: Quantity,
    latest: Sequence[ExaminedStart],
    reference: Sequence[ExaminedStart],
    of: Callable[[ExaminedStart], float | None],
    *,
    systematic: float = 0.0,
) -> Change | None:
    """Return how far a figure of the latest starts is from that of the reference, as a share of it."""
    before, now = _known(reference, of), _known(latest, of)
    if not before or not now or not fmean(before) > 0.0:
        return None
    base = fmean(before)
    shares = [one / base for one in now], [one / base for one in before]
    return _change(quantity, shares[0], shares[1], systematic, value=fmean(now), reference=base)


def _change(
    quantity: Quantity,
    now: Sequence[float],
    before: Sequence[float],
    systematic: float,
    *,
    value: float,
    reference: float,
) -> Change:
    """Return the difference of two means with its interval, scatter pooled with the usual one."""
    freedom = len(now) + len(before) - 2
    squares = sum((one - fmean(group)) ** 2 for group in (now, before) for one in group)
    variance = (WORTH * USUAL_SCATTER[quantity] ** 2 + squares) / (WORTH + freedom)
    quantile = student_t_quantile(0.975, WORTH + freedom)
    half = hypot(quantile * sqrt(variance * (1.0 / len(now) + 1.0 / len(before))), systematic)
    change = fmean(now) - fmean(before)
    return Change(quantity, value, reference, change, (change - half, change + half), RELEVANT[quantity])


def _known(starts: Sequence[ExaminedStart], of: Callable[[ExaminedStart], float | None]) -> Sequence[float]:
    return [value for one in starts if (value := of(one)) is not None and isfinite(value)]


def _momentum(reference: Sequence[ExaminedStart]) -> tuple[float, float] | None:
    """Return momentum at speed [N m s] and the share by which it may be off, by the reference's starts."""
    known = [
        one.torque for one in reference if one.torque is not None and one.torque.momentum_Nms is not None
    ]
    if not known:
        return None
    values = [one.momentum_Nms for one in known if one.momentum_Nms is not None]
    return fmean(values), max(one.momentum_tolerance for one in known)


def _load_change(
    latest: Sequence[ExaminedStart], reference: Sequence[ExaminedStart], momentum: tuple[float, float] | None
) -> Change | None:
    """Compare the loads with one momentum for all: what it is off by is the same in all starts."""
    if momentum is None:
        return None

    def load(start: ExaminedStart) -> float | None:
        time_s = start.figures.acceleration_s
        if start.torque is None or time_s is None:
            return None
        return (start.torque.impulse_Nms - momentum[0]) / time_s / start.torque.rated_torque_Nm

    before, now = _known(reference, load), _known(latest, load)
    if not before or not now:
        return None
    rated_Nm = fmean(one.torque.rated_torque_Nm for one in reference if one.torque is not None)
    slower = 1.0 / fmean(_known(latest, _acceleration)) - 1.0 / fmean(_known(reference, _acceleration))
    highest = fmean(one.torque.impulse_Nms for one in reference if one.torque is not None)
    off_Nms = min(momentum[0] * momentum[1], max(highest, momentum[0]))
    systematic = abs(off_Nms * slower) / rated_Nm
    return _change(Quantity.LOAD, now, before, systematic, value=fmean(now), reference=fmean(before))


def _rotor_change(latest: Sequence[ExaminedStart], reference: Sequence[ExaminedStart]) -> Change | None:
    def over_stator(start: ExaminedStart) -> float | None:
        rotor, stator = _rotor_resistance_ohm(start), _stator_resistance_ohm(start)
        return None if rotor is None or stator is None else rotor / stator

    change = _share(Quantity.ROTOR, latest, reference, over_stator, systematic=CAGE_WARMER)
    if change is not None:
        return change
    return _share(Quantity.ROTOR, latest, reference, _rotor_resistance_ohm, systematic=CAGE_OR_WINDING_WARMER)


def _rotor_resistance_ohm(start: ExaminedStart) -> float | None:
    return _told_by_record(start, "rotor_resistance_ohm")


def _stator_resistance_ohm(start: ExaminedStart) -> float | None:
    return _told_by_record(start, "stator_resistance_ohm")


def _told_by_record(start: ExaminedStart, name: str) -> float | None:
    """Return a parameter that the start tells; one that was held at the motor file's tells nothing."""
    found = start.parameters
    return found.values[name] if found is not None and name in found.ci95 else None


def _grown_sideband(latest: Sequence[ExaminedStart], reference: Sequence[ExaminedStart]) -> str | None:
    """Return in words that broken bars show now and not before; None where they do not."""
    bad = (RotorState.WATCH, RotorState.FAULT)
    now = [one.sideband for one in latest if one.sideband is not None and one.sideband.state in bad]
    known = [one.severity_dB for one in now if one.severity_dB is not None]
    if not known or 2 * len(now) <= len(latest) - sum(one.sideband is None for one in latest):
        return None
    before = [one.sideband for one in reference if one.sideband is not None]
    had = max(
        (one.severity_dB for one in before if one.state in bad and one.severity_dB is not None), default=-inf
    )
    if fmean(known) < had + SIDEBAND_GROWN_dB:
        return None
    return f"the rotor's asymmetry of {fmean(known):.0f} dB follows the slip through the start"


def _not_told_apart(possible: Sequence[StartCause], found: dict[Quantity, Change]) -> str:
    if not possible:
        return (
            "supply, load and rotor are each as before within their intervals: record further starts, and "
            "check the coupling and what the motor drives"
        )
    names = " or ".join(one.words for one in possible)
    missing = [CAUSES[one].words for one in CAUSES if one not in found]
    help_ = f"; nothing is known of {', '.join(missing)}" if missing else ""
    return f"not told apart: {names}{help_}. Record further starts with all voltages, from rest to speed"


def _voltage_effect(
    change: Change | None, reference: Sequence[ExaminedStart], momentum: tuple[float, float] | None
) -> Interval | None:
    """Return the shares by which the change of voltage alone makes the run-up longer, by its interval."""
    balance = _balance(reference, momentum)
    if change is None or balance is None:
        return None
    torque, load = balance
    return _ends([_longer(torque, load, torque * (1.0 + end) ** 2, load) for end in change.ci95])


def _load_effect(
    change: Change | None, reference: Sequence[ExaminedStart], momentum: tuple[float, float] | None
) -> Interval | None:
    """Return the shares by which the change of load alone makes the run-up longer, by its interval."""
    balance = _balance(reference, momentum)
    if change is None or balance is None:
        return None
    torque, load = balance
    return _ends([_longer(torque, load, torque, load + end) for end in change.ci95])


def _balance(
    reference: Sequence[ExaminedStart], momentum: tuple[float, float] | None
) -> tuple[float, float] | None:
    """Return mean torque and load of the reference's run-ups, both over the rated torque."""
    known = [(one.torque, one.figures.acceleration_s) for one in reference if one.torque is not None]
    whole = [(torque, time_s) for torque, time_s in known if time_s is not None]
    if momentum is None or not whole:
        return None
    torque = fmean(one.mean_torque_Nm / one.rated_torque_Nm for one, _ in whole)
    return torque, torque - fmean(momentum[0] / time_s / one.rated_torque_Nm for one, time_s in whole)


def _longer(torque: float, load: float, torque_now: float, load_now: float) -> float:
    left = torque_now - load_now
    return (torque - load) / left - 1.0 if left > 0.0 else inf


def _ends(values: Sequence[float]) -> Interval | None:
    return (min(values), max(values)) if all(map(isfinite, values)) else None
