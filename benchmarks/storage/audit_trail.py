"""What the audit trail costs: writing entries, reading all of them to verify or export them, and their size.

    python -m benchmarks.storage.audit_trail [--entries 1000000] [--url SQLALCHEMY-URL]

Entries are written once in transactions of their own, as changes are, once with others writing at the same
time, and the rest a thousand at a time. The database is an SQLite file on disk; or the empty one at the URL,
which it fills.
"""

import argparse
import resource
import tempfile
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path

from sqlalchemy import func, select, text
from sqlalchemy.orm import Session

from service.audit.actions import AuditAction
from service.audit.entries import line
from service.audit.verification import verify
from service.configuration.settings import sqlite_url
from service.storage import Repository, connect, migrate
from service.storage.models import AuditEntryRow
from service.storage.records import Actor, Role
from service.storage.repository.audit.entries import note_change
from testing.service.plants import NOW_NS

ALONE = 500
WRITERS = 4
AT_ONCE = 1000
ANNA = Actor("anna", "10.0.0.7", frozenset({Role.ENGINEER}))
BEFORE = {"recordings": [f"{number:036}" for number in range(3)], "reason": "new winding", "told_by": "anna"}


class Writer(Repository):
    """Writes entries without changes, so that the time is theirs."""

    def write_each(self, transactions: int, number: int = 1) -> None:
        """Write so many entries in each of so many transactions."""
        for _ in range(transactions):
            self._write_entries(number)

    def _write_entries(self, number: int) -> None:
        subject = ("motor", "PUMP-A1")
        with self._write() as session:
            for _ in range(number):
                note_change(
                    session,
                    ANNA,
                    AuditAction.BASELINE_SET,
                    subject,
                    now_ns=NOW_NS,
                    before=BEFORE,
                    after=BEFORE,
                )


def timed(what: str, number: int, work: Callable[[], object]) -> None:
    """Print how many entries a second some work does, and the most memory that this process had so far."""
    begun_s = time.perf_counter()
    work()
    took_s = time.perf_counter() - begun_s
    most_MB = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"| {what} | {number:,} | {took_s:.1f} | {number / took_s:,.0f} | {most_MB:.0f} |", flush=True)


def measure(url: str, entries: int) -> None:
    """Fill a database and read it, and print a table."""
    migrate(url)
    engine = connect(url)
    writer = Writer(engine)
    print(f"| {engine.dialect.name} | entries | s | entries/s | most memory [MB] |\n|---|---|---|---|---|")
    timed("written, each in a transaction", ALONE, partial(writer.write_each, ALONE))

    with ThreadPoolExecutor(WRITERS) as pool:
        others = [Writer(engine) for _ in range(WRITERS)]
        each = [ALONE // WRITERS] * WRITERS
        timed(
            f"the same by {WRITERS} at once", ALONE, lambda: list(pool.map(Writer.write_each, others, each))
        )
    rest = max(0, entries - 2 * ALONE) // AT_ONCE
    timed("written by the thousand", rest * AT_ONCE, partial(writer.write_each, rest, AT_ONCE))
    with Session(engine) as session:
        number = session.scalar(select(func.count()).select_from(AuditEntryRow)) or 0
        size = _size_bytes(session, url)
    with writer.audit_trail() as trail:
        timed("verified", number, lambda: verify(trail.entries, head=trail.head))
        timed("made lines of an export", number, lambda: sum(len(line(entry)) for entry in trail.entries()))
    timed("pages of 100, latest first", 100, lambda: writer.audit_entries(limit=100))
    timed("pages of 100 of one subject", 100, lambda: writer.audit_entries(limit=100, subject="PUMP-A1"))
    print(f"\n{size / number:.0f} bytes an entry, with indexes")
    engine.dispose()


def _size_bytes(session: Session, url: str) -> int:
    if url.startswith("sqlite"):
        pages, page_bytes = (session.scalar(text(f"PRAGMA {name}")) for name in ("page_count", "page_size"))
        return int(pages or 0) * int(page_bytes or 0)
    return int(session.scalar(text("SELECT pg_total_relation_size('audit_entries')")) or 0)


def main() -> None:
    """Measure on SQLite, or on the database at a URL."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--entries", type=int, default=1_000_000)
    parser.add_argument("--url")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="statorwatch-audit-") as directory:
        measure(given.url or sqlite_url(Path(directory)), given.entries)


if __name__ == "__main__":
    main()
