"""Verdicts, fault levels and times as text for people, the same in every command."""

from rich.text import Text

VERDICT_COLOURS = {"healthy": "green", "watch": "yellow", "fault": "red", "undiagnosable": "magenta"}


def verdict_text(verdict: str, phase: object = None) -> Text:
    """Return a verdict in its colour, with the faulted phase where there is one: "fault b"."""
    return Text(f"{verdict} {phase or ''}".strip(), style=VERDICT_COLOURS.get(verdict, ""))


def level(mu_f: object, ci95: object) -> str:
    """Return a fault level in percent of the phase turns, with its 95 % interval; "-" where there is none."""
    if not isinstance(mu_f, int | float):
        return "-"
    interval = ""
    if isinstance(ci95, list | tuple) and len(ci95) == 2:
        interval = f"  [{100 * ci95[0]:.2f} .. {100 * ci95[1]:.2f}]"
    return f"{100 * mu_f:.2f} %{interval}"


def to_the_second(time: object) -> str:
    """Return an RFC 3339 time without the fractions of a second: "2026-01-31 12:00:00 UTC"."""
    return f"{str(time)[:19].replace('T', ' ')} UTC"
