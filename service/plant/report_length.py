"""How long a relay's event reports are, whether its settings allow longer ones, and what to set.

The length is that of its latest record, which is what its settings came to. How long it may be is what the
manuals of its family say.
"""

from dataclasses import dataclass
from typing import Final

from core.quantity_text import plain

LEAST_PRE_TRIGGER_S: Final = 0.1
"""With less the next record of a series cannot be triggered in time over a network, and share a cycle."""
LONGEST_CYCLES: Final = {"SEL-710": 64, "SEL-2414": 64, "SEL-751": 180}
"""Longest event report (LER) by the beginning of a relay's type [cycles].

docs/reference/relays.md has the sources."""
TOLERANCE_CYCLES: Final = 2.0
"""A record may be shorter than its setting by so much: relays leave out the cycles in which they begin."""
PRE_TRIGGER_CYCLES: Final = 20
"""Of 64; long enough for a trigger that comes late over a network."""


@dataclass(frozen=True, slots=True)
class ReportLength:
    """Length of a relay's event reports, and how much of it is before the trigger.

    longest_cycles: what its family allows; None where that is not known here.  advice: what to set, and why.
    """

    duration_s: float
    pre_trigger_s: float
    cycles: float
    longest_cycles: int | None
    advice: tuple[str, ...]


def report_length(relay_type: str, length: tuple[float, float], rated_frequency_Hz: float) -> ReportLength:
    """Return what the latest record of a relay tells.

    length: that of the record, and the part of it before the trigger [s].
    """
    duration_s, pre_trigger_s = length
    cycles = duration_s * rated_frequency_Hz
    longest = next((most for kind, most in LONGEST_CYCLES.items() if relay_type.startswith(kind)), None)
    return ReportLength(
        duration_s,
        pre_trigger_s,
        cycles,
        longest,
        tuple(_advice(cycles, pre_trigger_s, longest, rated_frequency_Hz)),
    )


def _advice(cycles: float, pre_trigger_s: float, longest: int | None, frequency_Hz: float) -> list[str]:
    advice = []
    if longest is None:
        advice.append("how long its records may be is not known here: see its manual")
    elif cycles < longest - TOLERANCE_CYCLES:
        advice.append(
            f"it can record {longest} cycles ({plain(longest / frequency_Hz)} s): set LER := {longest}; "
            "fetch its records before, because that erases them"
        )
    if pre_trigger_s < LEAST_PRE_TRIGGER_S:
        advice.append(
            f"for longer ones, joined from several, they must begin {LEAST_PRE_TRIGGER_S:g} s or more before "
            f"the trigger: set PRE := {PRE_TRIGGER_CYCLES} (with LER of 64 cycles or more)"
        )
    return advice
