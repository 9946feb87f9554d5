"""Wall times of processes, from start to end."""

import subprocess
from collections.abc import Sequence
from dataclasses import dataclass
from statistics import median
from time import perf_counter


@dataclass(frozen=True, slots=True)
class Timing:
    """Wall times of several runs [s]."""

    seconds: tuple[float, ...]

    @property
    def median_s(self) -> float:
        return median(self.seconds)

    def __str__(self) -> str:
        return f"median {self.median_s:.3f} s, shortest {min(self.seconds):.3f} s"


def timed_runs(command: Sequence[str], runs: int) -> Timing:
    """Run the command once more than counted: the first run finds cold caches."""
    return Timing(tuple(_wall_s(command) for _ in range(runs + 1))[1:])


def _wall_s(command: Sequence[str]) -> float:
    begun = perf_counter()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return perf_counter() - begun
