"""Tell what the text reports of a motor relay say.

python examples/read_relay_reports.py FOLDER

FOLDER has MSR.TXT, LDP.TXT, MOT.TXT and SER.TXT, or some of them, as they were fetched from the REPORTS/ of a
SEL-710, real or simulated.
"""

import sys
from pathlib import Path

from core.relay_reports import (
    ReportError,
    read_load_profile,
    read_motor_starts,
    read_motor_statistics,
    read_sequence_of_events,
)
from core.time_stamps import rfc3339

SECONDS = len("2026-01-31T12:00:00")
HOUR_S = 3600.0


def main() -> None:
    """Print what is there of the reports in the folder."""
    if len(sys.argv) != 2 or not (folder := Path(sys.argv[1])).is_dir():
        raise SystemExit("usage: python examples/read_relay_reports.py FOLDER")
    tellers = {"MSR": tell_starts, "LDP": tell_load, "MOT": tell_statistics, "SER": tell_events}
    for name, tell in tellers.items():
        path = folder / f"{name}.TXT"
        if not path.exists():
            print(f"{name}: none")
            continue
        try:
            tell(path)
        except ReportError as error:
            raise SystemExit(str(error)) from error


def tell_starts(path: Path) -> None:
    """Print each start."""
    for start in read_motor_starts(path, name=path.name):
        lasted = "did not end" if start.duration_s is None else f"{start.duration_s:.2f} s"
        print(f"start {clock(start.time_ns)}: {lasted}, at most {start.peak_current_A} A")


def tell_load(path: Path) -> None:
    """Print how long the load profile is, and the mean of each column."""
    rows = read_load_profile(path, name=path.name)
    means = ", ".join(f"{label} {column.mean():.4g}" for label, column in rows.values.items() if column.size)
    print(f"load profile: {rows.time_ns.size} rows; mean {means or 'of nothing'}")


def tell_statistics(path: Path) -> None:
    """Print hours and starts."""
    found = read_motor_statistics(path, name=path.name)
    hours = "unknown" if found.running_s is None else f"{found.running_s / HOUR_S:.1f} h"
    print(f"statistics: running {hours}, {found.starts} starts, trips {dict(found.trips) or 'unknown'}")


def tell_events(path: Path) -> None:
    """Print the latest changes."""
    for change in read_sequence_of_events(path, name=path.name)[-10:]:
        state = "" if change.asserted is None else ("on" if change.asserted else "off")
        print(f"{clock(change.time_ns)} {change.element} {state}".rstrip())


def clock(time_ns: int) -> str:
    """Return a time of the relay's clock to seconds."""
    return rfc3339(time_ns)[:SECONDS]


if __name__ == "__main__":
    main()
