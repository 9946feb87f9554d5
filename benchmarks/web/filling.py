"""A plant of 500 motors with years of records that end now, so that every page of it is full."""

import json
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from math import sin

from sqlalchemy import Connection, text, update

from benchmarks.storage.documents import condition_document
from benchmarks.storage.filling import Progress, load
from benchmarks.storage.plant import motor_name, plant_of, relay_name
from benchmarks.storage.rows import DIAGNOSIS, JOB, RECORDING, Row, Table, id_of
from core.units import NANOSECONDS_PER_DAY, NANOSECONDS_PER_SECOND
from service.storage import Repository, connect, migrate
from service.storage.models import Base
from service.storage.states import AlarmKind, LinkState
from testing.service.links import set_link_state
from testing.service.plants import fault as diagnosis_of

HOUR_NS = 3600 * NANOSECONDS_PER_SECOND

LONG = 0
"""This motor has LONG_RECORDS records, whatever the others have."""
LONG_RECORDS = 100_000

FAULTY_EVERY, WATCHED_EVERY, STALE_EVERY, STANDING_EVERY = 40, 17, 29, 23
"""Every so many motors are in that state."""


@dataclass(frozen=True, slots=True)
class Plan:
    """How much there is. records: of each motor, an hour apart."""

    motors: int = 500
    records: int = 10_000
    now_ns: int = 0

    def of(self, motor: int) -> int:
        return max(LONG_RECORDS, self.records) if motor == LONG else self.records

    def each(self) -> Iterator[tuple[int, int, int]]:
        """Yield a number, the motor and the time of every record."""
        number = 0
        for motor in range(self.motors):
            records = self.of(motor)
            step_ns = HOUR_NS * self.records // records
            last_ns = self.last_ns(motor)
            for at in range(records):
                yield number, motor, last_ns - (records - 1 - at) * step_ns
                number += 1

    def last_ns(self, motor: int) -> int:
        """Return the time of a motor's latest record."""
        ago_ns = 30 * NANOSECONDS_PER_DAY if motor % STALE_EVERY == 1 else (motor % 50 + 1) * 60 * 10**9
        return self.now_ns - ago_ns


def fill(url: str, plan: Plan, progress: Progress = lambda _line: None) -> None:
    """Migrate the database at this URL, and put the plant and its records into it."""
    migrate(url)
    engine = connect(url)
    repository = Repository(engine)
    repository.sync_plant(plant_of(plan.motors))
    load(engine, _tables(plan), progress)
    with engine.begin() as connection:
        connection.execute(text(DAYS))
        _judge(connection, plan)
    now_ns = time.time_ns()
    repository.settle_alarms(now_ns=now_ns)
    for number in range(plan.motors):
        set_link_state(repository, relay_name(number), LinkState.UP, None, now_ns=now_ns)
    for number in range(0, plan.motors, 25):
        relay = relay_name(number)
        repository.raise_alarm(relay, AlarmKind.FILE_REFUSED, "HR_1.CFG", "too short", now_ns=now_ns)
    engine.dispose()


DAYS = f"""
    INSERT INTO condition_days (motor, day_ns, records, mu_f_least, mu_f_mean, mu_f_largest)
    SELECT motor, time_ns - time_ns % {NANOSECONDS_PER_DAY} AS of_day,
        count(*), min(mu_f), avg(mu_f), max(mu_f)
    FROM observations WHERE state IS NOT NULL GROUP BY motor, of_day
"""  # noqa: S608 - the number is our own
"""As a fold keeps them, for records that no fold has seen."""


def _tables(plan: Plan) -> Iterator[Table]:
    yield Table("recordings", _RECORDING, _recordings(plan))
    yield Table("jobs", _JOB, _jobs(plan))
    yield Table("diagnoses", _DIAGNOSIS, _diagnoses(plan))
    yield Table("observations", _OBSERVATION, _observations(plan))


_RECORDING = (
    "id", "motor", "ied", "source", "name", "digest", "size_bytes", "state", "attempts", "announced_ns",
    "fetched_ns", "recorded_ns", "operation",
)  # fmt: skip


def _recordings(plan: Plan) -> Iterator[Row]:
    for number, motor, time_ns in plan.each():
        yield (
            id_of(RECORDING, number), motor_name(motor), relay_name(motor), "relay", f"HR_{number:08d}",
            f"{number:064x}", 204_800, "diagnosed", 0, time_ns, time_ns, time_ns, "running",
        )  # fmt: skip


_JOB = (
    "id", "recording_id", "method", "model", "state", "attempts", "not_before_ns", "created_ns", "started_ns",
    "finished_ns",
)  # fmt: skip


def _jobs(plan: Plan) -> Iterator[Row]:
    for number, _motor, time_ns in plan.each():
        yield (
            id_of(JOB, number), id_of(RECORDING, number), "hcpa", "split-winding", "done", 1, time_ns,
            time_ns, time_ns, time_ns,
        )  # fmt: skip


_DIAGNOSIS = (
    "id", "job_id", "recording_id", "motor", "current", "created_ns", "recorded_ns", "verdict", "mu_f",
    "mu_f_ci95_low", "mu_f_ci95_high", "theta_f", "load_level", "method", "model", "document",
)  # fmt: skip


def _diagnoses(plan: Plan) -> Iterator[Row]:
    documents = _document(0.004), _document(0.05)
    for number, motor, time_ns in plan.each():
        mu_f = level(motor, number)
        yield (
            id_of(DIAGNOSIS, number), id_of(JOB, number), id_of(RECORDING, number), motor_name(motor), True,
            time_ns, time_ns, "fault" if mu_f > 0.02 else "healthy", mu_f, max(0.0, mu_f - 0.002),
            mu_f + 0.002, 1, 0.5 + 0.3 * sin(number / 50), "hcpa", "split-winding", documents[mu_f > 0.02],
        )  # fmt: skip


def _document(mu_f: float) -> str:
    """Return the JSON of a diagnosis without its findings: those of so many would fill a disk."""
    return json.dumps(replace(diagnosis_of(mu_f), quality=()).as_dict())


_FIGURES = ("state", "kind", "phase", "mu_f", "mu_f_ci95_low", "mu_f_ci95_high", "change", "change_ci95_low",
            "change_ci95_high")  # fmt: skip
_OBSERVATION = (
    "recording_id", "motor", "time_ns", "recorder", "sequence", "voltage_channels", "frequency_hz",
    "positive_voltage_re", "positive_voltage_im", "negative_voltage_re", "negative_voltage_im",
    "zero_voltage_re", "zero_voltage_im", "positive_current_re", "positive_current_im",
    "negative_current_re", "negative_current_im", "zero_current_re", "zero_current_im", "scatter", "cycles",
    "load_level", *_FIGURES,
)  # fmt: skip


def _observations(plan: Plan) -> Iterator[Row]:
    for number, motor, time_ns in plan.each():
        load_level = 0.5 + 0.3 * sin(number / 50)
        yield (
            id_of(RECORDING, number), motor_name(motor), time_ns, "RELAY 100:1", "abc", "phase", 50.02, 325.0,
            1.5, -1.25 + 0.3 * sin(number / 7), 0.5, 0.1, -0.3, 2.1, -1.3, 0.02, 0.011, 1e-3, 2e-3, 1.2e-8,
            12, load_level, *_said(motor, level(motor, number)),
        )  # fmt: skip


def level(motor: int, number: int) -> float:
    """Return a fault level that wanders: above the limit for motors with a fault."""
    standing = 0.03 if motor % FAULTY_EVERY == 0 else 0.012 if motor % WATCHED_EVERY == 0 else 0.002
    return standing + 0.001 * sin(number / 40) + number % 97 / 97_000


def _said(motor: int, mu_f: float) -> Sequence[object]:
    state, kind, phase = "healthy", "none", None
    if motor % FAULTY_EVERY == 0:
        state, kind, phase = "fault", "shorted-turns", "b"
    elif motor % WATCHED_EVERY == 0:
        state, kind = "watch", "unclear"
    low, high = max(0.0, mu_f - 0.002), mu_f + 0.002
    return state, kind, phase, mu_f, low, high, mu_f - 0.001, low, high


def _judge(connection: Connection, plan: Plan) -> None:
    """Give each motor the condition that its records lead to."""
    conditions = Base.metadata.tables["conditions"]
    for motor in range(plan.motors):
        figures = dict(zip(_FIGURES, _said(motor, level(motor, plan.records)), strict=True))
        last_ns = plan.last_ns(motor)
        since_ns = None if figures["state"] == "healthy" else last_ns - 9 * NANOSECONDS_PER_DAY
        connection.execute(
            update(conditions)
            .where(conditions.c.motor == motor_name(motor))
            .values(
                version=1,
                as_of_ns=last_ns,
                since_ns=since_ns,
                stood_ns=plan.now_ns if motor % STANDING_EVERY == 2 else None,
                document=condition_document(),
                **figures,
            )
        )
