"""Fuzzing of the record readers with mutated CFG, DAT, CFF and CEV files (make fuzz SECONDS=60).

Each mutant is read, every other one leniently, in a child process that may not spend more than a second of
the processor's time on it and not take more than 64 MB and ten times the files' size in memory. What comes of
it must be a Recording of finite figures or a RecordingError. The files of whatever else comes are kept, and
the exit status is 1.
"""

import argparse
import contextlib
import multiprocessing
import random
import resource
import shutil
import signal
import sys
import tempfile
import time
import traceback
import warnings
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import accumulate
from multiprocessing.connection import Connection
from pathlib import Path
from types import FrameType

import numpy as np

from benchmarks.recordings.fuzz_seeds import Files, mutant, seeds
from core.recordings import Recording, RecordingError, read
from testing.memory_folder import memory_folder

SECONDS_A_FILE = 1.0
SECONDS_UNTIL_KILLED = 60.0
MEMORY_BYTES = 64 << 20
MEMORY_TIMES_FILE = 10
REPORT_EVERY = 500
MUTANTS_A_SEED = 20
TELL_EVERY_S = 60.0
_PAGE = resource.getpagesize()


class TooSlow(BaseException):
    """Raised into a reader that has used up its second."""


@dataclass
class Tally:
    """What became of the mutants, by kind of record."""

    read: Counter[str] = field(default_factory=Counter)
    refused: Counter[str] = field(default_factory=Counter)
    slowest_s: float = 0.0

    @property
    def total(self) -> int:
        return self.read.total() + self.refused.total()

    def add(self, other: "Tally") -> None:
        self.read += other.read
        self.refused += other.refused
        self.slowest_s = max(self.slowest_s, other.slowest_s)


def main() -> int:
    """Exit status 0 where every mutant was read or refused as documented, 1 where one was not."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--seconds", type=float, default=60.0, help="how long to go on")
    parser.add_argument("--mutants", type=int, default=None, help="or until so many were read")
    parser.add_argument("--seed", type=int, default=None, help="of the random numbers; shown when it ends")
    parser.add_argument("--corpus", type=Path, default=None, help="folder of further records to start from")
    parser.add_argument("--keep", type=Path, default=Path("fuzz-findings"), help="folder for what it finds")
    options = parser.parse_args()
    seed = options.seed if options.seed is not None else random.SystemRandom().randrange(1 << 32)
    tally, fault = _run(seed, options.seconds, options.mutants, options.corpus, options.keep)
    kinds = sorted({*tally.read, *tally.refused})
    for kind in kinds:
        print(f"{kind:24} {tally.read[kind]:9} read {tally.refused[kind]:9} refused")
    print(f"{tally.total} mutants, slowest {tally.slowest_s * 1e3:.0f} ms, random seed {seed}")
    if fault:
        print(f"\n{fault}\nits files are kept in {options.keep}", file=sys.stderr)
    return 1 if fault else 0


def _run(
    seed: int, seconds: float, mutants: int | None, corpus: Path | None, keep: Path
) -> tuple[Tally, str | None]:
    """Watch a child at work; what it reads lies in `folder`, where it is found should the child die of it."""
    tally = Tally()
    ours, theirs = multiprocessing.Pipe(duplex=False)
    told = time.monotonic()
    end = told + seconds
    with tempfile.TemporaryDirectory(dir=memory_folder()) as name:
        folder = Path(name)
        child = multiprocessing.get_context("spawn").Process(
            target=_child, args=(theirs, folder, seed, corpus)
        )
        child.start()
        theirs.close()
        fault: str | None = None
        try:
            while fault is None and time.monotonic() < end and (mutants is None or tally.total < mutants):
                message = ours.recv()
                if isinstance(message, str):
                    fault = message
                else:
                    tally.add(message)
                if time.monotonic() >= told + TELL_EVERY_S:
                    told = time.monotonic()
                    print(f"{tally.total} mutants, none unexpected", file=sys.stderr)
        except EOFError:
            child.join()
            fault = f"the reader's process ended with status {child.exitcode}: killed while it read"
        if child.is_alive():
            child.terminate()
            child.join()
        if fault:
            shutil.copytree(folder, keep, dirs_exist_ok=True)
    return tally, fault


def _child(report: Connection, folder: Path, seed: int, corpus: Path | None) -> None:
    warnings.simplefilter("error")
    signal.signal(signal.SIGPROF, _too_slow)
    signal.signal(signal.SIGALRM, signal.SIG_DFL)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    rng = random.Random(seed)  # noqa: S311 - material for tests
    material = seeds(corpus)
    desk = _Desk(folder)
    for start in material:  # once unlimited: compiled and cached things count for no file
        with contextlib.suppress(RecordingError):
            read(desk.lay(start.files))
    address_space = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[0]) * _PAGE
    weights = list(accumulate(start.weight for start in material))
    tally = Tally()
    with contextlib.suppress(BrokenPipeError):
        while True:
            (start,) = rng.choices(material, cum_weights=weights)
            for _ in range(MUTANTS_A_SEED):
                files, lenient = mutant(start, rng), rng.random() < 0.5
                entry = desk.lay(files)
                allowed = address_space + MEMORY_BYTES + MEMORY_TIMES_FILE * sum(map(len, files.values()))
                fault = _try(entry, start.kind, tally, allowed, lenient=lenient)
                if fault:
                    report.send(fault)
                    return
            if tally.total >= REPORT_EVERY:
                report.send(tally)
                tally = Tally()


class _Desk:
    """Files of the record that is read next; those that lie there already are not written again."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._lying: Files = {}

    def lay(self, files: Files) -> Path:
        """The path to read from."""
        for suffix, content in files.items():
            if self._lying.get(suffix) is not content:
                (self._folder / f"r{suffix}").write_bytes(content)
                self._lying[suffix] = content
        return self._folder / f"r{next(iter(files))}"


def _try(entry: Path, kind: str, tally: Tally, address_space: int, *, lenient: bool) -> str | None:
    """Read, and say what was wrong with it, if anything."""
    begun = time.process_time()
    try:
        with _limited(address_space):
            objection = _objection(read(entry, lenient=lenient), lenient=lenient)
    except RecordingError:
        tally.refused[kind] += 1
        objection = None
    except (Exception, TooSlow):  # noqa: BLE001 - this is what is looked for
        return f"{kind}, lenient={lenient}:\n{traceback.format_exc()}"
    else:
        tally.read[kind] += 1
    tally.slowest_s = max(tally.slowest_s, time.process_time() - begun)
    return f"{kind}, lenient={lenient}: {objection}" if objection else None


@contextlib.contextmanager
def _limited(address_space: int) -> Iterator[None]:
    """A second of work, and so much memory; code that never returns to Python is killed in the end."""
    hard = resource.getrlimit(resource.RLIMIT_AS)[1]
    signal.setitimer(signal.ITIMER_PROF, SECONDS_A_FILE)
    signal.setitimer(signal.ITIMER_REAL, SECONDS_UNTIL_KILLED)
    resource.setrlimit(resource.RLIMIT_AS, (address_space, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_AS, (hard, hard))
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.setitimer(signal.ITIMER_REAL, 0)


def _too_slow(_signal: int, _frame: FrameType | None) -> None:
    raise TooSlow


def _objection(recording: Recording, *, lenient: bool) -> str | None:
    """What is wrong with a recording that was accepted."""
    samples = recording.samples.shape[1]
    if np.isinf(recording.samples).any() or not 0 < recording.sample_rate_hz < np.inf:
        return "figures that are not finite"
    if recording.trigger_index is not None and not 0 <= recording.trigger_index < samples:
        return f"trigger at sample {recording.trigger_index} of {samples}"
    if recording.trigger_index is None and not recording.repairs:
        return "no trigger, and not a word of it"
    if samples > 1 and not (np.diff(recording.time_s) > 0).all():
        return "times that do not increase"
    if recording.repairs and not lenient:
        return f"repaired by the strict reader: {recording.repairs}"
    return None


if __name__ == "__main__":
    sys.exit(main())
