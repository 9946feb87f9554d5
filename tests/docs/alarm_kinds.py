"""The table of what raises an alarm, on its page; the consequence stands at each alarm alone."""

from collections.abc import Iterator

from service.alarms.catalogue import CATALOGUE
from tests.docs.pages import ROOT

PAGE = ROOT / "docs" / "reference" / "alarms.md"
BEGIN = "<!-- kinds: written by make docs -->"
END = "<!-- end of kinds -->"


def table() -> str:
    """Return the table as the page has it, between its marks."""
    return "\n".join([BEGIN, *_rows(), END])


def _rows() -> Iterator[str]:
    yield "| Alarm | Priority | Cause | What to do | Is over when |"
    yield "|---|---|---|---|---|"
    for kind, told in CATALOGUE.items():
        cells = (f"`{kind}`", told.priority, told.cause, told.action, told.over)
        yield f"| {' | '.join(cells)} |"


def main() -> None:
    """Write the table into the page."""
    text = PAGE.read_text(encoding="utf-8")
    before, rest = text.split(BEGIN)
    _, after = rest.split(END)
    PAGE.write_text(f"{before}{table()}{after}", encoding="utf-8")
