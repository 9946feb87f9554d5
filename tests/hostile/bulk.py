"""The bulk of the cases: client processes beside the relay, started again when they crash."""

import asyncio
import sys
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from tests.hostile.relay import HostileRelay

LOOK_S = 0.2
STALL_S = 60.0
TELL_S = 60.0
KILOBYTES_A_MEGABYTE = 1024


@dataclass
class Outcome:
    """crashes: by exit code; journals: what the relay had answered last.  untyped: errors not of MMS."""

    crashes: Counter[int] = field(default_factory=Counter)
    journals: list[str] = field(default_factory=list)
    untyped: Counter[str] = field(default_factory=Counter)
    most_memory_MB: float = 0.0
    stalled: bool = False


async def run(
    relay: HostileRelay,
    cases: int,
    *,
    processes: int,
    directory: Path,
    tell: Callable[[str], None] = lambda _: None,
) -> Outcome:
    """Until the relay has answered so many cases more.

    directory: where the clients keep what they pull.  tell: how far it is, now and then.
    """
    outcome = Outcome()
    until = relay.cases + cases
    visitors = [
        asyncio.create_task(_keep_visiting(relay, number, directory, outcome)) for number in range(processes)
    ]
    latest = relay.cases
    since_s = told_s = time.monotonic()
    while relay.cases < until:
        await asyncio.sleep(LOOK_S)
        if relay.cases != latest:
            latest, since_s = relay.cases, time.monotonic()
        if time.monotonic() - told_s > TELL_S:
            told_s = time.monotonic()
            tell(f"{relay.cases} cases, {sum(outcome.crashes.values())} client processes ended")
        if time.monotonic() - since_s > STALL_S:
            outcome.stalled = True
            break
    for visitor in visitors:
        visitor.cancel()
    await asyncio.gather(*visitors, return_exceptions=True)
    return outcome


async def _keep_visiting(relay: HostileRelay, number: int, directory: Path, outcome: Outcome) -> None:
    turn = 0
    while True:
        turn += 1
        command = (
            sys.executable,
            "-m",
            "tests.hostile.visitor",
            str(relay.port),
            f"{relay.seed}/{number}/{turn}",
        )
        process = await asyncio.create_subprocess_exec(
            *command,
            str(directory / str(number)),
            stdout=asyncio.subprocess.PIPE,
            stderr=asyncio.subprocess.DEVNULL,
        )
        memory = asyncio.create_task(_watch_memory(process.pid, outcome))
        try:
            assert process.stdout is not None
            async for line in process.stdout:
                outcome.untyped[line.decode().strip()] += 1
            code = await process.wait()
            outcome.crashes[code] += 1
            outcome.journals.append("\n".join(relay.journal))
        finally:
            memory.cancel()
            if process.returncode is None:
                process.kill()
                await process.wait()


async def _watch_memory(process_id: int, outcome: Outcome) -> None:
    while True:
        await asyncio.sleep(1.0)
        outcome.most_memory_MB = max(outcome.most_memory_MB, resident_MB(process_id))


def resident_MB(process_id: int) -> float:
    """Memory of a process that is in use now; 0 once it ended."""
    try:
        status = Path(f"/proc/{process_id}/status").read_text()
    except OSError:
        return 0.0
    found = [line for line in status.splitlines() if line.startswith("VmRSS")]
    return int(found[0].split()[1]) / KILOBYTES_A_MEGABYTE if found else 0.0
