"""The condition of a motor: what a plant acts on, and the document in which it is told and kept."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from core.condition.assessment import (
    STALE_AFTER_NS,
    Phase,
    Phases,
    Reference,
)
from core.condition.forecast.outcome import Forecast
from core.condition.kinds import Kind, State
from core.condition.severity import Interval
from core.condition.verdict.advice import advice
from core.condition.verdict.document import (
    interval_of,
    listed,
    phases_of_document,
    reference_document,
    reference_of,
    time_ns_of,
    time_text,
)
from core.condition.verdict.reasons import reason_of_unknown


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
        Phase of the fault, the channel or the joint, at the terminals; None where that of a fault is not
        sure.
    phase_probabilities : tuple of float or None
        Probability of each phase, should it be shorted turns; None where nothing may be, or no phase can be
        told.
    axis_deg : float or None
        Electrical degrees of the axis of the coils with the shorted turns from that of their phase; None
        where the winding is not known or the axis not sure.
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
    phase_probabilities: Phases | None
    axis_deg: float | None
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
        return replace(self, stale=is_stale(self.as_of_ns, now_ns, stale_after_ns))

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
            "phase_probabilities": listed(self.phase_probabilities),
            "axis_deg": self.axis_deg,
            "mu_f": self.mu_f,
            "mu_f_ci95": listed(self.mu_f_ci95),
            "change": self.change,
            "change_ci95": listed(self.change_ci95),
            "size": self.size,
            "size_ci95": listed(self.size_ci95),
            "since": time_text(self.since_ns),
            "growth_per_day": self.forecast.growth_per_day,
            "forecast": {
                "limit": self.forecast.limit,
                "days": listed(self.forecast.days),
                "chances": listed(self.forecast.chances),
            },
            "reference": reference_document(self.reference),
            "as_of": time_text(self.as_of_ns),
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
            What `as_dict` returned; further keys are left out.

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
        days, chances = forecast["days"], forecast.get("chances")
        return cls(
            motor=document["motor"],
            state=State(document["state"]),
            kind=Kind(document["kind"]),
            candidates=tuple(Kind(kind) for kind in document["candidates"]),
            phase=document["phase"],
            phase_probabilities=phases_of_document(document["phase_probabilities"]),
            axis_deg=document["axis_deg"],
            mu_f=document["mu_f"],
            mu_f_ci95=interval_of(document["mu_f_ci95"]),
            change=document["change"],
            change_ci95=interval_of(document["change_ci95"]),
            size=document["size"],
            size_ci95=interval_of(document["size_ci95"]),
            since_ns=time_ns_of(document["since"]),
            forecast=Forecast(
                limit=forecast["limit"],
                days=None if days is None else (days[0], days[1], days[2]),
                growth_per_day=document["growth_per_day"],
                chances=None if chances is None else tuple(chances),
            ),
            reference=reference_of(reference),
            as_of_ns=time_ns_of(document["as_of"]),
            stale=document["stale"],
            advice=document["advice"],
            reasons=tuple(document["reasons"]),
        )


def unknown_condition(motor: str, fault_level: float) -> Condition:
    """Return the condition of a motor without a record that tells of its stator.

    Parameters
    ----------
    motor : str
        Name of the motor.
    fault_level : float
        Its limit, a fraction of the phase turns.

    Returns
    -------
    Condition
        The condition.
    """
    return Condition(
        motor=motor,
        state=State.UNKNOWN,
        kind=Kind.NONE,
        candidates=(),
        phase=None,
        phase_probabilities=None,
        axis_deg=None,
        mu_f=None,
        mu_f_ci95=None,
        change=None,
        change_ci95=None,
        size=None,
        size_ci95=None,
        since_ns=None,
        forecast=Forecast(fault_level),
        reference=None,
        as_of_ns=None,
        stale=True,
        advice=advice(State.UNKNOWN, Kind.NONE),
        reasons=(reason_of_unknown(None),),
    )


def is_stale(as_of_ns: int | None, now_ns: int, stale_after_ns: int) -> bool:
    """Return whether a latest record of that time is too old, or there is none."""
    return as_of_ns is None or now_ns - as_of_ns > stale_after_ns
