"""What attacks cost a running service, each on a service of its own.

    python -m benchmarks.attacks [--source DIR] [NAME ...]

Each attack has a fresh service (`mcc serve` of the demo plant, whose relays are switched off). Its processes
may map at most 8 GiB each, so that an attack cannot take the machine down. The table tells the CPU time of
all the service's processes until it is at rest again, the most memory above that at rest (PSS of all its
processes), how long GET /healthz took meanwhile, and what the attackers were answered. --source: another
checkout, whose service is attacked instead. NAME: only attacks with this text in their names. The exit code
is 1 where an attack takes more memory than LIMIT_MB, or the service's life.
"""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from benchmarks.attacks import bodies, crowds, lists, recordings
from benchmarks.attacks.attack import Attack, Statuses
from benchmarks.attacks.observation import Observer, Seen, cpu_s, memory_mb
from benchmarks.attacks.victim import settle, victim
from benchmarks.reporting import table
from testing.service.processes import is_alive

LIMIT_MB = 300.0
ATTACKS: Sequence[Attack] = (*bodies.ATTACKS, *recordings.ATTACKS, *lists.ATTACKS, *crowds.ATTACKS)
HEADER = ("attack", "CPU [s]", "memory above rest [MB]", "/healthz p95 [s]", "longest [s]", "answers")
HERE = Path(__file__).parents[2]


def main() -> int:
    """Attack, print a row for each, and return 1 where a limit is broken."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.attacks",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--source", type=Path, default=HERE, help="checkout whose service is attacked")
    parser.add_argument("names", nargs="*", metavar="NAME", help="text in the names of the attacks wanted")
    options = parser.parse_args()
    wanted = [
        attack
        for attack in ATTACKS
        if not options.names or any(name in attack.name for name in options.names)
    ]
    print("\n".join(table(HEADER, [])))
    within = [_measure(attack, options.source.absolute()) for attack in wanted]
    return 0 if all(within) else 1


def _measure(attack: Attack, source: Path) -> bool:
    """Print the attack's row; whether the service lived within its limit of memory."""
    with victim(source) as (process_id, target):
        prepared = attack.prepare(target)
        settle(process_id)
        rest_mb, begun_s = memory_mb(process_id), cpu_s(process_id)
        with Observer(process_id, target) as observer:
            answers = attack.run(prepared)
            settle(process_id)
        used_s = cpu_s(process_id) - begun_s
        alive = is_alive(process_id)
    above_mb = observer.seen.most_memory_mb - rest_mb
    print(_row(attack, used_s, above_mb, observer.seen, answers, alive=alive), flush=True)
    return alive and above_mb <= LIMIT_MB


def _row(
    attack: Attack, used_s: float, above_mb: float, seen: Seen, answers: Statuses, *, alive: bool
) -> str:
    told = ", ".join(f"{number} x {status}" for status, number in sorted(answers.items()))
    if not alive:
        told += "; the service ended"
    cells = (
        attack.name,
        f"{used_s:.1f}",
        f"{above_mb:.0f}",
        f"{seen.probe_s(95):.3f}",
        f"{seen.probe_s(100):.2f}",
        told,
    )
    return "| " + " | ".join(cells) + " |"


if __name__ == "__main__":
    sys.exit(main())
