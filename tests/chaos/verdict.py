"""Truth against account: what is lost, doubled, falsified or unaccounted for."""

import re
from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from tests.chaos.account import ENDED, SETTLED, Folder, Report, Row
from tests.chaos.ledger import File, Ledger, RecordKey, RelayRecord
from tests.chaos.triggers import Triggers

NO_RECORD = re.compile(r"expected a record within .* found none")
NO_ANSWER = re.compile(r" does not answer: (?!\w*Error)| is not visited: (OSError|OperationalError)")
"""Of the relay, or of what the service needs to visit it: the disk, the database."""

REFUSED = re.compile(r" refuses the trigger: ")
INCOMPLETE = re.compile(r"expected a \.\w+ file in .*, found none")
GONE = re.compile(r"the relay discarded or changed it before it could be pulled")


@dataclass(frozen=True, slots=True)
class Breach:
    """What must not be. made_ns: when the record was made, where one is concerned."""

    kind: str
    relay: str
    record: str
    what: str
    made_ns: int | None = None

    def __str__(self) -> str:
        return f"{self.kind}: {self.relay} {self.record}: {self.what}"


def of_records(truth: Sequence[RelayRecord], account: Sequence[Row], ledger: Ledger) -> Iterator[Breach]:
    """Every record the relays have is in the service once, and nothing else is."""
    held: defaultdict[RecordKey, list[Row]] = defaultdict(list)
    for row in account:
        held[row.relay, row.name].append(row)
    known = {(record.relay, record.name): record for record in truth}
    discarded = ledger.discarded()
    for key, record in known.items():
        fetched = [row for row in held[key] if row.is_fetched]
        refused = [row for row in held[key] if not row.is_fetched]
        if record.is_whole and not fetched:
            states = ", ".join(f"{row.state} {row.reason}" for row in refused) or "no row"
            yield Breach("lost", *key, f"it is not stored ({states})", record.made_ns)
        if len(fetched) > 1:
            yield Breach("doubled", *key, f"{len(fetched)} recordings of it", record.made_ns)
        if not record.is_whole and not any(row.state == "rejected" for row in refused):
            yield Breach("unaccounted", *key, "half a record, and its refusal is not written down")
        for row in refused:
            yield from _of_refusal(row, record, ledger)
    for key, rows in held.items():
        for row in rows:
            if row.state not in SETTLED:
                yield Breach("unsettled", *key, f"it is still {row.state} {row.reason}")
            if row.state == "failed" or (row.is_fetched and row.state == "rejected"):
                yield Breach("undiagnosed", *key, f"{row.state}: {row.reason}")
        if key not in known and key not in discarded:
            yield Breach("foreign", *key, "no relay made it")


def _of_refusal(row: Row, record: RelayRecord, ledger: Ledger) -> Iterator[Breach]:
    """A refusal must be true: the record lacks a file, or was listed otherwise before."""
    key = (row.relay, row.name)
    if INCOMPLETE.search(row.reason) and (not record.is_whole or ledger.changed(key)):
        return
    if GONE.search(row.reason) and (ledger.changed(key) or not record.is_whole):
        return
    if row.state in ("announced", "rejected"):
        yield Breach("refused", *key, f"{row.state}: {row.reason or 'no reason'}", record.made_ns)


def of_contents(
    truth: Sequence[RelayRecord],
    account: Sequence[Row],
    told: Mapping[str, Mapping[str, File]],
    store: Sequence[Folder],
    ledger: Ledger,
) -> Iterator[Breach]:
    """What is stored is what the relays have, byte for byte; told: files of each recording over REST."""
    known = {(record.relay, record.name): record for record in truth}
    kept = Counter(frozenset(folder.files.items()) for folder in store)
    wanted: set[frozenset[tuple[str, File]]] = set()
    discarded = ledger.discarded()
    for row in account:
        record = known.get((row.relay, row.name))
        if not row.is_fetched:
            continue
        files = told[row.id]
        wanted.add(frozenset(files.items()))
        if kept[frozenset(files.items())] != 1:
            found = kept[frozenset(files.items())]
            yield Breach("falsified", row.relay, row.name, f"{found} folders hold what it is said to hold")
        if record is None:
            continue
        wrong = {name for name, file in files.items() if record.files.get(name) != file}
        missing = record.comtrade().keys() - files.keys()
        if wrong or missing:
            what = f"other content: {sorted(wrong)}; missing: {sorted(missing)}"
            yield Breach("falsified", row.relay, row.name, what, record.made_ns)
    for folder in store:
        if frozenset(folder.files.items()) not in wanted and not discarded:
            yield Breach("orphan", "", folder.path.name, f"no recording has its {sorted(folder.files)}")


def of_triggers(
    triggers: Triggers, reports: Sequence[Report], truth: Sequence[RelayRecord], account: Sequence[Row]
) -> Iterator[Breach]:
    """Every trigger that was accepted is a report that came to its end, with a reason that is true."""
    for key in sorted(triggers.unanswered):
        yield Breach("unanswered", "", key, "the service never accepted this trigger")
    for words in triggers.contradictions:
        yield Breach("contradiction", "", "", words)
    by_id = {report.id: report for report in reports}
    ids = Counter(asked.report for asked in triggers.asked.values())
    for asked in triggers.asked.values():
        if asked.report not in by_id:
            yield Breach("lost", asked.relay, asked.key, f"event report {asked.report} is not there")
        elif ids[asked.report] > 1:
            yield Breach("contradiction", asked.relay, asked.key, f"shares event report {asked.report}")
    of_rows = {row.id: row for row in account}
    claimed = Counter(report.recording for report in reports if report.recording is not None)
    for report in reports:
        if report.id not in ids:
            yield Breach("doubled", report.relay, report.id, "an event report nobody asked for")
        yield from _of_report(report, of_rows, claimed)
    yield from _of_counts(triggers, reports, truth, account)


def _of_report(report: Report, rows: Mapping[str, Row], claimed: Counter[str]) -> Iterator[Breach]:
    where = (report.relay, f"event report {report.id}")
    if report.state not in ENDED:
        yield Breach("unsettled", *where, f"it is still {report.state}")
    if report.state == "failed" and not any(
        reason.search(report.reason) for reason in (NO_RECORD, NO_ANSWER, REFUSED, INCOMPLETE)
    ):
        yield Breach("reason", *where, f"failed: {report.reason or 'no reason'}")
    if report.state == "diagnosed":
        row = None if report.recording is None else rows.get(report.recording)
        if row is None or row.relay != report.relay:
            yield Breach("contradiction", *where, f"its recording {report.recording} is not this relay's")
        elif claimed[row.id] > 1:
            yield Breach("contradiction", *where, f"{claimed[row.id]} event reports have recording {row.id}")


def _of_counts(
    triggers: Triggers, reports: Sequence[Report], truth: Sequence[RelayRecord], account: Sequence[Row]
) -> Iterator[Breach]:
    """No relay was triggered twice for one report, and no report failed for lack of a record that came."""
    records = Counter(record.relay for record in truth)
    triggered = Counter(report.relay for report in reports if report.was_triggered)
    excused = Counter(report.relay for report in reports if NO_ANSWER.search(report.reason))
    claimed = {report.recording for report in reports}
    unclaimed = Counter(row.relay for row in account if row.is_fetched and row.id not in claimed)
    for relay, number in records.items():
        if number > triggered[relay] + triggers.made[relay]:
            what = f"{number} records of {triggered[relay]} triggers and {triggers.made[relay]} of its own"
            yield Breach("doubled", relay, "", what)
    for relay, number in unclaimed.items():
        if number > triggers.made[relay] + excused[relay]:
            what = (
                f"{number} recordings belong to no event report; {triggers.made[relay]} were made at "
                f"the relay, {excused[relay]} came after the relay had not answered"
            )
            yield Breach("unmatched", relay, "", what)
