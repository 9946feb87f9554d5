"""How much is measured."""

from dataclasses import dataclass, replace

from benchmarks.condition.end_to_end import AFTER, BEFORE


@dataclass(frozen=True, slots=True)
class Effort:
    """How much is measured.

    Healthy motors of a population and their records; motors a cell of steps, a kind of disturbance and a kind
    of growth; buses a case; motors whose cost is measured, their records and those of ten years; motors of
    each kind and case whose records go through files, with the records before and after the case; whether
    every window and path of the mill is measured.
    """

    healthy_motors: int
    healthy_records: int
    steps: int
    disturbed: int
    growing: int
    buses: int
    cost_motors: int
    cost_records: int
    long_records: int
    file_motors: int
    file_records: tuple[int, int]
    whole_mill: bool


FULL = Effort(
    healthy_motors=100, healthy_records=2_400, steps=200, disturbed=300, growing=120, buses=100,
    cost_motors=20, cost_records=2_000, long_records=87_660, file_motors=3, file_records=(BEFORE, AFTER),
    whole_mill=True,
)  # fmt: skip
QUICK = Effort(
    healthy_motors=4, healthy_records=300, steps=3, disturbed=4, growing=3, buses=2,
    cost_motors=2, cost_records=300, long_records=2_000, file_motors=1, file_records=(20, 20),
    whole_mill=False,
)  # fmt: skip


def effort_of(share: float) -> Effort:
    """Return the full size with a share of its motors and buses; with 0, that of a first look."""
    if share == 0.0:
        return QUICK
    names = ("healthy_motors", "steps", "disturbed", "growing", "buses", "cost_motors", "file_motors")
    return replace(FULL, **{name: max(1, round(share * getattr(FULL, name))) for name in names})
