"""Runs all cases and says what was found; ends with 1 where something is not as it should be."""

import argparse
import asyncio
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from tests.hostile import bulk, served
from tests.hostile.dialogue import Dialogue, overheard
from tests.hostile.relay import HostileRelay
from tests.hostile.surroundings import Snapshot

SERVED_CASES = 500
LEAST_CASES = 10 * SERVED_CASES
"""With fewer the service meets too few for every hostile relay to be set aside."""

SERVED_LIMIT_S = 300.0
MOST_MEMORY_MB = 400.0
"""Of a client or gateway process; one that is good needs 60 to 120."""

FINDINGS = Path("hostile-findings")


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m tests.hostile", description=__doc__)
    parser.add_argument("--cases", type=int, default=100_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument(
        "--processes", type=int, default=6, help="client processes; most of their time is waiting"
    )
    parser.add_argument(
        "--clients-only", action="store_true", help="leave out the part through a service, which takes 5 min"
    )
    arguments = parser.parse_args()
    served_cases = 0 if arguments.clients_only else SERVED_CASES
    if served_cases and arguments.cases < LEAST_CASES:
        parser.error(f"--cases: expected {LEAST_CASES} at least, found {arguments.cases}")
    dialogue = overheard()
    faults = [
        *_in_bulk(dialogue, arguments.cases - served_cases, arguments.seed, arguments.processes),
        *(_through_the_service(dialogue, served_cases, arguments.seed) if served_cases else ()),
    ]
    for fault in faults:
        _say(f"FAULT {fault}")
    _say(f"{len(faults)} faults")
    return 1 if faults else 0


def _in_bulk(dialogue: Dialogue, cases: int, seed: int, processes: int) -> Iterator[str]:
    async def campaign(directory: Path) -> tuple[HostileRelay, bulk.Outcome]:
        relay = HostileRelay(dialogue, seed)
        await relay.start()
        outcome = await bulk.run(
            relay, cases, processes=processes, directory=directory / "clients", tell=_say
        )
        await relay.stop()
        return relay, outcome

    begun_s = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="statorwatch-hostile-") as name:
        directory = Path(name)
        for canary in served.CANARIES:
            (directory / canary).write_text(canary)
        before = Snapshot.of(directory, without=directory / "clients")
        relay, outcome = asyncio.run(campaign(directory))
        yield from before.changed(Snapshot.of(directory, without=directory / "clients"))
    kinds: Counter[str] = Counter()
    for kind, number in relay.kinds.items():
        kinds[
            kind.split()[0] if kind.split()[0] in ("message", "frame", "report", "handshake") else kind
        ] += number
    _say(
        f"bulk: {relay.cases} cases of seed {seed} in {time.monotonic() - begun_s:.0f} s, {processes} clients"
    )
    _say("  " + ", ".join(f"{number} {kind}" for kind, number in kinds.most_common()))
    _say(f"  client processes ended: {dict(outcome.crashes) or 'none'}")
    _say(f"  most memory of one: {outcome.most_memory_MB:.0f} MB")
    if outcome.journals:
        FINDINGS.mkdir(exist_ok=True)
        (FINDINGS / f"seed-{seed}.txt").write_text("\n\n".join(outcome.journals))
        _say(f"  what the relay had answered before: {FINDINGS}")
    if outcome.stalled:
        yield "the clients stopped asking"
    if outcome.most_memory_MB > MOST_MEMORY_MB:
        yield f"a client took {outcome.most_memory_MB:.0f} MB"
    for trace, number in outcome.untyped.items():
        yield f"{number} times an error that is not one of MMS: {trace[-600:]}"


def _through_the_service(dialogue: Dialogue, cases: int, seed: int) -> Iterator[str]:
    begun_s = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="statorwatch-hostile-") as name:
        outcome = served.run(dialogue, seed, Path(name), cases=cases, limit_s=SERVED_LIMIT_S)
    _say(f"service: {outcome.cases} cases by {len(served.BAD)} relays in {time.monotonic() - begun_s:.0f} s")
    _say(f"  API: {outcome.probes} answers, the slowest after {outcome.slowest_probe_s:.2f} s")
    _say(f"  gateway processes: {outcome.gateways}, most memory of one {outcome.most_memory_MB:.0f} MB")
    _say(f"  set aside: {outcome.quarantines}")
    _say(f"  recordings of the good relays fetched: {outcome.good_recordings}")
    yield from outcome.faults(MOST_MEMORY_MB)


def _say(line: str) -> None:
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


if __name__ == "__main__":
    sys.exit(main())
