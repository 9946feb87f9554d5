"""`mcc audit verify`: whether every entry is as it was written."""

from dataclasses import asdict
from pathlib import Path

from rich.text import Text

from service.audit.entries import START, Anchor, canonical
from service.audit.exports import AuditFileError, read_anchor
from service.audit.verification import Verification, verify
from service.cli.audit.source import opened
from service.cli.output import CommandError, failing_clearly, print_document, results


def verify_trail(
    url: str,
    config: Path | None,
    file: Path | None,
    *,
    anchors: list[Path],
    write_anchor: Path | None,
    as_json: bool,
) -> None:
    """Read a whole trail and print whether it is intact. Raises CommandError, also where it is not."""
    with failing_clearly(AuditFileError, OSError):
        seen = [read_anchor(path) for path in anchors]
    with opened(url, config, file) as trail:
        found = verify(trail.read, start=trail.start, head=trail.head, anchors=seen)
        start = trail.start
    if found.fault is not None:
        raise CommandError(
            f"the audit trail is not as it was written: {found.message}", details=_details(found)
        )
    if write_anchor is not None and found.last != START:
        with failing_clearly(OSError), write_anchor.open("a", encoding="utf-8") as kept:
            kept.write(canonical(asdict(found.last)) + "\n")
    if as_json:
        print_document(_details(found))
        return
    results().print(Text(_words(found, start, seen)), soft_wrap=True)


def _details(found: Verification) -> dict[str, object]:
    return {**asdict(found), "type": "AuditVerification"}


def _words(found: Verification, start: Anchor, seen: list[Anchor]) -> str:
    if found.last == START:
        return "the audit trail has no entries"
    last = found.last
    told = f"{found.entries} entries are as they were written; the last is {last.number}, {last.hash}"
    if start != START:
        told += f"; those up to {start.number} are not in the file"
    if not seen:
        told += "; no anchor was given, which alone shows a trail that was computed anew"
    return told
