"""Truth against account: what is lost, doubled, falsified or unaccounted for."""

import re
from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from tests.chaos.account import ENDED, SETTLED, Folder, Request, Row
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
    triggers: Triggers, requests: Sequence[Request], truth: Sequence[RelayRecord], account: Sequence[Row]
) -> Iterator[Breach]:
    """Every trigger that was accepted is a request that came to its end, with a reason that is true."""
    for key in sorted(triggers.unanswered):
        yield Breach("unanswered", "", key, "the service never accepted this trigger")
    for words in triggers.contradictions:
        yield Breach("contradiction", "", "", words)
    by_id = {request.id: request for request in requests}
    ids = Counter(asked.request for asked in triggers.asked.values())
    for asked in triggers.asked.values():
        if asked.request not in by_id:
            yield Breach("lost", asked.relay, asked.key, f"recording request {asked.request} is not there")
        elif ids[asked.request] > 1:
            yield Breach("contradiction", asked.relay, asked.key, f"shares recording request {asked.request}")
    of_rows = {row.id: row for row in account}
    claimed = Counter(request.recording for request in requests if request.recording is not None)
    for request in requests:
        if request.id not in ids:
            yield Breach("doubled", request.relay, request.id, "a recording request nobody asked for")
        yield from _of_request(request, of_rows, claimed)
    yield from _of_counts(triggers, requests, truth, account)


def _of_request(request: Request, rows: Mapping[str, Row], claimed: Counter[str]) -> Iterator[Breach]:
    where = (request.relay, f"recording request {request.id}")
    if request.state not in ENDED:
        yield Breach("unsettled", *where, f"it is still {request.state}")
    if request.state == "failed" and not any(
        reason.search(request.reason) for reason in (NO_RECORD, NO_ANSWER, REFUSED, INCOMPLETE)
    ):
        yield Breach("reason", *where, f"failed: {request.reason or 'no reason'}")
    if request.state == "diagnosed":
        row = None if request.recording is None else rows.get(request.recording)
        if row is None or row.relay != request.relay:
            yield Breach("contradiction", *where, f"its recording {request.recording} is not this relay's")
        elif claimed[row.id] > 1:
            yield Breach(
                "contradiction", *where, f"{claimed[row.id]} recording requests have recording {row.id}"
            )


def _of_counts(
    triggers: Triggers, requests: Sequence[Request], truth: Sequence[RelayRecord], account: Sequence[Row]
) -> Iterator[Breach]:
    """No relay was triggered twice for one request, and no request failed for lack of a record that came."""
    records = Counter(record.relay for record in truth)
    triggered = Counter(request.relay for request in requests if request.was_triggered)
    excused = Counter(request.relay for request in requests if NO_ANSWER.search(request.reason))
    claimed = {request.recording for request in requests}
    unclaimed = Counter(row.relay for row in account if row.is_fetched and row.id not in claimed)
    for relay, number in records.items():
        if number > triggered[relay] + triggers.made[relay]:
            what = f"{number} records of {triggered[relay]} triggers and {triggers.made[relay]} of its own"
            yield Breach("doubled", relay, "", what)
    for relay, number in unclaimed.items():
        if number > triggers.made[relay] + excused[relay]:
            what = (
                f"{number} recordings belong to no recording request; {triggers.made[relay]} were made at "
                f"the relay, {excused[relay]} came after the relay had not answered"
            )
            yield Breach("unmatched", relay, "", what)
