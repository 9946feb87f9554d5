"""The rows of the filled database, table by table, in the order in which years would have written them.

What is asked for least often is the oldest: recordings failed, and alarms were left standing, in one bad
month long ago. A query that finds them by reading from the latest row backwards reads nearly everything.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from benchmarks.storage.documents import document
from benchmarks.storage.plant import BUSY, IDLE, QUIET, motor_name, relay_name
from core.units import NANOSECONDS_PER_SECOND
from service.plant import AveragingStep, MeteredQuantity

END_NS = 1_760_000_000 * NANOSECONDS_PER_SECOND
SPAN_NS = 5 * 365 * 86_400 * NANOSECONDS_PER_SECOND
BEGIN_NS = END_NS - SPAN_NS
"""Five years of all there is end at END_NS."""

MOTORS = 500
BUSY_SHARE = 10
"""Every tenth row is the busy motor's."""
QUIET_ROWS = 20

BAD_MONTH = 60
"""What failed, and the alarms that still stand, are of the first sixtieth of the time."""
BAD = 21
"""In that time, one row of so many failed, or is an alarm that still stands."""

WAITING = 20
"""So many of the latest recordings are announced, and so many fetched."""
REDIAGNOSED = 25
"""Every 25th recording was diagnosed twice."""

_SCATTER = 0x9E3779B97F4A7C15F39CC0605CEDC835
_MASK = (1 << 128) - 1

Row = tuple[object, ...]


@dataclass(frozen=True, slots=True)
class Table:
    """A table's name, the columns that are written, and its rows."""

    name: str
    columns: Sequence[str]
    rows: Iterator[Row]


@dataclass(frozen=True, slots=True)
class Amounts:
    """How many rows there are of what grows. A recording has four more: file, listing, job and diagnosis."""

    motors: int
    recordings: int
    recording_requests: int
    alarms: int
    link_changes: int
    deletions: int
    measurements: int

    @classmethod
    def of(cls, rows: int, motors: int = MOTORS) -> "Amounts":
        """Divide so many rows: measurements have most of them, six tenths are the recordings and theirs."""
        recordings = rows * 12 // 100
        return cls(
            motors=motors,
            recordings=recordings,
            recording_requests=rows * 5 // 100,
            alarms=rows * 2 // 100,
            link_changes=rows // 100,
            deletions=rows // 200,
            measurements=rows - 5 * recordings - rows * 9 // 100,
        )


def id_of(kind: int, number: int) -> str:
    """Return the id of a row: it looks like a random UUID, and is scattered like one."""
    digits = f"{((number * 16 + kind + 1) * _SCATTER) & _MASK:032x}"
    return f"{digits[:8]}-{digits[8:12]}-4{digits[13:16]}-8{digits[17:20]}-{digits[20:]}"


RECORDING, JOB, DIAGNOSIS, REQUEST, ALARM, CHANGE, SECOND_JOB, SECOND_DIAGNOSIS, DELETION = range(9)


def motor_of(number: int, of: int, motors: int) -> int:
    """Return which of the motors row `number` of `of` belongs to."""
    if number % BUSY_SHARE == 0:
        return BUSY
    if number % max(of // QUIET_ROWS, 2) == 1:
        return QUIET
    return IDLE + 1 + number % (motors - IDLE - 1)


def tables(amounts: Amounts) -> Iterator[Table]:
    """Yield the tables that grow, those that others refer to first."""
    yield Table("recordings", _RECORDING_COLUMNS, _recordings(amounts))
    yield Table("recording_files", ("recording_id", "name", "size_bytes", "sha256"), _files(amounts))
    yield Table(
        "remote_records", ("ied", "name", "size_bytes", "modified_ns", "recording_id"), _listed(amounts)
    )
    yield Table("jobs", _JOB_COLUMNS, _jobs(amounts))
    yield Table("diagnoses", _DIAGNOSIS_COLUMNS, _diagnoses(amounts))
    yield Table("recording_requests", _REQUEST_COLUMNS, _requests(amounts))
    yield Table("alarms", _ALARM_COLUMNS, _alarms(amounts))
    yield Table("alarm_changes", _CHANGE_COLUMNS, _alarm_changes(amounts))
    yield Table("link_changes", ("id", "ied", "changed_ns", "state", "reason"), _link_changes(amounts))
    yield Table("deletions", _DELETION_COLUMNS, _deletions(amounts))
    yield Table(
        "deleted_remote_records", ("ied", "name", "size_bytes", "modified_ns", "deletion_id"), _gone(amounts)
    )
    yield Table("link_figures", _FIGURE_COLUMNS, _link_figures(amounts.motors))
    yield Table("measurements", _MEASUREMENT_COLUMNS, _measurements(amounts))


def time_of(number: int, of: int) -> int:
    """Return when row `number` of `of` was written: they are spread evenly over the years."""
    return BEGIN_NS + number * (SPAN_NS // of)


def recording_state(number: int, of: int) -> str:
    if number < of // BAD_MONTH and number % BAD == 0:
        return "failed"
    if number >= of - WAITING:
        return "announced"
    if number >= of - 2 * WAITING:
        return "fetched"
    return "rejected" if number % 211 == 5 else "diagnosed"


_RECORDING_COLUMNS = (
    "id", "motor", "ied", "source", "name", "digest", "size_bytes", "remote_modified_ns", "state", "reason",
    "attempts", "announced_ns", "fetched_ns", "recorded_ns", "clock_offset_ns", "clock_uncertainty_ns",
    "clock_quality", "clock_measured_ns",
)  # fmt: skip


def _recordings(amounts: Amounts) -> Iterator[Row]:
    of = amounts.recordings
    for number in range(of):
        motor, time_ns, state = (
            motor_of(number, of, amounts.motors),
            time_of(number, of),
            recording_state(number, of),
        )
        stored = state != "announced"
        yield (
            id_of(RECORDING, number), motor_name(motor), relay_name(motor), "relay", f"HR_{number:08d}",
            f"{number:064x}" if stored else None, 204_800, time_ns, state,
            "the worker ended" if state == "failed" else None, 0, time_ns,
            time_ns + 1_000_000_000 if stored else None,
            time_ns - 2_000_000_000 if state == "diagnosed" else None,
            1_200_000, 50_000_000, "synchronised", time_ns - 60_000_000_000,
        )  # fmt: skip


def _files(amounts: Amounts) -> Iterator[Row]:
    of = amounts.recordings
    for number in range(of):
        if recording_state(number, of) != "announced":
            yield id_of(RECORDING, number), f"HR_{number:08d}.CFF", 204_800, f"{number:064x}"


def _listed(amounts: Amounts) -> Iterator[Row]:
    of = amounts.recordings
    for number in range(of):
        relay = relay_name(motor_of(number, of, amounts.motors))
        yield relay, f"HR_{number:08d}", 204_800, time_of(number, of), id_of(RECORDING, number)


_JOB_COLUMNS = (
    "id", "recording_id", "method", "model", "state", "attempts", "not_before_ns", "created_ns", "started_ns",
    "finished_ns", "error", "runner",
)  # fmt: skip
_JOB_STATES = {"diagnosed": "done", "failed": "failed", "rejected": "failed", "fetched": "queued"}


def _jobs(amounts: Amounts) -> Iterator[Row]:
    of = amounts.recordings
    for number in range(of):
        state = recording_state(number, of)
        if state == "announced":
            continue
        ended = state != "fetched"
        kinds = (JOB, SECOND_JOB) if _is_rediagnosed(number, state) else (JOB,)
        for kind in kinds:
            time_ns = time_of(number, of) + kind * 3_600_000_000_000
            yield (
                id_of(kind, number), id_of(RECORDING, number), "hybrid", "split-winding", _JOB_STATES[state],
                int(ended), time_ns, time_ns, time_ns if ended else None,
                time_ns + 400_000_000 if ended else None, "the worker ended" if state == "failed" else None,
                id_of(JOB, 0) if ended else None,
            )  # fmt: skip


_DIAGNOSIS_COLUMNS = (
    "id", "job_id", "recording_id", "motor", "current", "created_ns", "recorded_ns", "verdict", "mu_f",
    "mu_f_ci95_low", "mu_f_ci95_high", "theta_f", "load_level", "method", "model", "document",
)  # fmt: skip


def _diagnoses(amounts: Amounts) -> Iterator[Row]:
    of = amounts.recordings
    for number in range(of):
        state = recording_state(number, of)
        if state != "diagnosed":
            continue
        motor, time_ns = motor_name(motor_of(number, of, amounts.motors)), time_of(number, of)
        twice = _is_rediagnosed(number, state)
        kinds = ((JOB, DIAGNOSIS, False), (SECOND_JOB, SECOND_DIAGNOSIS, True))
        for job, diagnosis, current in kinds if twice else ((JOB, DIAGNOSIS, True),):
            mu_f = number % 997 / 20_000
            yield (
                id_of(diagnosis, number), id_of(job, number), id_of(RECORDING, number), motor, current,
                time_ns, time_ns - 2_000_000_000, "fault" if mu_f > 0.045 else "healthy", mu_f,
                mu_f - 0.001, mu_f + 0.001, number % 3, 0.6, "hybrid", "split-winding", document(mu_f),
            )  # fmt: skip


def _is_rediagnosed(number: int, state: str) -> bool:
    return state == "diagnosed" and number % REDIAGNOSED == 0


_REQUEST_COLUMNS = (
    "id", "motor", "ied", "origin", "state", "reason", "idempotency_key", "recording_id", "requested_ns",
    "triggered_ns", "recorded_ns", "fetched_ns", "diagnosed_ns", "failed_ns",
)  # fmt: skip


def _requests(amounts: Amounts) -> Iterator[Row]:
    of = amounts.recording_requests
    for number in range(of):
        motor, time_ns = motor_of(number, of, amounts.motors), time_of(number, of)
        failed, waits = number % 997 == 3, number >= of - WAITING
        state = "requested" if waits else "failed" if failed else "diagnosed"
        at = None if waits else time_ns
        yield (
            id_of(REQUEST, number), motor_name(motor), relay_name(motor), "schedule", state,
            "no record came" if failed else None, f"schedule {time_ns}",
            id_of(RECORDING, number) if state == "diagnosed" else None, time_ns, at, at, at,
            None if failed else at, at if failed else None,
        )  # fmt: skip


_ALARM_COLUMNS = (
    "id", "ied", "kind", "subject", "reason", "raised_ns", "cleared_ns", "priority", "state",
    "urgency", "raises", "changed_ns", "changed_by",
)  # fmt: skip


def _alarms(amounts: Amounts) -> Iterator[Row]:
    of = amounts.alarms
    for number in range(of):
        time_ns = time_of(number, of)
        stands = number < of // BAD_MONTH and number % BAD == 0
        relay = relay_name(number % amounts.motors)
        cleared_ns = None if stands else time_ns + 3_600_000_000_000
        yield (
            id_of(ALARM, number), relay, "file-refused", f"HR_{number:08d}.CFG", "refused by the relay",
            time_ns, cleared_ns, "low", "unacknowledged" if stands else "normal", 30 if stands else 0, 1,
            cleared_ns or time_ns, "statorwatch",
        )  # fmt: skip


_CHANGE_COLUMNS = ("alarm", "changed_ns", "event", "before", "after", "by", "routed_ns")


def _alarm_changes(amounts: Amounts) -> Iterator[Row]:
    of = amounts.alarms
    for number in range(of):
        time_ns = time_of(number, of)
        yield (
            id_of(ALARM, number), time_ns, "raised", "normal", "unacknowledged", "statorwatch", time_ns
        )  # fmt: skip


def _link_changes(amounts: Amounts) -> Iterator[Row]:
    of = amounts.link_changes
    for number in range(of):
        state, reason = ("down", "the relay does not answer") if number % 2 else ("up", None)
        yield id_of(CHANGE, number), relay_name(number % amounts.motors), time_of(number, of), state, reason


_DELETION_COLUMNS = (
    "id", "motor", "ied", "source", "name", "digest", "waveform", "size_bytes", "state", "verdict",
    "announced_ns", "recorded_ns", "deleted_ns", "deleted_by", "reason",
)  # fmt: skip


def _deletions(amounts: Amounts) -> Iterator[Row]:
    of = amounts.deletions
    for number in range(of):
        motor, time_ns = motor_of(number, of, amounts.motors), time_of(number, of)
        yield (
            id_of(DELETION, number), motor_name(motor), relay_name(motor), "relay", f"OLD_{number:08d}",
            f"{number:064x}", f"{number:064x}", 204_800, "diagnosed", "healthy", time_ns - SPAN_NS,
            time_ns - SPAN_NS, time_ns, "retention", "older than the rule keeps",
        )  # fmt: skip


def _gone(amounts: Amounts) -> Iterator[Row]:
    of = amounts.deletions
    for number in range(of):
        relay = relay_name(motor_of(number, of, amounts.motors))
        yield relay, f"OLD_{number:08d}", 204_800, time_of(number, of) - SPAN_NS, id_of(DELETION, number)


_FIGURE_COLUMNS = (
    "ied", "round_trip_s", "connections", "received_bytes", "reports", "report_gaps", "day", "day_bytes",
)  # fmt: skip


def _link_figures(relays: int) -> Iterator[Row]:
    for number in range(relays):
        yield relay_name(number), 0.012, 3, 1_000_000_000, 20_000, 2, 20_370, 300_000


_MEASURED = tuple(quantity.value for quantity in MeteredQuantity if not quantity.is_statistic)
_MEASUREMENT_COLUMNS = ("motor", "step_s", "time_ns", "samples", *_MEASURED)


def _measurements(amounts: Amounts) -> Iterator[Row]:
    of = amounts.measurements
    sampled, *means = (step.value for step in AveragingStep)
    steps = (sampled,) * 7 + (means[0],) * 2 + (means[1],)
    values = [tuple(100.0 + row + column / 7 for column in range(len(_MEASURED))) for row in range(64)]
    for number in range(of):
        motor = motor_name(motor_of(number, of, amounts.motors))
        yield motor, steps[number // BUSY_SHARE % len(steps)], time_of(number, of), 1, *values[number % 64]
