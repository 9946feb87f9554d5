"""Verdicts, fault levels and times as text for people, the same in every command."""

from collections.abc import Mapping

from rich.text import Text

from core.error_words import one_line
from core.time_stamps import nanoseconds
from core.time_words import clock, with_clock_times

VERDICT_COLOURS = {"healthy": "green", "watch": "yellow", "fault": "red", "undiagnosable": "magenta"}


def verdict_text(verdict: str, phase: object = None) -> Text:
    """Return a verdict in its colour, with the faulted phase where there is one: "fault b"."""
    return Text(f"{verdict} {phase or ''}".strip(), style=VERDICT_COLOURS.get(verdict, ""))


OPERATIONS = {
    "not-running": "a motor that stands",
    "start": "a start",
    "stop": "a stop",
    "trip": "a trip",
}
"""What is said of a recording in which the motor does not run all the time."""


def seen_in(operation: object) -> str:
    """Return in words what a motor does in a recording: ", a start"; nothing of one in which it runs."""
    words = OPERATIONS.get(str(operation))
    return "" if words is None else f", {words}"


def level(mu_f: object, ci95: object) -> str:
    """Return a fault level in percent of the phase turns, with its 95 % interval; "-" where there is none."""
    if not isinstance(mu_f, int | float):
        return "-"
    between = interval(ci95)
    return f"{percent(mu_f)} %" + ("" if between == "-" else f" [{between}]")


def interval(ci95: object) -> str:
    """Return an interval in percent: "4.20..6.00"; "-" where there is none."""
    if not isinstance(ci95, list | tuple) or len(ci95) != 2:
        return "-"
    return "..".join(percent(bound) for bound in ci95)


def load(load_level: object, ci95: object = None) -> str:
    """Return a load over the rated torque, with its 95 % interval; "-" where there is none."""
    if not isinstance(load_level, int | float):
        return "-"
    if not isinstance(ci95, list | tuple) or len(ci95) != 2:
        return f"{load_level:.3f}"
    return f"{load_level:.3f} [{ci95[0]:.3f}..{ci95[1]:.3f}]"


def percent(share: object) -> str:
    """Return a share in percent, without the sign: "2.18"; "-" where there is none."""
    return f"{100 * share:.2f}" if isinstance(share, int | float) else "-"


def detection(limit: object) -> str:
    """Return in words from which level on nine of ten such recordings show a fault."""
    return "-" if limit is None else f"{percent(limit)} %: nine of ten such recordings show a fault of it"


def reasons_of(found: Mapping[str, object]) -> list[str]:
    """Return the reasons of a diagnosis or a health, each once."""
    reasons = found["reasons"]
    return list(dict.fromkeys(map(str, reasons))) if isinstance(reasons, list) else []


def local_time(time: object, *, seconds: bool = True) -> str:
    """Return an RFC 3339 time as this machine's clock shows it: "2026-01-31 13:00:00 +01:00"."""
    return clock(nanoseconds(str(time)), None, seconds=seconds)


def local_times(sentence: object) -> str:
    """Return a sentence of the service in one line, with its times as this machine's clock shows them."""
    return with_clock_times(one_line(str(sentence)), None)
