"""Rows of ten years that the database makes itself: statements that insert many, in the order of their times.

Ten million rows from Python take an hour; `INSERT ... SELECT` over a series of numbers takes minutes, on
SQLite and on PostgreSQL. The words of both are the same but for those that write a number in hexadecimal.
"""

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from benchmarks.storage.documents import document
from core.units import NANOSECONDS_PER_DAY, NANOSECONDS_PER_SECOND
from service.plant import AveragingStep

END_NS = 1_760_000_000 * NANOSECONDS_PER_SECOND
YEARS_NS = 10 * 365 * NANOSECONDS_PER_DAY
BEGIN_NS = END_NS - YEARS_NS
"""Ten years of all there is end at END_NS."""

MOTORS = 500
ROWS_A_STATEMENT = 250_000

MEASURED_SHARES: Mapping[AveragingStep, float] = {
    AveragingStep.QUARTER_HOUR: 0.77,
    AveragingStep.MINUTE: 0.20,
    AveragingStep.AS_SAMPLED: 0.03,
}
"""Which part of the measured values are means and samples; the default settings come to about that."""

MEASURED_SPANS_NS: Mapping[AveragingStep, int] = {
    AveragingStep.QUARTER_HOUR: YEARS_NS,
    AveragingStep.MINUTE: 31 * NANOSECONDS_PER_DAY,
    AveragingStep.AS_SAMPLED: NANOSECONDS_PER_DAY,
}
"""How far back each reaches: as long as the default settings keep it."""

SHORT_FINDINGS = 5
"""A document of a diagnosis has so many findings here, and some thirty in service."""

_SCATTER = 2_654_435_761
_LEVEL = "(n % 997) / 20000.0"
_TIME = ":begin + n * :step"
_MEASURED = {
    "ia_A": "10.0 + n % 97 * 0.01",
    "ib_A": "10.1 + n % 89 * 0.01",
    "ic_A": "10.2 + n % 83 * 0.01",
    "vab_V": "398.0 + n % 71 * 0.1",
    "vbc_V": "399.0 + n % 67 * 0.1",
    "vca_V": "397.5 + n % 61 * 0.1",
    "power_W": "5500.0 + n % 59",
    "reactive_power_var": "3100.0 + n % 53",
    "power_factor": "0.86 + n % 47 * 0.0001",
    "frequency_Hz": "50.0 + n % 43 * 0.001",
}


@dataclass(frozen=True, slots=True)
class Bulk:
    """One table: its name, the SQL expression of each column, its number of rows, and parameters.

    An expression may use the number n of the row, `motor` (its motor's name) and `relay`.
    rows_a_number: rows that a number n has; one for each motor, or one in all.
    """

    table: str
    columns: Mapping[str, str]
    numbers: int
    parameters: Mapping[str, object]
    for_each_motor: bool = False

    @property
    def rows(self) -> int:
        return self.numbers * (MOTORS if self.for_each_motor else 1)


def bulk_id(kind: int, number: int) -> str:
    """Return the id of a row: scattered like a random one, with its number at the end."""
    return f"{number * _SCATTER % 2**32:08x}-0000-4000-800{kind:x}-{number:012x}"


RECORDING, JOB, DIAGNOSIS = range(3)


def bulks(dialect: str, diagnoses: int, measurements: int) -> Iterator[Bulk]:
    """Yield the tables to be filled, those first that others refer to."""
    ids = [_id(dialect, kind) for kind in (RECORDING, JOB, DIAGNOSIS)]
    times = {"begin": BEGIN_NS, "step": YEARS_NS // diagnoses}
    for table, columns in (
        ("recordings", _recording(ids[RECORDING], _hex(dialect, "n", 64))),
        ("jobs", _job(ids[JOB], ids[RECORDING])),
        ("diagnoses", _diagnosis(dialect, ids[DIAGNOSIS], ids[JOB], ids[RECORDING])),
        ("observations", _observation(ids[RECORDING])),
    ):
        more = {"document": short_document()} if table == "diagnoses" else {}
        yield Bulk(table, columns, diagnoses, {**times, **more})
    days = {"begin": BEGIN_NS // NANOSECONDS_PER_DAY * NANOSECONDS_PER_DAY, "step": NANOSECONDS_PER_DAY}
    yield Bulk("condition_days", _day(), YEARS_NS // NANOSECONDS_PER_DAY, days, for_each_motor=True)
    for step, share in MEASURED_SHARES.items():
        numbers = round(measurements * share / MOTORS)
        span_ns = MEASURED_SPANS_NS[step]
        whole_s = max(1, step.value) * NANOSECONDS_PER_SECOND
        columns = {
            "motor": "motor",
            "step_s": str(step.value),
            "time_ns": f"({_TIME}) / {whole_s} * {whole_s}",
            "samples": str(max(1, step.value // 10)),
            **_MEASURED,
        }
        begin = {"begin": END_NS - span_ns, "step": span_ns // numbers}
        yield Bulk("measurements", columns, numbers, begin, for_each_motor=True)


def short_document() -> str:
    """Return the document of a diagnosis with fewer findings of the quality gate."""
    said = json.loads(document(0.0123456))
    said["quality"] = said["quality"][:SHORT_FINDINGS]
    return json.dumps(said)


def insert(bulk: Bulk, dialect: str, first: int, last: int) -> tuple[str, dict[str, object]]:
    """Return the statement that inserts the rows of the numbers from first to last, and its parameters."""
    columns = ", ".join(f'"{name}"' for name in bulk.columns)
    values = ", ".join(bulk.columns.values())
    if dialect == "postgresql":
        numbers = "SELECT generate_series(CAST(:first AS BIGINT), CAST(:last AS BIGINT)) AS n"
        series = f"WITH series AS ({numbers})"
    else:
        series = (
            "WITH RECURSIVE series(n) AS (SELECT :first UNION ALL SELECT n + 1 FROM series WHERE n < :last)"
        )
    if bulk.for_each_motor:
        source = "SELECT n, name AS motor, '' AS relay FROM series CROSS JOIN motors"
    else:
        name = _padded(dialect, f"n % {MOTORS}", 4)
        source = f"SELECT n, 'MOTOR-' || {name} AS motor, 'RELAY_' || {name} AS relay FROM series"  # noqa: S608
    statement = f"INSERT INTO {bulk.table} ({columns}) {series} SELECT {values} FROM ({source}) AS numbered"  # noqa: S608
    return statement, {**bulk.parameters, "first": first, "last": last}


def _id(dialect: str, kind: int) -> str:
    scattered = _hex(dialect, f"n * {_SCATTER} % 4294967296", 8)
    return f"{scattered} || '-0000-4000-800{kind:x}-' || {_hex(dialect, 'n', 12)}"


def _hex(dialect: str, number: str, digits: int) -> str:
    if dialect == "postgresql":
        return f"lpad(to_hex({number}), {digits}, '0')"
    return f"printf('%0{digits}x', {number})"


def _padded(dialect: str, number: str, digits: int) -> str:
    if dialect == "postgresql":
        return f"lpad(CAST({number} AS TEXT), {digits}, '0')"
    return f"printf('%0{digits}d', {number})"


def _recording(id_: str, digest: str) -> Mapping[str, str]:
    return {
        "id": id_,
        "motor": "motor",
        "ied": "relay",
        "source": "'relay'",
        "name": "'HR_' || n",
        "digest": digest,
        "size_bytes": "204800",
        "remote_modified_ns": _TIME,
        "state": "'diagnosed'",
        "attempts": "0",
        "announced_ns": _TIME,
        "fetched_ns": f"{_TIME} + 1000000000",
        "recorded_ns": f"{_TIME} - 2000000000",
        "clock_offset_ns": "1200000",
        "clock_uncertainty_ns": "50000000",
        "clock_quality": "'synchronised'",
        "clock_measured_ns": f"{_TIME} - 60000000000",
        "operation": "'running'",
        "duration_s": "1.28",
        "pre_trigger_s": "0.2",
    }


def _job(id_: str, recording: str) -> Mapping[str, str]:
    return {
        "id": id_,
        "recording_id": recording,
        "method": "'hybrid'",
        "model": "'split-winding'",
        "state": "'done'",
        "motor": "motor",
        "attempts": "1",
        "not_before_ns": _TIME,
        "created_ns": _TIME,
        "started_ns": _TIME,
        "finished_ns": f"{_TIME} + 400000000",
    }


def _diagnosis(dialect: str, id_: str, job: str, recording: str) -> Mapping[str, str]:
    return {
        "id": id_,
        "job_id": job,
        "recording_id": recording,
        "motor": "motor",
        "current": "true",
        "created_ns": _TIME,
        "recorded_ns": f"{_TIME} - 2000000000",
        "verdict": f"CASE WHEN {_LEVEL} > 0.045 THEN 'fault' ELSE 'healthy' END",
        "mu_f": _LEVEL,
        "mu_f_ci95_low": f"{_LEVEL} - 0.001",
        "mu_f_ci95_high": f"{_LEVEL} + 0.001",
        "mu_f_scatter95_low": f"{_LEVEL} - 0.0002",
        "mu_f_scatter95_high": f"{_LEVEL} + 0.0002",
        "detection_limit": "0.021",
        "theta_f": "n % 3",
        "load_level": "0.6 + n % 31 * 0.01",
        "load_level_ci95_low": "0.58 + n % 31 * 0.01",
        "load_level_ci95_high": "0.62 + n % 31 * 0.01",
        "method": "'hybrid'",
        "model": "'split-winding'",
        "document": "CAST(:document AS JSON)" if dialect == "postgresql" else ":document",
    }


def _observation(recording: str) -> Mapping[str, str]:
    parts = {"voltage_re": 1.5, "voltage_im": 0.5, "current_re": 2.1, "current_im": 0.3}
    phasors = {
        f"{sequence}_{part}": f"{value} + n % 41 * 0.001"
        for sequence in ("positive", "negative", "zero")
        for part, value in parts.items()
    }
    level = ("mu_f", "mu_f_ci95_low", "mu_f_ci95_high", "change", "change_ci95_low", "change_ci95_high")
    return {
        "recording_id": recording,
        "motor": "motor",
        "time_ns": f"{_TIME} - 2000000000",
        "recorder": "relay || ' 1'",
        "sequence": "'abc'",
        "voltage_channels": "'phase'",
        "frequency_hz": "50.0 + n % 43 * 0.001",
        **phasors,
        "scatter": "1.2e-8",
        "cycles": "12",
        "load_level": "0.48",
        "state": f"CASE WHEN {_LEVEL} > 0.045 THEN 'fault' ELSE 'healthy' END",
        "kind": f"CASE WHEN {_LEVEL} > 0.045 THEN 'shorted-turns' ELSE 'none' END",
        **dict.fromkeys(level, _LEVEL),
    }


def _day() -> Mapping[str, str]:
    levels = {"mu_f_least": f"{_LEVEL} - 0.001", "mu_f_mean": _LEVEL, "mu_f_largest": f"{_LEVEL} + 0.001"}
    return {"motor": "motor", "day_ns": _TIME, "records": "5", **levels}
