"""The condition of a motor: what a plant acts on, and the document in which it is told and kept."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, cast

from core.condition.assessment import (
    PHASES,
    STALE_AFTER_NS,
    Assessment,
    Declared,
    Level,
    ParameterError,
    Phase,
    Reference,
)
from core.condition.events import Event
from core.condition.forecast.forecast import Forecast, forecast, limit_ahead
from core.condition.kinds import Kind, State
from core.condition.severity import Interval, level_of, of_one_fault, stands_out
from core.condition.verdict.advice import advice
from core.condition.verdict.reasons import reason_of_unknown, reasons_of
from core.condition.verdict.verdict import Verdict, verdict_of
from core.machines.parameters import Motor
from core.machines.typical import TYPICAL_REASON
from core.machines.winding_frame import Winding
from core.time_stamps import nanoseconds, rfc3339


@dataclass(frozen=True, slots=True)
class Condition:
    """The condition of a motor over time.

    Parameters
    ----------
    motor : str
        Name of the motor.
    state : State
        State of the motor.
    kind : Kind
        What has changed, or stands out from the first record on.
    candidates : tuple of Kind
        What an unclear kind may be, likeliest first; empty otherwise.
    phase : {"a", "b", "c"} or None
        Phase of the fault, the channel or the joint, at the terminals.
    mu_f : float or None
        Fault level in all, a fraction of the phase turns; None before the first record.
    mu_f_ci95 : tuple of float or None
        Its 95 % interval from all causes: noise, sensors, parameters.
    change : float or None
        Change of the fault level since the reference; None before the reference is complete. Where the kind
        is unclear, it is the change if it is shorted turns.
    change_ci95 : tuple of float or None
        Its 95 % interval; None where no change of the level is seen.
    size : float or None
        Size of the change in its own measure: relative error of a channel, voltage drop of a joint over
        rated voltage, level of shorted turns; None where no change is seen, or one without such a measure.
    size_ci95 : tuple of float or None
        Its 95 % interval; None where there is no size.
    since_ns : int or None
        Time of the first record that shows the change, UTC [ns].
    forecast : Forecast
        Growth of the level and time until a limit.
    reference : Reference or None
        What the change is counted from; None before the first record.
    as_of_ns : int or None
        Time of the latest valid record, UTC [ns].
    stale : bool
        Whether that record is too old.
    advice : str
        What to do, in words.
    reasons : tuple of str
        Why, in words.
    """

    motor: str
    state: State
    kind: Kind
    candidates: tuple[Kind, ...]
    phase: Phase | None
    mu_f: float | None
    mu_f_ci95: Interval | None
    change: float | None
    change_ci95: Interval | None
    size: float | None
    size_ci95: Interval | None
    since_ns: int | None
    forecast: Forecast
    reference: Reference | None
    as_of_ns: int | None
    stale: bool
    advice: str
    reasons: tuple[str, ...]

    def seen_at(self, now_ns: int, stale_after_ns: int = STALE_AFTER_NS) -> "Condition":
        """Return the same condition as it is seen at another time: only `stale` may differ.

        Parameters
        ----------
        now_ns : int
            Time at which it is looked at, UTC [ns].
        stale_after_ns : int, optional
            Longest age of the latest record [ns].

        Returns
        -------
        Condition
            The condition.
        """
        return replace(self, stale=_is_stale(self.as_of_ns, now_ns, stale_after_ns))

    def as_dict(self) -> dict[str, object]:
        """Return the document that `mcc follow --json` prints, without its history; its keys are a contract.

        Returns
        -------
        dict of str to object
            The document.
        """
        return {
            "motor": self.motor,
            "state": str(self.state),
            "kind": str(self.kind),
            "candidates": [str(kind) for kind in self.candidates],
            "phase": self.phase,
            "mu_f": self.mu_f,
            "mu_f_ci95": _listed(self.mu_f_ci95),
            "change": self.change,
            "change_ci95": _listed(self.change_ci95),
            "size": self.size,
            "size_ci95": _listed(self.size_ci95),
            "since": _time(self.since_ns),
            "growth_per_day": self.forecast.growth_per_day,
            "forecast": {"limit": self.forecast.limit, "days": _listed(self.forecast.days)},
            "reference": _reference_document(self.reference),
            "as_of": _time(self.as_of_ns),
            "stale": self.stale,
            "advice": self.advice,
            "reasons": list(self.reasons),
        }

    @classmethod
    def from_dict(cls, document: Mapping[str, Any]) -> "Condition":
        """Return the condition that a document tells.

        Parameters
        ----------
        document : mapping
            What `as_dict` returned; further keys are left out. Those of earlier versions have no
            `size_ci95` and no `accepted_level`.

        Returns
        -------
        Condition
            The condition.

        Raises
        ------
        KeyError, TypeError, ValueError
            If it is no such document.
        """
        forecast, reference = document["forecast"], document["reference"]
        days = forecast["days"]
        return cls(
            motor=document["motor"],
            state=State(document["state"]),
            kind=Kind(document["kind"]),
            candidates=tuple(Kind(kind) for kind in document["candidates"]),
            phase=document["phase"],
            mu_f=document["mu_f"],
            mu_f_ci95=_interval(document["mu_f_ci95"]),
            change=document["change"],
            change_ci95=_interval(document["change_ci95"]),
            size=document["size"],
            size_ci95=_interval(document.get("size_ci95")),
            since_ns=_time_ns(document["since"]),
            forecast=Forecast(
                limit=forecast["limit"],
                days=None if days is None else (days[0], days[1], days[2]),
                growth_per_day=document["growth_per_day"],
            ),
            reference=_reference(reference),
            as_of_ns=_time_ns(document["as_of"]),
            stale=document["stale"],
            advice=document["advice"],
            reasons=tuple(document["reasons"]),
        )


def condition_of(
    motor: Motor,
    assessment: Assessment | None,
    now_ns: int,
    stale_after_ns: int = STALE_AFTER_NS,
    *,
    ended_by: Event | None = None,
) -> Condition:
    """Judge a motor from what its records tell.

    Parameters
    ----------
    motor : Motor
        The motor, with its limits.
    assessment : Assessment or None
        What the records tell; None before the first valid one.
    now_ns : int
        Time at which the condition is looked at, UTC [ns].
    stale_after_ns : int, optional
        Longest age of the latest record [ns].
    ended_by : Event or None, optional
        The event that ended the reference, where there is no record since.

    Returns
    -------
    Condition
        The condition.
    """
    limit = motor.limits.fault_level
    verdict = verdict_of(assessment, motor)
    if assessment is None or verdict.mu_f is None:
        return _unknown(motor, ended_by)
    fault = of_one_fault(assessment, limit)
    state, kind = verdict.state, verdict.kind
    size, size_ci95 = _size(fault, verdict)
    is_gone = state is State.WATCH and fault.change is not None and fault.change.until_ns is not None
    ahead = _forecast(fault, level_of(fault.change), verdict.mu_f, limit)
    misfits = _misfits(assessment, verdict)
    return Condition(
        motor=motor.name,
        state=state,
        kind=kind,
        candidates=verdict.candidates,
        phase=verdict.phase,
        mu_f=verdict.mu_f,
        mu_f_ci95=verdict.mu_f_ci95,
        change=verdict.change,
        change_ci95=verdict.change_ci95,
        size=size,
        size_ci95=size_ci95,
        since_ns=_since(fault, limit),
        forecast=ahead,
        reference=assessment.reference,
        as_of_ns=assessment.as_of_ns,
        stale=_is_stale(assessment.as_of_ns, now_ns, stale_after_ns),
        advice=advice(
            state,
            kind,
            phase=verdict.phase,
            candidates=verdict.candidates,
            is_gone=is_gone,
            is_typical=motor.is_typical,
            misfits=[one.name for one in misfits],
        ),
        reasons=(*_of_parameters(motor, misfits), *reasons_of(assessment, limit, ahead)),
    )


def _unknown(motor: Motor, ended_by: Event | None) -> Condition:
    return Condition(
        motor=motor.name,
        state=State.UNKNOWN,
        kind=Kind.NONE,
        candidates=(),
        phase=None,
        mu_f=None,
        mu_f_ci95=None,
        change=None,
        change_ci95=None,
        size=None,
        size_ci95=None,
        since_ns=None,
        forecast=Forecast(motor.limits.fault_level),
        reference=None,
        as_of_ns=None,
        stale=True,
        advice=advice(State.UNKNOWN, Kind.NONE, is_typical=motor.is_typical),
        reasons=(*_of_parameters(motor), reason_of_unknown(ended_by)),
    )


def _misfits(assessment: Assessment, verdict: Verdict) -> tuple[ParameterError, ...]:
    """Return the parameters to be told of: shorted turns draw a current of their own, which looks alike."""
    are_seen = verdict.mu_f_ci95 is not None and verdict.mu_f_ci95[0] > 0.0
    return () if are_seen or Kind.SHORTED_TURNS in verdict.candidates else assessment.parameter_errors


def _of_parameters(motor: Motor, errors: tuple[ParameterError, ...] = ()) -> tuple[str, ...]:
    if motor.is_typical:
        return (TYPICAL_REASON,)
    if not errors:
        return ()
    names = ", ".join(one.name for one in errors)
    figures = "; ".join(str(one) for one in errors)
    return (
        f"the parameters in the motor's file do not fit its records ({names}): commission this motor. Of the "
        f"file's, the motor has {figures}",
    )


def _since(assessment: Assessment, limit: float) -> int | None:
    """Return when it began. A standing fault was there from the first record on, whatever it grew by."""
    if assessment.change is not None and not assessment.standing_fault:
        return assessment.change.since_ns
    return assessment.reference.since_ns if stands_out(assessment, limit) else None


def _size(assessment: Assessment, verdict: Verdict) -> tuple[float | None, Interval | None]:
    """Return the size of what is seen, and its interval. A standing fault has only its level in all."""
    if assessment.standing_fault:
        return verdict.mu_f, verdict.mu_f_ci95
    change = assessment.change
    return (None, None) if change is None or change.until_ns is not None else (change.size, change.size_ci95)


def _forecast(assessment: Assessment, level: Level | None, mu_f: float, limit: float) -> Forecast:
    limit = limit_ahead(mu_f, limit)
    if level is None:
        return Forecast(limit)
    standing = mu_f - max(0.0, level.value)
    return forecast(assessment.levels, limit, today=level, standing=standing)


def _is_stale(as_of_ns: int | None, now_ns: int, stale_after_ns: int) -> bool:
    return as_of_ns is None or now_ns - as_of_ns > stale_after_ns


def _time(time_ns: int | None) -> str | None:
    return None if time_ns is None else rfc3339(time_ns)


def _time_ns(text: str | None) -> int | None:
    return None if text is None else nanoseconds(text)


def _listed(figures: tuple[float, ...] | None) -> list[float] | None:
    return None if figures is None else list(figures)


def _interval(figures: list[float] | None) -> Interval | None:
    return None if figures is None else (figures[0], figures[1])


def _reference_document(reference: Reference | None) -> dict[str, object]:
    if reference is None:
        return {"records": 0, "complete": False, "standing": None}
    standing, before = reference.standing, reference.declared
    return {
        "records": reference.records,
        "complete": reference.complete,
        "standing": standing.value,
        "standing_ci95": _listed(standing.ci95),
        "standing_deviation": standing.deviation,
        "standing_phase": standing.phase,
        "standing_path_ratio": standing.path_ratio,
        "standing_score": reference.standing_score,
        "detectable": reference.detectable,
        "since": _time(reference.since_ns),
        "from_bus": reference.from_bus,
        "accepted": reference.accepted,
        "accepted_level": None if before is None else before.level,
        "accepted_level_ci95": None if before is None else _listed(before.ci95),
        "accepted_phase": None if before is None else before.phase,
    }


def _reference(document: Mapping[str, Any]) -> Reference | None:
    if document["standing"] is None:
        return None
    return Reference(
        records=document["records"],
        complete=document["complete"],
        since_ns=_time_ns(document["since"]),
        detectable=document["detectable"],
        standing=Level(
            value=document["standing"],
            deviation=document["standing_deviation"],
            winding=cast(Winding, PHASES.index(document["standing_phase"])),
            path_ratio=document["standing_path_ratio"],
            interval=_interval(document["standing_ci95"]),
        ),
        standing_score=document["standing_score"],
        from_bus=document["from_bus"],
        accepted=document["accepted"],
        declared=_declared(document),
    )


def _declared(document: Mapping[str, Any]) -> Declared | None:
    interval = _interval(document.get("accepted_level_ci95"))
    if interval is None:
        return None
    return Declared(document["accepted_level"], interval, document["accepted_phase"])
