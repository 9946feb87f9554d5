"""Time of the examination of a record of 10 s at 10 kHz, warm."""

from concurrent.futures import Executor
from statistics import median
from time import perf_counter

from benchmarks.reporting import Section, mark
from core.diagnosis.acceptance import accept
from core.diagnosis.stator import diagnose_accepted
from core.rotor.baseband import baseband_of
from core.rotor.examining import examine_rotor
from testing.machines.motors import MEDIUM
from testing.machines.rotor_records import RotorCase

GOAL_S = 0.15
REPEATS = 21


def sections(pool: Executor, *, quick: bool) -> list[Section]:
    """One sentence."""
    del pool, quick
    record = RotorCase(MEDIUM, broken_share=1.0 / 28.0).record(10.0, 10_000.0)
    acceptance = accept(record, MEDIUM)
    if acceptance.accepted is None:
        raise RuntimeError(f"the quality gate refuses the record: {acceptance.quality}")
    diagnosis = diagnose_accepted(acceptance)
    times_s = []
    for _ in range(REPEATS):
        begun = perf_counter()
        examine_rotor(baseband_of(acceptance.accepted), acceptance.accepted, diagnosis)
        times_s.append(perf_counter() - begun)
    middle_s = median(times_s)
    line = (
        f"A record of 10 s at 10 kHz takes {1e3 * middle_s:.0f} ms ({1e3 * min(times_s):.0f} to "
        f"{1e3 * max(times_s):.0f} ms in {REPEATS} runs) beside its diagnosis; "
        f"goal {1e3 * GOAL_S:.0f} ms: {mark(middle_s <= GOAL_S)}."
    )
    return [Section("speed", "Speed", "python -m benchmarks.rotor --subject speed", (line,))]
