"""Times of the measurements."""

from collections.abc import Iterator

import numpy as np

from benchmarks.reporting import mark, table
from benchmarks.stopwatch import best_of
from core.load.course import LoadPoint
from core.load.profile import load_profile
from core.operation import Operation
from core.recordings import Recording
from core.supply.measuring import measure_supply
from core.thermal.bounded_rises import bounded_rises
from core.thermal.course import CurrentStep
from core.thermal.two_bodies import TwoBodies
from testing.machines.disturbed_records import CHANNELS
from testing.machines.motors import REFERENCE

RATE_HZ, LENGTH_S = 10_000.0, 10.0
GOAL_S = 0.060
QUARTER_NS = 900 * 10**9


def measure() -> Iterator[str]:
    """Lines of the page."""
    t = np.arange(round(LENGTH_S * RATE_HZ)) / RATE_HZ
    phases = np.array([[0.0], [-2.0 * np.pi / 3.0], [2.0 * np.pi / 3.0]])
    waves = np.cos(2.0 * np.pi * 50.02 * t + phases)
    record = Recording(np.vstack([10.0 * waves, 310.0 * waves]), RATE_HZ, 0, CHANNELS)
    supply_s = best_of(20, lambda: measure_supply(record, REFERENCE))
    quarters = 90 * 96
    points = [LoadPoint(k * QUARTER_NS, Operation.RUNNING, 0.7, 600.0) for k in range(quarters)]
    profile_s = best_of(
        5, lambda: load_profile(points, from_ns=0, to_ns=quarters * QUARTER_NS, longest_ns=QUARTER_NS)
    )
    minutes = [CurrentStep(60.0, 0.8)] * 720
    rises_s = best_of(5, lambda: bounded_rises(minutes, TwoBodies()))
    goal = f"{1e3 * GOAL_S:.0f} ms: {mark(supply_s <= GOAL_S)}"
    yield "One core, warm, the best of several runs."
    yield ""
    yield from table(
        ["what", "time", "goal"],
        [
            ["supply of a record of 10 s at 10 kHz", f"{1e3 * supply_s:.0f} ms", goal],
            ["load profile of 90 days of quarters of an hour", f"{1e3 * profile_s:.0f} ms", ""],
            ["heat of half a day of minutes", f"{1e3 * rises_s:.0f} ms", ""],
        ],
    )
