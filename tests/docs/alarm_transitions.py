"""The table of what follows from which event, on the page of the alarms."""

from collections.abc import Iterator

from service.storage.alarm_transitions import TRANSITIONS, ByCause
from service.storage.states import AlarmState
from tests.docs.pages import ROOT

PAGE = ROOT / "docs" / "reference" / "alarms.md"
BEGIN = "<!-- transitions: written by make docs -->"
END = "<!-- end of transitions -->"


def table() -> str:
    """Return the table as the page has it, between its marks."""
    return "\n".join([BEGIN, *_rows(), END])


def _rows() -> Iterator[str]:
    yield "| Event | " + " | ".join(state.value for state in AlarmState) + " |"
    yield "|---|" + "---|" * len(AlarmState)
    for event, follows in TRANSITIONS.items():
        yield f"| {event.value} | " + " | ".join(_words(follows.get(state)) for state in AlarmState) + " |"


def _words(following: AlarmState | ByCause | None) -> str:
    if following is None:
        return "-"
    if isinstance(following, ByCause):
        return f"{following.standing.value} if the cause stands, else {following.gone.value}"
    return following.value


def main() -> None:
    """Write the table into the page."""
    text = PAGE.read_text(encoding="utf-8")
    before, rest = text.split(BEGIN)
    _, after = rest.split(END)
    PAGE.write_text(f"{before}{table()}{after}", encoding="utf-8")
