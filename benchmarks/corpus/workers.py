"""Each file is read in a worker process with limits of time and memory, so that none ends the run."""

import multiprocessing
import os
import resource
import signal
import time
import warnings
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future
from pathlib import Path
from typing import TypeVar

from pebble import ProcessExpired, ProcessPool

from benchmarks.corpus.outcomes import (
    Agreement,
    Comparison,
    Examined,
    Kind,
    Outcome,
    Reading,
    Served,
    Service,
    shortened,
)

TIMEOUT_S = 60.0
MEMORY_BYTES = 2 << 30
"""Beyond what a worker takes before it reads anything."""

AT_ONCE = 16
"""Files whose outcomes are waited for together."""
MOST_NOTES = 20

_COMPARED = (Reading.READ, Reading.WARNED, Reading.LENIENT)
_PAGE = resource.getpagesize()

Answer = TypeVar("Answer")


def examine_all(
    files: Sequence[tuple[Path, Kind]],
    folder: Path,
    *,
    timeout_s: float = TIMEOUT_S,
    memory_bytes: int = MEMORY_BYTES,
) -> Iterator[Examined]:
    """Read and compare the files, and yield what became of each in their order."""
    pool = ProcessPool(
        max_workers=min(len(os.sched_getaffinity(0)), max(1, len(files))),
        initializer=_prepare,
        initargs=(memory_bytes,),
        context=multiprocessing.get_context("spawn"),
    )
    try:
        for first in range(0, len(files), AT_ONCE):
            some = files[first : first + AT_ONCE]
            reading = [pool.schedule(_read, args=(path, kind.read), timeout=timeout_s) for path, kind in some]
            outcomes = [_answer(future, _crashed, timeout_s) for future in reading]
            sound = [outcome.reading in _COMPARED for outcome, _ in outcomes]
            comparing = [
                pool.schedule(kind.compare, args=(path,), timeout=timeout_s)
                if kind.compare and read
                else None
                for (path, kind), read in zip(some, sound, strict=True)
            ]
            serving = [
                pool.schedule(kind.serve, args=(path,), timeout=timeout_s) if kind.serve and read else None
                for (path, kind), read in zip(some, sound, strict=True)
            ]
            for k, (path, kind) in enumerate(some):
                outcome, seconds = outcomes[k]
                compared, serves = comparing[k], serving[k]
                comparison = Comparison(Agreement.NOT_COMPARED)
                if compared is not None:
                    comparison = _answer(compared, _not_compared, timeout_s)
                served: tuple[Served, ...] = ()
                if serves is not None:
                    served = _answer(serves, _not_served, timeout_s)
                yield Examined(
                    path=_shown(path.relative_to(folder)),
                    kind=kind.name,
                    outcome=Outcome(outcome.reading, _notes(outcome.notes)),
                    comparison=Comparison(comparison.agreement, _notes(comparison.notes)),
                    seconds=seconds,
                    served=tuple(
                        Served(one.relay, one.service, tuple(map(shortened, one.notes))) for one in served
                    ),
                )
    finally:  # also of a run that is ended by Ctrl-C
        pool.stop()  # type: ignore[no-untyped-call]  # pebble annotates the rest of its pool
        pool.join()


def _prepare(memory_bytes: int) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the run as a whole
    warnings.simplefilter("ignore")
    taken = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[0]) * _PAGE
    resource.setrlimit(resource.RLIMIT_AS, (taken + memory_bytes, resource.getrlimit(resource.RLIMIT_AS)[1]))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def _read(path: Path, read: Callable[[Path], Outcome]) -> tuple[Outcome, float]:
    begun = time.perf_counter()
    outcome = read(path)
    return outcome, time.perf_counter() - begun


def _answer(future: "Future[Answer]", failed: Callable[[str, float], Answer], timeout_s: float) -> Answer:
    """What a worker answers, or what is said of a file that it did not survive."""
    begun = time.perf_counter()
    try:
        return future.result()
    except TimeoutError:
        why = f"took longer than {timeout_s:g} s"
    except ProcessExpired as error:
        why = f"the process died (exit code {error.exitcode})"
    except MemoryError:
        why = "took more memory than allowed"
    except Exception as error:  # noqa: BLE001 - whatever a reader fails with is told of its file
        why = f"{type(error).__name__}: {error}"
    return failed(why, time.perf_counter() - begun)


def _crashed(why: str, seconds: float) -> tuple[Outcome, float]:
    return Outcome(Reading.CRASHED, (why,)), seconds


def _not_compared(why: str, _seconds: float) -> Comparison:
    return Comparison(Agreement.PEER_FAILS, (why,))


def _not_served(why: str, _seconds: float) -> tuple[Served, ...]:
    return (Served("", Service.CRASHED, (why,)),)


def _notes(notes: Sequence[str]) -> tuple[str, ...]:
    return tuple(map(shortened, notes[:MOST_NOTES]))


def _shown(path: Path) -> str:
    """A path in text that every terminal and file takes, also of a name that is not UTF-8."""
    return str(path).encode("utf-8", "backslashreplace").decode("utf-8")
