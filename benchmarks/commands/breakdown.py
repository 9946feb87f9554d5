"""Where the time of `mcc diagnose` goes: the interpreter, imports, machine code, the diagnosis."""

import re
import subprocess
import sys
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from benchmarks.commands.timing import Timing, timed_runs

IMPORT_LINE = re.compile(r"import time: +(?P<self_us>\d+) \| +\d+ \| *(?P<module>\S+)")
BY_PACKAGES_OF = {"core", "service", "numba", "numpy", "scipy"}
"""Large packages, of which the parts are told apart."""

STAGES = """
import sys
from time import perf_counter

import numba.core.caching as caching
import service.cli.recordings.diagnose
from service.cli import main

loading, depth = 0.0, 0
load = caching.Cache.load_overload

def timed_load(*arguments):
    global loading, depth
    depth, begun = depth + 1, perf_counter()
    try:
        return load(*arguments)
    finally:
        depth -= 1
        loading += 0.0 if depth else perf_counter() - begun

caching.Cache.load_overload = timed_load
begun = perf_counter()
main(["diagnose", sys.argv[1]])
first, of_first = perf_counter() - begun, loading
begun = perf_counter()
main(["diagnose", sys.argv[1]])
print(of_first, first - of_first, perf_counter() - begun, file=sys.stderr)
"""


@dataclass(frozen=True, slots=True)
class Imports:
    """Time in the body of every imported module [s], by package."""

    by_package: Counter[str]
    modules: int
    total_s: float

    def dearest(self, most: int) -> list[tuple[str, float]]:
        return [(package, us * 1e-6) for package, us in self.by_package.most_common(most)]


@dataclass(frozen=True, slots=True)
class Stages:
    """A first and a second diagnosis in one process, with everything imported before."""

    loading: Timing
    rest_of_first: Timing
    again: Timing


def imports(arguments: Sequence[str]) -> Imports:
    """What `mcc` imports for these arguments, as the interpreter itself counts it."""
    told = _stderr_of([sys.executable, "-X", "importtime", "-m", "service.cli", *arguments])
    found = [(match["module"], int(match["self_us"])) for match in IMPORT_LINE.finditer(told)]
    by_package: Counter[str] = Counter()
    for module, us in found:
        parts = module.split(".")
        by_package[".".join(parts[: 2 if parts[0] in BY_PACKAGES_OF else 1])] += us
    return Imports(by_package, len(found), sum(us for _, us in found) * 1e-6)


def interpreter_start(runs: int) -> Timing:
    """An interpreter that does nothing."""
    return timed_runs([sys.executable, "-c", "pass"], runs)


def stages_of_diagnosis(record: str, runs: int) -> Stages:
    """Loading of machine code, the rest of a first diagnosis, and a second one."""
    command = [sys.executable, "-c", STAGES, record]
    columns = zip(*(map(float, _stderr_of(command).split()) for _ in range(runs)), strict=True)
    return Stages(*(Timing(tuple(column)) for column in columns))


def _stderr_of(command: Sequence[str]) -> str:
    return subprocess.run(command, check=True, capture_output=True, text=True).stderr
