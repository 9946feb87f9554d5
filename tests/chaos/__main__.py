"""python -m tests.chaos [--seed N] [--minutes M] [--recordings R] [--relays N] [--faults F]

[--database sqlite|postgresql] [--json FILE]
"""

import argparse
import signal
import sys
import tempfile
import time
from pathlib import Path
from subprocess import SubprocessError

from rich.console import Console

from service.client.rest_client import ServiceError
from tests.chaos.disk import enter_own_mounts
from tests.chaos.order import Order
from tests.chaos.result import Result
from tests.chaos.run import run

BREACHES_PRINTED = 20


def main() -> int:
    """0: nothing was lost, doubled or falsified; 1: something was, or the run could not be made."""
    arguments = _arguments()
    enter_own_mounts()
    signal.signal(signal.SIGTERM, lambda _number, _frame: sys.exit(1))
    order = Order(
        arguments.seed,
        arguments.minutes,
        arguments.recordings,
        arguments.relays,
        arguments.faults,
        arguments.database,
    )
    console = Console(stderr=True, highlight=False, soft_wrap=True)
    began_s = time.monotonic()
    console.print(order.command)
    directory = Path(arguments.data or tempfile.mkdtemp(prefix="chaos-"))
    directory.mkdir(parents=True, exist_ok=True)
    with console.status("starting") as status:

        def tell(line: str) -> None:
            status.update(line)
            if not console.is_terminal:
                console.print(f"{time.monotonic() - began_s:6.0f} s  {line}")

        try:
            result = run(order, directory, tell)
        except (RuntimeError, OSError, SubprocessError, ServiceError) as error:
            console.print(f"the run could not be made: {error}; logs: {directory}")
            return 1
    if arguments.json is not None:
        result.write(arguments.json)
    _print(console, result, directory)
    return 0 if result.passed else 1


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m tests.chaos", description=__doc__)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--minutes", type=float, default=2.0)
    parser.add_argument("--recordings", type=int, default=300)
    parser.add_argument("--relays", type=int, default=12)
    parser.add_argument("--faults", type=float, default=1.0, help="times the usual number of faults a minute")
    parser.add_argument("--database", choices=["sqlite", "postgresql"], default="sqlite")
    parser.add_argument("--json", type=Path)
    parser.add_argument("--data", type=Path, help="an empty directory to keep logs in")
    return parser.parse_args()


def _print(console: Console, result: Result, directory: Path) -> None:
    console.print(f"faults: {dict(result.faults)}")
    console.print(
        f"{result.records_made} records made ({result.half_records} more by half), "
        f"{result.records_stored} stored; "
        f"lost {result.lost}, doubled {result.doubled}, falsified {result.falsified}; "
        f"recording requests {dict(result.event_reports)}, failed because {dict(result.failed_because)}; "
        f"triggers repeated {result.triggers_repeated}; {result.pulled_bytes / 1e6:.1f} MB from the relays; "
        f"made to stored {dict(result.made_to_stored_s)} s; settled after {result.settled_after_s} s; "
        f"files and threads {dict(result.files_and_threads)}; integrity {result.integrity}; "
        f"{result.lasted_s:.0f} s"
    )
    for number, breach in enumerate(result.breaches[:BREACHES_PRINTED]):
        console.print(f"BREACH {breach}")
        for line in result.around[number]:
            console.print(f"         {line}")
    if result.breaches:
        console.print(f"{len(result.breaches)} breaches; again: {result.command}; logs: {directory}")
    else:
        console.print("nothing lost, nothing doubled, every hash right")


if __name__ == "__main__":
    sys.exit(main())
