"""Reading speed beside that of an earlier commit: python -m benchmarks.recordings.beside_commit COMMIT [CSV].

Both read the same files, in processes that take turns. The time is the processor's: what else the machine
does counts little, and of each file the shortest of all turns is taken.
"""

import argparse
import csv
import json
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

from benchmarks.reporting import table
from core.recordings import Recording, comtrade
from core.recordings.cev.writer import EventSummary, write_cev
from testing.machines.motors import REFERENCE
from testing.machines.phase_circuits import recording, running

GIT = shutil.which("git") or "git"
TURNS = 5
LENGTHS_S = (1.0, 5.0)
RATE_HZ, SAMPLES_A_CYCLE = 1_600.0, 32
"""Of event reports; COMTRADE has 10 kHz."""
HEADER = ("file", "MB", "before, ms", "now, ms", "ratio")
READER = """
import json, sys
from pathlib import Path
from time import process_time
from core.recordings import read
shortest = {}
for name in sys.argv[1:]:
    read(Path(name))
    times = []
    while len(times) < 5 or sum(times) < 1.0:
        begun = process_time()
        read(Path(name))
        times.append(process_time() - begun)
    shortest[name] = min(times)
print(json.dumps(shortest))
"""
"""What a process of either commit runs."""


def rows(commit: str) -> list[list[str]]:
    """One row a file: its size, the time of the commit and of this code, and the latter over the former."""
    with tempfile.TemporaryDirectory() as folder, _checked_out(commit, Path(folder) / "before") as before:
        files = list(_files(Path(folder)))
        sides = {"before": before, "now": Path.cwd()}
        shortest = {side: dict.fromkeys(map(str, files), float("inf")) for side in sides}
        for _ in range(TURNS):
            for side, code in sides.items():
                for name, seconds in _read(code, files).items():
                    shortest[side][name] = min(shortest[side][name], seconds)
        found = []
        for file in files:
            earlier, now = shortest["before"][str(file)], shortest["now"][str(file)]
            found.append(
                [
                    file.stem,
                    f"{_bytes(file) / 1e6:.2f}",
                    f"{earlier * 1e3:.2f}",
                    f"{now * 1e3:.2f}",
                    f"{now / earlier:.2f}",
                ]
            )
        return found


def _files(folder: Path) -> Iterator[Path]:
    for length_s in LENGTHS_S:
        record = recording(running(REFERENCE, 0.5), seconds=length_s)
        channels = tuple(replace(channel, full_scale=1000.0) for channel in record.channels)
        record = replace(record, channels=channels, start_time_ns=0)
        for kind in ("ASCII", "BINARY", "FLOAT32"):
            path = folder / f"{kind} {length_s:g} s.cfg"
            yield comtrade.write(path, record, revision=2013, data_format=kind)
        yield comtrade.write(
            folder / f"CFF binary {length_s:g} s.cff", record, revision=2013, data_format="BINARY"
        )
        yield write_cev(folder / f"CEV {length_s:g} s.cev", _thinned(record), EventSummary(SAMPLES_A_CYCLE))


def _thinned(record: Recording) -> Recording:
    """As many of the record's samples as an event report has."""
    count = round(record.samples.shape[1] / record.sample_rate_hz * RATE_HZ)
    return replace(record, samples=record.samples[:, :count], sample_rate_hz=RATE_HZ)


def _bytes(file: Path) -> int:
    data = file.with_suffix(".dat")
    return (data if data.exists() else file).stat().st_size


def _read(code: Path, files: list[Path]) -> dict[str, float]:
    """Shortest times of one process of that code [s]."""
    environment = {**os.environ, "PYTHONPATH": str(code)}
    command = [sys.executable, "-c", READER, *map(str, files)]
    run = subprocess.run(command, cwd=code, env=environment, check=True, capture_output=True, text=True)
    return {str(name): float(seconds) for name, seconds in json.loads(run.stdout).items()}


@contextmanager
def _checked_out(commit: str, folder: Path) -> Iterator[Path]:
    """The files of a commit, for as long as they are needed."""
    subprocess.run([GIT, "worktree", "add", "--quiet", "--detach", str(folder), commit], check=True)
    try:
        yield folder
    finally:
        subprocess.run([GIT, "worktree", "remove", "--force", str(folder)], check=True)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("commit", help="what is compared with")
    parser.add_argument("csv", type=Path, nargs="?", help="where the table is written, too")
    options = parser.parse_args()
    measured = rows(options.commit)
    print("\n".join(table(HEADER, measured)))
    if options.csv is not None:
        with options.csv.open("w", encoding="utf-8", newline="") as written:
            csv.writer(written, lineterminator="\n").writerows([HEADER, *measured])
