"""The state of one relay at one moment, and the layout of reports made from it."""

from collections.abc import Iterable
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta

from core.machines.parameters import Motor
from core.recordings.cev.compressed_ascii import closed
from ied_sim.monitoring.journal import Journal
from ied_sim.monitoring.relay_word import RelayWord

_EPOCH = datetime(1970, 1, 1, tzinfo=UTC)

DATE_LABELS = ("MONTH", "DAY", "YEAR", "HOUR", "MIN", "SEC", "MSEC")


@dataclass(frozen=True, slots=True)
class RelaySnapshot:
    """State of one relay at one moment.

    `offset_ns` is what the relay's clock adds to UTC where it writes times, its error included.
    """

    relay: str
    firmware: str
    motor: Motor
    rated_current_A: float
    journal: Journal
    word: RelayWord
    settings: tuple[tuple[str, str], ...]
    now_ns: int
    offset_ns: int

    def moment(self, time_ns: int) -> datetime:
        """Return the relay's own date and time, to microseconds."""
        return _EPOCH + timedelta(microseconds=(time_ns + self.offset_ns) // 1000)

    def stamp(self, time_ns: int) -> str:
        """Return date and time to milliseconds, as columns of a report."""
        return self.moment(time_ns).strftime("%m/%d/%Y %H:%M:%S.%f")[:-3]

    def date_fields(self, time_ns: int) -> list[str]:
        """Return the values under DATE_LABELS."""
        at = self.moment(time_ns)
        numbers = (at.month, at.day, at.year, at.hour, at.minute, at.second, at.microsecond // 1000)
        return [str(number) for number in numbers]

    def report(self, title: str, lines: Iterable[str]) -> bytes:
        """Lay out a plain report: the relay's head, a title, lines ended by CR LF."""
        now = self.moment(self.now_ns)
        head = (
            f"{self.relay:<38}Date: {now:%m/%d/%Y}  Time: {now:%H:%M:%S}.{now.microsecond // 1000:03d}",
            f"FID={self.firmware}",
            "",
            title,
            "",
        )
        return "".join(f"{line}\r\n" for line in (*head, *lines)).encode("ascii", "replace")

    def compressed(self, labels: Iterable[str], rows: Iterable[Iterable[str]]) -> bytes:
        """Lay out a Compressed ASCII report: firmware, labels, rows, each line with its checksum."""
        head = [closed('"FID"'), closed(f'"FID={self.firmware}"')]
        head.append(closed(",".join(f'"{label}"' for label in labels)))
        return b"".join([*head, *(closed(",".join(row)) for row in rows)])
