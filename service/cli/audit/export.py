"""`mcc audit export`: takes the trail elsewhere, as it was hashed; a file that is there is continued."""

import sys
from functools import partial
from pathlib import Path
from typing import TextIO

from rich.text import Text

from service.audit.entries import START, Anchor, line
from service.audit.exports import AuditFileError, read_anchor
from service.audit.verification import Verification, verify
from service.cli.audit.source import Trail, opened
from service.cli.output import CommandError, failing_clearly, progress


def export_trail(url: str, config: Path | None, file: Path | None) -> None:
    """Write all entries behind those that the file has; without one to standard output.

    Raises CommandError.
    """
    with failing_clearly(AuditFileError, OSError):
        kept = read_anchor(file) if file is not None and file.exists() and file.stat().st_size else START
    with opened(url, config, None, first=kept.number + 1) as trail:
        if trail.head is not None and trail.head.number < kept.number:
            raise CommandError(
                f"{file}: ends with entry {kept.number}, and the audit trail has {trail.head.number}: its "
                "end was cut off, or it is that of another service"
            )
        if trail.head is not None and trail.head.number == kept.number and trail.head != kept:
            raise CommandError(f"{file}: ends with another entry {kept.number} than the audit trail has")
        if file is None:
            number = _write(trail, kept, sys.stdout)
        else:
            with failing_clearly(OSError), file.open("a", encoding="utf-8", newline="") as sink:
                number = _write(trail, kept, sink)
    if file is not None:
        progress().print(Text(f"{file}: {number} entries added"), soft_wrap=True)


def _write(trail: Trail, kept: Anchor, sink: TextIO) -> int:
    """Write what comes behind `kept`, while each entry follows the one before. Raises CommandError."""
    last, number = kept, 0
    for entry in trail.read():
        one = verify(partial(list, (entry,)), start=last)
        if one.fault is not None:
            raise _not_as_written(one, number)
        sink.write(line(entry) + "\n")
        last, number = one.last, number + 1
    return number


def _not_as_written(found: Verification, number: int) -> CommandError:
    return CommandError(
        f"the audit trail is not as it was written: {found.message}; {number} entries before it were written"
    )
