"""How long a person waits for the commands, each run in a process of its own.

    python -m benchmarks.commands [--runs N]

`mcc --help` and `mcc diagnose` of a 0.5 s record are timed from the start of the process to its end, with
the machine code of the models cached by a run before. The median of the runs is held against the limit of the
command; the exit code is 1 where one is broken. The limits are those of a machine on which the interpreter
starts in 20 ms; where it takes longer they are longer in proportion, which is printed. The breakdown says
where the time of `mcc diagnose` goes.
"""

import argparse
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from benchmarks.commands.breakdown import imports, interpreter_start, stages_of_diagnosis
from benchmarks.commands.record import write_record
from benchmarks.commands.timing import Timing, timed_runs

MCC = Path(sys.executable).with_name("mcc")
RUNS = 9
USUAL_START_S = 0.02
"""Start of the interpreter on the machine for which the limits are."""


@dataclass(frozen=True, slots=True)
class Command:
    """A command and the longest time a person may wait for it on the usual machine [s]."""

    name: str
    arguments: Sequence[str]
    limit_s: float

    def run(self, runs: int) -> Timing:
        """Time it; the first run, which fills the caches, is not counted."""
        return timed_runs([str(MCC), *self.arguments], runs)


def main() -> int:
    """Measure, print, and return 1 where a limit is broken."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.commands", description=__doc__)
    parser.add_argument("--runs", type=int, default=RUNS, help="runs of each command")
    runs = parser.parse_args().runs
    with tempfile.TemporaryDirectory(prefix="statorwatch-bench-") as directory:
        record = str(write_record(Path(directory)))
        commands = (
            Command("mcc --help", ("--help",), 0.4),
            Command("mcc diagnose, a record of 0.5 s", ("diagnose", record), 1.0),
        )
        start = interpreter_start(runs)
        slowness = max(1.0, start.median_s / USUAL_START_S)
        print(f"start of the interpreter: {start}; limits are {slowness:.1f} times the usual ones")
        within = [_judge(command, command.run(runs), slowness * command.limit_s) for command in commands]
        _print_breakdown(record, runs)
    return 0 if all(within) else 1


def _judge(command: Command, timing: Timing, limit_s: float) -> bool:
    """Print one command's times; whether its median keeps the limit, which is this machine's."""
    within = timing.median_s <= limit_s
    print(
        f"{command.name}: {timing}, limit {limit_s:.2f} s: {'kept' if within else 'BROKEN'}",
        flush=True,
    )
    return within


def _print_breakdown(record: str, runs: int) -> None:
    """Where the time of one `mcc diagnose` goes."""
    imported = imports(("diagnose", record))
    stages = stages_of_diagnosis(record, runs)
    print("mcc diagnose, part by part:")
    print(f"  imports: {imported.total_s:.3f} s of {imported.modules} modules, as -X importtime counts them")
    for package, seconds in imported.dearest(8):
        print(f"    {package}: {seconds:.3f} s")
    print(f"  loading machine code: {stages.loading}")
    print(f"  the rest of a first diagnosis, with reading and printing: {stages.rest_of_first}")
    print(f"  reading, diagnosing and printing again in the same process: {stages.again}")


if __name__ == "__main__":
    sys.exit(main())
