"""Drifts that are told of motors whose parameters stay as they are, over many records."""

from concurrent.futures import Executor
from time import perf_counter

from benchmarks.reporting import Section, mark, rate_text, spread
from benchmarks.tracking.motors import HAPPENINGS, draw
from core.tracking.drift import FOLLOWED
from core.tracking.finding import ParameterName
from core.tracking.follower import Follower

MOTORS, RECORDS = 200, 2000
QUICK_MOTORS, QUICK_RECORDS = 4, 400
FIRST_SEED = 10_000


def sections(pool: Executor, *, quick: bool) -> list[Section]:
    """One table."""
    motors, records = (QUICK_MOTORS, QUICK_RECORDS) if quick else (MOTORS, RECORDS)
    tasks = [(FIRST_SEED + seed, records) for seed in range(motors)]
    results = list(spread(drifted, tasks, "nothing happens", pool))
    false = [told for told, _ in results if told]
    names = sorted({name.words for told in false for name in told})
    per_record_us = 1e6 * sum(seconds for _, seconds in results) / (motors * records)
    lines = [
        f"{motors} motors with {records} records each, most of them hourly ({motors * records / 8766:.0f} "
        "motor-years if all were): load, weather, supply and noise vary, parameters do not.",
        "",
        f"Motors of which a drift was told: {rate_text(len(false), motors)}; goal none: {mark(not false)}."
        + (f" It was told of: {', '.join(names)}." if names else ""),
        "",
        f"Following took {per_record_us:.0f} us a record: 10,000 records, as they are folded when a motor is "
        f"judged again, take {per_record_us / 100:.1f} s.",
    ]
    command = "python -m benchmarks.tracking --subject false-alarms"
    return [Section("false-alarms", "False alarms", command, tuple(lines))]


def drifted(task: tuple[int, int]) -> tuple[tuple[ParameterName, ...], float]:
    """Return the parameters that were told to drift at any record, and how long following took [s]."""
    seed, records = task
    drawn = draw(HAPPENINGS["nothing"], seed, records, records)
    follower = Follower(drawn.motor)
    told: set[ParameterName] = set()
    begun = perf_counter()
    for record in drawn.records:
        follower.follow(record)
        told.update(one for one, drift in zip(FOLLOWED, follower.drifts, strict=True) if drift.since_ns)
    return tuple(told), perf_counter() - begun
