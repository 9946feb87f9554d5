"""Write the tables of docs/evidence/track-record.md: python -m tests.chaos.track_record RESULT.json ..."""

import csv
import json
import sys
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

FOLDER = Path(__file__).parents[2] / "docs" / "evidence" / "data"
RUNS, FAULTS = "track-record-runs.csv", "track-record-faults-counted.csv"
HEADER = (
    "command", "relays of each profile", "faults", "records made", "lost", "doubled", "other content",
    "breaches", "from the relays", "made to stored: median, p95, longest", "integrity",
)  # fmt: skip


def row(result: Mapping[str, object]) -> list[str]:
    """One run's row of the table."""
    profiles, faults, delays = (_figures(result[key]) for key in ("profiles", "faults", "made_to_stored_s"))
    pulled = result["pulled_bytes"]
    breaches = result["breaches"]
    assert isinstance(pulled, int)
    assert isinstance(breaches, list)
    return [
        f"{result['command']}",
        ", ".join(f"{number:g} {name}" for name, number in profiles.items()),
        f"{sum(faults.values()):g}",
        f"{result['records_made']}, {result['half_records']} more by half",
        f"{result['lost']}",
        f"{result['doubled']}",
        f"{result['falsified']}",
        f"{len(breaches)}",
        f"{pulled / 1e6:.1f} MB",
        ", ".join(f"{delays[name]:.1f} s" for name in ("median", "p95", "longest")),
        f"{result['integrity']}",
    ]


def faults_in_all(results: Sequence[Mapping[str, object]]) -> list[list[str]]:
    """How often each fault, over all the runs, most frequent first."""
    counts: dict[str, float] = {}
    for result in results:
        for kind, number in _figures(result["faults"]).items():
            counts[kind] = counts.get(kind, 0) + number
    return [[kind, f"{number:g}"] for kind, number in sorted(counts.items(), key=lambda each: -each[1])]


def write(folder: Path, results: Sequence[Mapping[str, object]]) -> None:
    """Write the runs, and the faults of all of them, in place of those that are there."""
    _write(folder / RUNS, HEADER, map(row, results))
    _write(folder / FAULTS, ("fault", "times"), faults_in_all(results))


def _write(path: Path, header: Sequence[str], rows: Iterable[Sequence[str]]) -> None:
    with path.open("w", encoding="utf-8", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([header, *rows])


def _figures(value: object) -> dict[str, float]:
    assert isinstance(value, dict)
    return {str(name): float(number) for name, number in value.items()}


if __name__ == "__main__":
    write(FOLDER, [json.loads(Path(name).read_text(encoding="utf-8")) for name in sys.argv[1:]])
