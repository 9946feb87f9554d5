"""Downloads one text report into memory, and never more than a report has."""

import io
from collections.abc import Callable
from typing import Final

from mms import Client
from service.collector.text_reports.offered import OfferedReport

MOST_BYTES: Final = 2 << 20
"""More than the longest report of a relay that is known: a load profile of 6,500 rows."""


class ReportTooLongError(ValueError):
    """A relay lists or sends a text report that is longer than any should be."""

    def __init__(self, found_bytes: int) -> None:
        super().__init__(f"expected at most {MOST_BYTES} bytes, found {found_bytes} or more")


class _Bounded:
    """Takes the parts of a report. Raises ReportTooLongError at the first octet too many."""

    def __init__(self, on_bytes: Callable[[int], None]) -> None:
        self.text = io.BytesIO()
        self._on_bytes = on_bytes

    def write(self, chunk: bytes, /) -> None:
        self._on_bytes(len(chunk))
        if self.text.tell() + len(chunk) > MOST_BYTES:
            raise ReportTooLongError(self.text.tell() + len(chunk))
        self.text.write(chunk)


def download(client: Client, report: OfferedReport, on_bytes: Callable[[int], None]) -> bytes:
    """Return the text of a report. Relays make it anew at each request: its size is not that of the listing.

    on_bytes: gets the size of every part that came. Raises MmsError, ReportTooLongError.
    """
    if report.size > MOST_BYTES:
        raise ReportTooLongError(report.size)
    bounded = _Bounded(on_bytes)
    client.download(report.remote_name, bounded)
    return bounded.text.getvalue()
