"""Time and peak memory of exports, read from a database and written: python -m benchmarks.exports [ROWS]."""

import subprocess
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter, process_time

from benchmarks.reporting import table
from core.quantities import Subject
from core.units import NANOSECONDS_PER_SECOND
from service.exports import measurements
from service.exports.formats import Format
from service.exports.tables import Table
from service.exports.trends import TABLE as TRENDS
from service.exports.trends import TrendRow
from service.exports.writing import pieces
from service.plant import AveragingStep
from service.storage import Repository, connect
from service.storage.records import Sample
from testing.memory_folder import memory_folder
from testing.service.database import make_database
from testing.service.plants import NOW_NS, two_motor_plant

ROWS = 100_000
FEW = 1_000
VALUES = {
    "ia_A": 7.51,
    "ib_A": 7.49,
    "ic_A": 7.5,
    "vab_V": 400.2,
    "vbc_V": 399.8,
    "vca_V": 400.1,
    "power_W": 812.5,
}
PAGE = 10_000
MIB = 1 << 10
"""Kibibytes of a mebibyte."""


def main() -> None:
    rows = int(sys.argv[1]) if len(sys.argv) > 1 else ROWS
    with TemporaryDirectory(dir=memory_folder()) as name:
        url = make_database(Path(name))
        _fill(url, rows)
        lines = [
            _line(subject, wanted, rows, url) for subject in ("measurements", "trend") for wanted in Format
        ]
    header = ("Table", "Format", "Rows", "Time", "Of a core", "Size", "Peak memory", "With 1,000 rows")
    print("\n".join(table(header, lines)))


def _line(subject: str, wanted: Format, rows: int, url: str) -> Sequence[str]:
    """Return what one export costs in a process of its own."""
    seconds, core_s, size_bytes, peak_kib = _measured(subject, wanted, rows, url)
    *_, few_kib = _measured(subject, wanted, FEW, url)
    return (
        subject,
        wanted,
        f"{rows:,}",
        f"{float(seconds):.1f} s",
        f"{float(core_s):.1f} s",
        f"{int(size_bytes) / 1e6:.1f} MB",
        f"{int(peak_kib) / MIB:.0f} MiB",
        f"{int(few_kib) / MIB:.0f} MiB",
    )


def _measured(subject: str, wanted: Format, rows: int, url: str) -> Sequence[str]:
    words = [sys.executable, "-m", "benchmarks.exports.__main__", "--export", subject, wanted, str(rows), url]
    return subprocess.run(words, check=True, capture_output=True, text=True).stdout.split()


def _export(subject: str, wanted: Format, rows: int, url: str) -> None:
    """Write one export to nowhere, and print seconds, bytes and the peak of this process' memory."""
    begun_s = perf_counter()
    made = pieces(wanted, TRENDS, _trend(rows)) if subject == "trend" else _measurements(wanted, rows, url)
    size_bytes = sum(map(len, made))
    print(perf_counter() - begun_s, process_time(), size_bytes, _peak_kib())


def _peak_kib() -> int:
    """The most memory that this program has had; that of getrusage counts what ran before it, too."""
    status = Path("/proc/self/status").read_text()
    return int(status.partition("VmHWM:")[2].split()[0])


def _measurements(wanted: Format, rows: int, url: str) -> Iterator[bytes]:
    """The measurements of a motor, from the database."""
    repository = Repository(connect(url))
    chosen: Table[measurements.MotorMeasurement] = measurements.TABLE
    found = measurements.measurements(
        repository, ["PUMP-A1"], AveragingStep.AS_SAMPLED, to_ns=NOW_NS + rows * NANOSECONDS_PER_SECOND
    )
    return pieces(wanted, chosen, found)


def _trend(rows: int) -> Iterator[Sequence[TrendRow]]:
    """A trend without a database, each recording with all figures."""
    level = (0.047, 0.055, 0.049, 0.053, 0.021)
    for first in range(0, rows, 1000):
        batch = []
        for at in range(first, min(first + 1000, rows)):
            time_ns, recording_id = NOW_NS + at * 3600 * NANOSECONDS_PER_SECOND, f"{at:036d}"
            mu_f, load = 0.051 + 1e-6 * at, 0.48 + 1e-7 * at
            told: dict[Subject, Sequence[object]] = {
                Subject.STATOR: ("fault", mu_f, *level, 1, load, 0.46, 0.5),
                Subject.CONDITION: ("fault", "shorted-turns", "b", mu_f, 0.047, 0.055, mu_f, 0.047, 0.055),
            }
            batch.append(TrendRow("PUMP-A1", time_ns, recording_id, told))
        yield batch


def _fill(url: str, rows: int) -> None:
    repository = Repository(connect(url))
    repository.sync_plant(two_motor_plant())
    for first in range(0, rows, PAGE):
        repository.add_samples(
            Sample("PUMP-A1", NOW_NS + at * NANOSECONDS_PER_SECOND, VALUES)
            for at in range(first, min(first + PAGE, rows))
        )


if __name__ == "__main__":
    if sys.argv[1:2] == ["--export"]:
        _export(sys.argv[2], Format(sys.argv[3]), int(sys.argv[4]), sys.argv[5])
    else:
        main()
