"""Parts of the document of a condition, and how they are read again: times, intervals, the reference."""

from collections.abc import Mapping
from typing import Any, cast

from core.condition.assessment import Declared, Level, Phases, Reference
from core.condition.severity import Interval
from core.machines.stator_winding import Winding
from core.time_stamps import nanoseconds, rfc3339


def time_text(time_ns: int | None) -> str | None:
    """Return a time as RFC 3339 has it."""
    return None if time_ns is None else rfc3339(time_ns)


def time_ns_of(text: str | None) -> int | None:
    """Return the time of a text, UTC [ns].

    Parameters
    ----------
    text : str or None
        The time, RFC 3339.

    Returns
    -------
    int or None
        The time; None where there is none.
    """
    return None if text is None else nanoseconds(text)


def listed(figures: tuple[float, ...] | None) -> list[float] | None:
    """Return figures as JSON has them."""
    return None if figures is None else list(figures)


def interval_of(figures: list[float] | None) -> Interval | None:
    """Return the interval that a document tells."""
    return None if figures is None else (figures[0], figures[1])


def reference_document(reference: Reference | None) -> dict[str, object]:
    """Return what the document tells of the reference."""
    if reference is None:
        return {"records": 0, "complete": False, "standing": None}
    standing, before = reference.standing, reference.declared
    return {
        "records": reference.records,
        "complete": reference.complete,
        "standing": standing.value,
        "standing_ci95": listed(standing.ci95),
        "standing_deviation": standing.deviation,
        "standing_phase": standing.phase,
        "standing_phase_probabilities": listed(standing.phases),
        "standing_axis_deg": standing.axis_deg,
        "standing_score": reference.standing_score,
        "detectable": reference.detectable,
        "since": time_text(reference.since_ns),
        "from_bus": reference.from_bus,
        "accepted": reference.accepted,
        "accepted_level": None if before is None else before.level,
        "accepted_level_ci95": None if before is None else listed(before.ci95),
        "accepted_phase": None if before is None else before.phase,
    }


def reference_of(document: Mapping[str, Any]) -> Reference | None:
    """Return the reference that a document tells; None before there was one."""
    if document["standing"] is None:
        return None
    phases = phases_of_document(document["standing_phase_probabilities"])
    return Reference(
        records=document["records"],
        complete=document["complete"],
        since_ns=time_ns_of(document["since"]),
        detectable=document["detectable"],
        standing=Level(
            value=document["standing"],
            deviation=document["standing_deviation"],
            winding=_likeliest(phases),
            interval=interval_of(document["standing_ci95"]),
            phases=phases,
            axis_deg=document["standing_axis_deg"],
        ),
        standing_score=document["standing_score"],
        from_bus=document["from_bus"],
        accepted=document["accepted"],
        declared=_declared(document),
    )


def _likeliest(phases: Phases | None) -> Winding:
    """Return the likeliest winding; of a motor that tells no phase any one."""
    return 0 if phases is None else cast(Winding, max(range(3), key=phases.__getitem__))


def phases_of_document(figures: list[float] | None) -> Phases | None:
    """Return the probabilities of the phases that a document has.

    Parameters
    ----------
    figures : list of float or None
        Probability of phase a, b, c, as JSON has them.

    Returns
    -------
    tuple of float or None
        The same; None where there are none.
    """
    return None if figures is None else (figures[0], figures[1], figures[2])


def _declared(document: Mapping[str, Any]) -> Declared | None:
    interval = interval_of(document["accepted_level_ci95"])
    if interval is None:
        return None
    return Declared(document["accepted_level"], interval, document["accepted_phase"])
