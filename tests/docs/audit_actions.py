"""Writes the table of actions of docs/reference/audit.md from the code."""

from collections.abc import Iterator

from service.audit.actions import MEANINGS, AuditAction
from tests.docs.pages import ROOT, between_markers

PAGE = ROOT / "docs" / "reference" / "audit.md"


def rows() -> Iterator[str]:
    """Yield the lines of the table."""
    yield "| Action | What was done |"
    yield "|---|---|"
    yield from (f"| `{action}` | {MEANINGS[action]} |" for action in AuditAction)


def written(page: str) -> str:
    """Return the page with its table made anew."""
    return between_markers(page, "actions", rows())


def main() -> None:
    PAGE.write_text(written(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
