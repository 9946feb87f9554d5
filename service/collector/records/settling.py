"""When is a listed record ready to be pulled? When it is whole and has stopped growing."""

from collections.abc import Collection, Iterable
from dataclasses import dataclass

from service.collector.records.listing import ListedRecord


@dataclass(frozen=True, slots=True)
class Settled:
    """What one look at the directory says.

    ready: whole and unchanged since an earlier look.  incomplete: unchanged for so long that the missing
    files are not coming.  unsteady: has been changing for so long that nobody waits for it any more; ready
    as soon as it does stand still.  waiting: none of these yet; look again soon.
    """

    ready: tuple[ListedRecord, ...]
    incomplete: tuple[ListedRecord, ...]
    unsteady: tuple[ListedRecord, ...]
    waiting: tuple[ListedRecord, ...]


class Settling:
    """Compares successive looks at one relay's directory.

    settle_s, untold_s: how long sizes and times must stand still, where a report told that a record is made
    and where none did.  patience_s: how long a record may lack a file.
    unsteady_s: how long a record may go on changing.  early_s: how long one must stand still that may yet
    come in a better format.
    """

    def __init__(
        self, *, settle_s: float, untold_s: float, patience_s: float, unsteady_s: float, early_s: float = 0.0
    ) -> None:
        self._settle_s = settle_s
        self._untold_s = untold_s
        self._early_s = early_s
        self._patience_s = patience_s
        self._unsteady_s = unsteady_s
        self._since: dict[ListedRecord, float] = {}
        self._first: dict[str, float] = {}

    def look(
        self,
        records: Iterable[ListedRecord],
        now_s: float,
        *,
        told: bool,
        early: Collection[ListedRecord] = (),
    ) -> Settled:
        """Judge the records that are new to the service. `now_s` is monotonic [s]."""
        usual_s = self._settle_s if told else self._untold_s
        self._since = {record: self._since.get(record, now_s) for record in records}
        self._first = {record.name: self._first.get(record.name, now_s) for record in self._since}
        ready, incomplete, unsteady, waiting = [], [], [], []
        for record, since_s in self._since.items():
            unchanged_s = now_s - since_s
            settle_s = max(usual_s, self._early_s) if record in early else usual_s
            if record.missing and unchanged_s >= self._patience_s:
                incomplete.append(record)
            elif not record.missing and unchanged_s >= settle_s:
                ready.append(record)
            elif since_s - self._first[record.name] >= self._unsteady_s:
                unsteady.append(record)
            else:
                waiting.append(record)
        return Settled(tuple(ready), tuple(incomplete), tuple(unsteady), tuple(waiting))
