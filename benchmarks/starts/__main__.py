"""How often causes and broken bars are told rightly from starts: python -m benchmarks.starts [PART] [N]."""

import os
import sys
from collections.abc import Callable

from benchmarks.processes import worker_processes
from benchmarks.starts import alarms, cages, causes
from core.rotor.finding import RotorState

OUTCOMES = ("right", "partly", "not told apart", "missed", "wrong")


def print_causes(repeats: int) -> None:
    """Print a table of the causes that were told."""
    print(f"| motor | what is other | {' | '.join(OUTCOMES)} |\n|---|---|{'---|' * len(OUTCOMES)}")
    for row in causes.measure(repeats):
        counts = " | ".join(str(row.outcomes[one] or "") for one in OUTCOMES)
        print(f"| {row.motor} | {row.case} | {counts} |", flush=True)


def print_cages(repeats: int) -> None:
    """Print a table of the cages that were told."""
    names = " | ".join(RotorState)
    print(f"| motor | run-up | broken of 28 | {names} | rms error | within the interval |")
    print(f"|---|---|---|{'---|' * len(RotorState)}---|---|")
    for row in cages.measure(repeats):
        counts = " | ".join(str(row.states[one] or "") for one in RotorState)
        told = row.states[RotorState.WATCH] + row.states[RotorState.FAULT]
        error = "" if row.error_dB is None else f"{row.error_dB:.1f} dB"
        covered = f"{row.covered} of {told}" if row.bars and told else ""
        print(
            f"| {row.motor} | {row.run_up_s:.2f} s | {row.bars} | {counts} | {error} | {covered} |",
            flush=True,
        )


def print_alarms(lives: int) -> None:
    """Print what the alarm of changed starts says over lives."""
    with worker_processes(os.cpu_count() or 1) as pool:
        for line in alarms.lines(pool, lives=lives):
            print(line, flush=True)


PARTS: dict[str, tuple[Callable[[int], None], int]] = {
    "causes": (print_causes, 6),
    "cages": (print_cages, 20),
    "alarms": (print_alarms, 6),
}


def main() -> None:
    """Print the tables of the part that the command line names, or of all."""
    wanted = sys.argv[1:2] or list(PARTS)
    for name in wanted:
        if name not in PARTS:
            sys.exit(f"part: expected one of {', '.join(PARTS)}, found {name}")
        measure, usual = PARTS[name]
        measure(int(sys.argv[2]) if len(sys.argv) > 2 else usual)
        print()


if __name__ == "__main__":
    main()
