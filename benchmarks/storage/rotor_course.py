"""How long the rotor's condition of a motor with many records takes: to read, and to keep another record.

    python -m benchmarks.storage.rotor_course

It fills an SQLite file with findings of one motor, in six load bins, every tenth of which cannot tell, and
times the repository. The last column is a record that comes late, before all others of its load: its baseline
changes, and all records after it are judged again. To keep one is timed with forgetting it.
"""

import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from statistics import median

from sqlalchemy import Engine, insert
from sqlalchemy.orm import Session

from benchmarks.reporting import table
from benchmarks.storage.forgetting import plant
from core.rotor.finding import RotorState
from service.configuration.settings import sqlite_url
from service.storage import Repository, connect, migrate
from service.storage.models import RotorFindingRow
from service.storage.repository.history.rotor import forget_rotor_finding, keep_rotor_finding
from testing.service.plants import NOW_NS, SECOND_NS
from testing.service.rotor_and_supply import SOUND_ROTOR

SIZES = (1_000, 10_000, 100_000)
TURNS = 20
BINS = 6
OTHER_BASELINE = replace(SOUND_ROTOR, severity_dB=-45.0, load_bin=3)


def main() -> None:
    """Fill, time and print."""
    rows = []
    for size in SIZES:
        with tempfile.TemporaryDirectory() as folder:
            url = sqlite_url(Path(folder))
            migrate(url)
            engine = connect(url)
            repository = Repository(engine)
            repository.sync_plant(plant(), noted_ns=NOW_NS)
            motor = plant().motors[0].name
            _fill(engine, motor, size)
            late_ns, next_ns = NOW_NS - SECOND_NS, NOW_NS + size * SECOND_NS
            times = (
                _milliseconds(partial(repository.rotor_condition, motor)),
                _milliseconds(partial(_keep, engine, motor, next_ns)),
                _milliseconds(partial(_keep, engine, motor, late_ns), turns=3),
            )
            rows.append((f"{size:,}", *times))
            engine.dispose()
    print("\n".join(table(("records", "condition read", "a record kept", "a late one kept"), rows)))


def _fill(engine: Engine, motor: str, size: int) -> None:
    with engine.begin() as connection:
        connection.execute(
            insert(RotorFindingRow),
            [
                {
                    "recording_id": f"{number:036}",
                    "motor": motor,
                    "time_ns": NOW_NS + number * SECOND_NS,
                    "state": RotorState.HEALTHY if number % 10 else RotorState.UNSUPPORTED,
                    "severity_dB": -48.0 - number % 7,
                    "severity_dB_ci95_low": -52.0 - number % 7,
                    "severity_dB_ci95_high": -45.0 - number % 7,
                    "load_bin": 3 + number // 10 % BINS,
                    "duration_s": 10.0,
                    "reasons": SOUND_ROTOR.reasons,
                    "condition": RotorState.HEALTHY if number % 10 else None,
                }
                for number in range(size)
            ],
        )


def _keep(engine: Engine, motor: str, time_ns: int) -> None:
    """Keep a finding and forget it again; both judge what stands about it."""
    with Session(engine) as session, session.begin():
        keep_rotor_finding(session, "another", motor, time_ns, OTHER_BASELINE)
        forget_rotor_finding(session, "another")


def _milliseconds(action: Callable[[], object], turns: int = TURNS) -> str:
    took = []
    for _ in range(turns + 1):
        began = time.perf_counter()
        action()
        took.append(time.perf_counter() - began)
    return f"{1000.0 * median(took[1:]):.1f} ms"


if __name__ == "__main__":
    main()
