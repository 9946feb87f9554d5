"""A report as PDF. The same report has the same bytes."""

import json
import subprocess
import sys
from threading import BoundedSemaphore

from core.error_words import one_line
from service.reports.document import ReportDocument
from service.reports.errors import ReportError
from service.reports.typesetting.sheet import sheet

LONGEST_S = 90.0
COMMAND = (sys.executable, "-m", "service.reports.typesetting.typesetter")
LONGEST_REASON = 300


MOST_AT_ONCE = 2
"""Of a process of the service, for those who ask and for mails: each takes up to half a gigabyte."""

_TURNS = BoundedSemaphore(MOST_AT_ONCE)


def pdf(report: ReportDocument) -> bytes:
    """Return the file. Raises ReportError."""
    data = json.dumps(sheet(report), ensure_ascii=True, allow_nan=False).encode()
    if not _TURNS.acquire(timeout=LONGEST_S):
        raise ReportError(f"other reports have been set for {LONGEST_S:g} s")
    try:
        return _set(data)
    finally:
        _TURNS.release()


def _set(data: bytes) -> bytes:
    """Return the file from a process of its own. Raises ReportError."""
    try:
        made = subprocess.run(  # noqa: S603 - this program itself; what the report says is on stdin
            COMMAND, input=data, capture_output=True, timeout=LONGEST_S, check=False
        )
    except subprocess.TimeoutExpired as error:
        raise ReportError(f"the report was not set within {LONGEST_S:g} s") from error
    except OSError as error:
        raise ReportError(f"the report cannot be set: {error}") from error
    if made.returncode != 0 or not made.stdout.startswith(b"%PDF"):
        reason = one_line(made.stderr.decode(errors="replace"))[:LONGEST_REASON]
        raise ReportError(f"the report cannot be set: {reason or f'exit code {made.returncode}'}")
    return made.stdout
