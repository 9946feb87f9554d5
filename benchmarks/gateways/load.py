"""Processor time and memory of a gateway, and how long a change takes until the other side has it."""

import argparse
import os
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

TICKS_PER_S = os.sysconf("SC_CLK_TCK")


def argument_parser(description: str | None) -> argparse.ArgumentParser:
    """Return a parser of what every gateway's benchmark is asked."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--motors", type=int, default=500)
    parser.add_argument("--changes", type=int, default=60)
    parser.add_argument("--idle-s", type=float, default=60.0)
    return parser


class Changeable(Protocol):
    """A plant of motors that are faulty or healthy in turns."""

    @property
    def motors(self) -> Sequence[str]: ...

    def change(self, name: str, number: int) -> None: ...


class WaitForState(Protocol):
    """Returns when the other side has a motor's new state."""

    def __call__(self, motor: str, *, is_faulty: bool) -> None: ...


@dataclass(frozen=True, slots=True)
class Load:
    """idle_share, busy_share: of a core.  memory_MB: resident.  delays_s: from written to told."""

    idle_share: float
    busy_share: float
    memory_MB: float
    delays_s: tuple[float, ...]

    def __str__(self) -> str:
        """Return it in a line."""
        delays = sorted(self.delays_s)
        return (
            f"idle {self.idle_share:.2%} of a core, with a change a second {self.busy_share:.2%}, "
            f"{self.memory_MB:.0f} MB; told after {delays[len(delays) // 2]:.2f} s in the middle, "
            f"{delays[-1]:.2f} s at most, of {len(delays)} changes"
        )


def measure(
    process_id: int,
    plant: Changeable,
    wait_for: WaitForState,
    *,
    idle_s: float,
    changes: int,
) -> Load:
    """Measure a gateway: first while nothing changes, then while a motor changes each second.

    wait_for: returns when the other side has it.
    """
    idle = _share(process_id, lambda: time.sleep(idle_s))
    delays: list[float] = []

    def change() -> None:
        for number in range(changes):
            begun_s = time.monotonic()
            name = plant.motors[(number // 2 * 37) % len(plant.motors)]
            plant.change(name, number)
            wait_for(name, is_faulty=number % 2 == 0)
            delays.append(time.monotonic() - begun_s)
            time.sleep(max(0.0, 1.0 - delays[-1]))

    busy = _share(process_id, change)
    return Load(idle, busy, _memory_MB(process_id), tuple(delays))


def _share(process_id: int, work: Callable[[], None]) -> float:
    begun_s, before_s = time.monotonic(), _processor_s(process_id)
    work()
    return (_processor_s(process_id) - before_s) / (time.monotonic() - begun_s)


def _processor_s(process_id: int) -> float:
    fields = Path(f"/proc/{process_id}/stat").read_text(encoding="ascii").rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / TICKS_PER_S


def _memory_MB(process_id: int) -> float:
    status = Path(f"/proc/{process_id}/status").read_text(encoding="ascii")
    (line,) = (line for line in status.splitlines() if line.startswith("VmRSS:"))
    return int(line.split()[1]) / 1024
