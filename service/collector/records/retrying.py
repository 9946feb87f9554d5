"""When a record that could not be pulled is asked for again: soon at first, then ever more seldom."""

from collections.abc import Collection, Iterable
from dataclasses import dataclass

from service.collector.records.listing import ListedRecord

FIRST_PAUSE_S, LONGEST_PAUSE_S = 0.2, 60.0
LONGEST_PAUSE_OF_THE_DENIED_S = 600.0
"""A relay that lets nobody have its files for now may do so for hours."""

SOON_S = 2.0
"""A pause no longer than this is waited for in a hurry."""

_MOST_DOUBLINGS = 20


@dataclass(frozen=True, slots=True)
class _Failure:
    number: int
    due_s: float
    reason: str
    verdicts: int


class RetrySchedule:
    """Of one relay's records as they are listed; one that changes is another. Times are monotonic [s]."""

    def __init__(self) -> None:
        self._failures: dict[ListedRecord, _Failure] = {}

    def failed(
        self,
        record: ListedRecord,
        reason: str,
        now_s: float,
        *,
        is_verdict: bool = False,
        longest_s: float = LONGEST_PAUSE_S,
    ) -> int:
        """One more time; returns how often in all. is_verdict: what failed is due to the record itself."""
        number = self.number(record) + 1
        pause_s = min(FIRST_PAUSE_S * 2 ** min(number - 1, _MOST_DOUBLINGS), longest_s)
        verdicts = self.verdicts(record) + is_verdict
        self._failures[record] = _Failure(number, now_s + pause_s, reason, verdicts)
        return number

    def number(self, record: ListedRecord) -> int:
        """How often it has failed."""
        failure = self._failures.get(record)
        return 0 if failure is None else failure.number

    def verdicts(self, record: ListedRecord) -> int:
        """How often the record itself was what failed."""
        failure = self._failures.get(record)
        return 0 if failure is None else failure.verdicts

    def due(self, records: Iterable[ListedRecord], now_s: float) -> tuple[ListedRecord, ...]:
        """Those that may be asked for now; last the one that failed most, which may end the visit again."""
        ready = [each for each in records if self._pause_s(each, now_s) <= 0]
        return tuple(sorted(ready, key=self.number))

    def put_off(self, now_s: float) -> frozenset[str]:
        """Names of those that are not asked for again soon."""
        return frozenset(each.name for each in self._failures if self._pause_s(each, now_s) > SOON_S)

    def reasons(self) -> dict[str, str]:
        """Why the latest attempt failed, by names of records."""
        return {record.name: failure.reason for record, failure in self._failures.items()}

    def keep(self, records: Collection[ListedRecord]) -> None:
        """Forget all others: they are gone, or have come."""
        if self._failures:
            self._failures = {each: self._failures[each] for each in records if each in self._failures}

    def _pause_s(self, record: ListedRecord, now_s: float) -> float:
        failure = self._failures.get(record)
        return 0.0 if failure is None else failure.due_s - now_s
