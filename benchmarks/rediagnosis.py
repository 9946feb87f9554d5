"""Diagnose an archive again on 1, 2 and 4 processes: python -m benchmarks.rediagnosis."""

import os
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from benchmarks.reporting import Section, table, write_sections
from core.diagnosis.methods import DEFAULT_METHOD, DEFAULT_MODEL
from service.application.rediagnosis import Progress, Wanted, rediagnose
from service.jobs.dask_workers import DaskWorkers
from service.process.logs import without_logs
from service.storage.records.actors import SERVICE
from testing.service.archive import MOTOR, Archive, make_archive

PAGE = Path(__file__).parents[1] / "docs" / "evidence" / "rediagnosis.md"
PREAMBLE = """\
# Diagnosing an archive again

[A batch](../how-to/rediagnose.md) on processes of one machine: recordings of 0.6 s, 8 waveforms at 4 kHz, of
one motor, on SQLite.
"""
RECORDS, LOADED = 280, 10
PROCESSES = (1, 2, 4)
PLANNED, ARCHIVE = 100, 1_000_000
SECONDS_PER_HOUR = 3600.0
MILLISECONDS = 1000.0


@dataclass(frozen=True, slots=True)
class Run:
    """A batch, once its workers are loaded.

    main_s: processor time of the command and of its scheduler, without the workers.
    """

    processes: int
    records: int
    took_s: float
    main_s: float

    @property
    def per_s(self) -> float:
        return self.records / self.took_s


def processor_time_s(pid: int) -> float:
    """What a process has used by itself (proc(5): utime and stime, the 14th and 15th field) [s]."""
    fields = Path(f"/proc/{pid}/stat").read_text(encoding="ascii").rpartition(")")[2].split()
    return sum(map(int, fields[11:13])) / os.sysconf("SC_CLK_TCK")


def measure(archive: Archive, processes: int) -> Run:
    """Diagnose all again; what counts begins when each worker has made some."""
    steps: list[tuple[int, float, float]] = []
    wanted = Wanted((MOTOR,), DEFAULT_METHOD, DEFAULT_MODEL, time.time_ns())

    def note(progress: Progress) -> None:
        if progress.made >= LOADED * processes:
            used_s = time.process_time() + processor_time_s(workers.client_pid)
            steps.append((progress.made, time.perf_counter(), used_s))

    with DaskWorkers.of_this_machine(processes) as workers, without_logs():
        done = rediagnose(archive.settings, archive.plant, archive.repository, workers, wanted, SERVICE, note)
    assert done.made == RECORDS, done
    first, last = steps[0], next(step for step in steps if step[0] == RECORDS)
    records, took_s, main_s = (after - before for before, after in zip(first, last, strict=True))
    return Run(processes, int(records), took_s, main_s)


def section(runs: Sequence[Run], load: tuple[float, float]) -> Section:
    alone = runs[0]
    rows = [
        [
            str(run.processes),
            str(run.records),
            f"{run.took_s:.1f}",
            f"{run.per_s:.1f}",
            f"{run.per_s / alone.per_s:.2f}",
            f"{run.per_s / alone.per_s / run.processes:.0%}",
            f"{run.main_s / run.records * MILLISECONDS:.1f}",
        ]
        for run in runs
    ]
    header = [
        "processes",
        "recordings",
        "time [s]",
        "recordings a second",
        "speed-up",
        "efficiency",
        "command's CPU [ms]",
    ]
    lines = (
        *table(header, rows),
        "",
        f"{os.cpu_count()} cores, which the command and its scheduler share with the workers. Workers are "
        "loaded before. The last column is the command's own processor time for a "
        "recording, with that of the process of its scheduler: queue, scheduler, database, audit trail. Load "
        f"average of the machine when it began and ended: {load[0]:.1f} and {load[1]:.1f}; without other "
        "work the first is near 0, the second below 5.",
    )
    return Section("processes", "Efficiency", "python -m benchmarks.rediagnosis", lines)


def plan(alone: Run) -> Section:
    """What a hundred processes would do, by the figures of one; not measured."""
    main_s = alone.main_s / alone.records
    worker_s = 1.0 / alone.per_s - main_s
    most_per_s = 1.0 / main_s
    rows = []
    for times in (1, 10, 100):
        wanted_per_s = PLANNED / (worker_s * times)
        reached_per_s = min(wanted_per_s, most_per_s)
        rows.append(
            [
                f"{worker_s * times:.2g}",
                f"{wanted_per_s:.0f}",
                f"{reached_per_s:.0f}",
                f"{reached_per_s / wanted_per_s:.0%}",
                f"{ARCHIVE / reached_per_s / SECONDS_PER_HOUR:.1f}",
            ]
        )
    header = [
        "worker's time for a recording [s]",
        f"{PLANNED} processes could do [1/s]",
        "with one command [1/s]",
        "efficiency",
        f"{ARCHIVE:,} recordings [h]",
    ]
    lines = (
        *table(header, rows),
        "",
        "Not measured: it follows from the figures of one process. A command takes "
        f"{main_s * MILLISECONDS:.1f} ms of one core for each recording, {most_per_s:.0f} recordings a "
        f"second at most, so it keeps {worker_s / main_s:.0f} processes busy with recordings as short as "
        "these. They are the first row; the others take the workers longer (more samples, other methods). "
        "Beyond that the way is several commands, one for each part of the motors (`--motor`), each with a "
        "data directory and a core of its own, on PostgreSQL; they then share the head of the audit trail, "
        "which takes one transaction at a time. Reading the files over a network is not in the plan.",
    )
    return Section("plan", "On paper: 100 processes", "python -m benchmarks.rediagnosis", lines)


def main() -> None:
    runs, load_before = [], os.getloadavg()[0]
    for processes in PROCESSES:
        with TemporaryDirectory() as directory:
            archive = make_archive(Path(directory), RECORDS)
            runs.append(measure(archive, processes))
            archive.engine.dispose()
        print(runs[-1])
    load = (load_before, os.getloadavg()[0])
    write_sections(PAGE, PREAMBLE, ("processes", "plan"), (section(runs, load), plan(runs[0])))


if __name__ == "__main__":
    main()
