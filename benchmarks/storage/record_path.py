"""What a small record costs the database on its way: python -m benchmarks.storage.record_path [--records 60]

A record of a relay goes through the calls that collector, service and workers make for it: noted, claimed,
its diagnosis kept, its motor folded. Told for each: SQL statements, and CPU
time of this process. What is diagnosed is made up; the folding of it is real.
"""

import argparse
import tempfile
import time
from collections import defaultdict
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from statistics import median
from typing import Any

from sqlalchemy import Engine, event

from benchmarks.reporting import table
from benchmarks.storage.forgetting import plant
from core.condition.observation import Observation
from service.condition.folding import fold
from service.configuration.settings import sqlite_url
from service.plant import PlantMotor
from service.recording_store.folder import FolderStore
from service.recording_store.store import RecordingStore
from service.storage import Repository, connect, migrate
from service.storage.records import RemoteRecord
from testing.service.findings import findings_of
from testing.service.job_runner import RUNNER, register_runner
from testing.service.observations import records_of_a_motor
from testing.service.plants import NOW_NS, healthy
from testing.service.rotor_and_supply import SOUND_ROTOR, SUPPLY

WARM_UP = 20
"""Records before the first that counts: statements are compiled then, and the motor has its first records."""


class Costs:
    """Statements and CPU time of each call."""

    def __init__(self, engine: Engine) -> None:
        self.statements: dict[str, list[int]] = defaultdict(list)
        self.cpu_ms: dict[str, list[float]] = defaultdict(list)
        self._number = 0
        event.listen(engine, "before_cursor_execute", self._count)

    def _count(self, *_of_statement: Any) -> None:
        self._number += 1

    @contextmanager
    def of(self, call: str) -> Iterator[None]:
        before, begun_s = self._number, time.process_time()
        yield
        self.cpu_ms[call].append(1000 * (time.process_time() - begun_s))
        self.statements[call].append(self._number - before)


def measure(records: int) -> Iterator[tuple[str, str, str]]:
    """Yield a row for each call, and one for all."""
    with tempfile.TemporaryDirectory(prefix="statorwatch-record-path-") as name:
        directory = Path(name)
        url = sqlite_url(directory)
        migrate(url)
        engine = connect(url)
        repository = Repository(engine)
        repository.sync_plant(plant(), noted_ns=NOW_NS)
        register_runner(repository)
        costs = Costs(engine)
        of_motor = plant().motors[0]
        path = _Path(repository, FolderStore(directory / "recordings"), costs)
        for number, observed in enumerate(records_of_a_motor(WARM_UP + records)):
            path.take(number, observed, of_motor)
        engine.dispose()
    all_ms, all_statements = 0.0, 0.0
    for call, spent_ms in costs.cpu_ms.items():
        statements, each_ms = median(costs.statements[call][WARM_UP:]), median(spent_ms[WARM_UP:])
        all_ms, all_statements = all_ms + each_ms, all_statements + statements
        yield call, f"{statements:g}", f"{each_ms:.2f}"
    yield "together", f"{all_statements:g}", f"{all_ms:.2f}"


class _Path:
    """The way of a record."""

    def __init__(self, repository: Repository, store: RecordingStore, costs: Costs) -> None:
        self._repository, self._store, self._costs = repository, store, costs

    def take(self, number: int, observed: Observation, of_motor: PlantMotor) -> None:
        """Take one record all the way."""
        repository, costs = self._repository, self._costs
        motor, now_ns = of_motor.motor.name, observed.time_ns
        relay = of_motor.relay
        stored = self._store.store({f"R{number}.CFF": f"{motor} {number}".encode()})
        remote = RemoteRecord(f"R{number}", stored.size_bytes, now_ns)
        with costs.of("collector: known or deleted?"):
            repository.remote_recordings(relay, [remote])
            repository.deleted_remote_records(relay, [remote])
        with costs.of("collector: note the recording"):
            repository.keep_deleted(stored, motor=motor, relay=relay, remote=remote, now_ns=now_ns)
            repository.add_recording(stored, motor=motor, relay=relay, remote=remote, now_ns=now_ns)
        with costs.of("service: claim the job"):
            claimed = repository.claim_job(now_ns=now_ns, runner=RUNNER)
        assert claimed is not None
        with costs.of("service: claim in vain"):
            repository.claim_job(now_ns=now_ns, runner=RUNNER)
        with costs.of("service: keep the diagnosis"):
            repository.finish_job(
                claimed.job.id,
                findings_of(
                    healthy(),
                    observation=observed,
                    rotor=replace(SOUND_ROTOR, severity_dB=-68.0 - number % 7),
                    supply=SUPPLY,
                    duration_s=1.0,
                    pre_trigger_s=0.2,
                ),
                recorded_ns=observed.time_ns,
                now_ns=now_ns,
                runner=RUNNER,
            )
        with costs.of("service: what is to be folded"):
            repository.earliest_marks()
        with costs.of("worker: begin the fold"):
            due = repository.begin_fold(motor, 2000)
        assert due is not None
        with costs.of("worker: fold"):
            result = fold(due, of_motor.motor)
        with costs.of("worker: keep the fold"):
            repository.finish_fold(due, result, now_ns=now_ns)


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.storage.record_path", description=__doc__)
    parser.add_argument("--records", type=int, default=60)
    rows = list(measure(parser.parse_args().records))
    print("\n".join(table(["call", "statements", "CPU [ms]"], rows)))


if __name__ == "__main__":
    main()
