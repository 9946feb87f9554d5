"""The records that `mcc follow` is given: found, read and observed by several processes, and put in order."""

import os
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

from core.condition.copies import SAME_TIME_NS, Outline, is_copy, outline_of
from core.condition.measuring.observing import observation_of
from core.condition.observation import Observation
from core.diagnosis.acceptance import accept
from core.findings.beside_stator import supply_of
from core.findings.examining import examine
from core.machines.motor_tables import layout_of
from core.machines.parameters import Motor
from core.operation import Operation
from core.recordings import RecordingError, read
from core.recordings.errors import RecordingTooLongError, UnknownTimeError
from core.recordings.fidelity import Fidelity, fidelity_of
from core.recordings.reading import SUFFIXES, is_recording_name, mended_by
from core.rotor.finding import RotorFinding
from core.supply.figures import SupplyFigures

MOST_VALUES = 8_000_000
"""A longer recording is refused, as the service refuses it."""

LEAST_OF_ROTOR_S = 1.0
"""A shorter record tells nothing of a rotor at any usual slip, and is not diagnosed for it."""

FEW = 12
"""So many records are read sooner than a second process has started."""

AT_ONCE = 4
"""Records that a process gets at a time."""

GLOB_CHARACTERS = frozenset("*?[")


@dataclass(frozen=True, slots=True)
class Seen:
    """One record and what it tells.

    path: as it was found. time_ns: of its trigger, UTC; None where it cannot be read. observation: None where
    the record was refused. refusal: why. operation: what the motor does in it, where that can be told.
    outline: what tells copies of its event. rotor: of a record that is long enough; None of others. supply:
    None where it shows nothing of it.
    """

    path: Path
    time_ns: int | None
    observation: Observation | None
    refusal: str = ""
    operation: Operation | None = None
    outline: Outline | None = None
    rotor: RotorFinding | None = None
    supply: SupplyFigures | None = None

    def refused(self, reason: str) -> "Seen":
        """Return the record as one that is not used, with the reason."""
        return Seen(self.path, self.time_ns, None, reason, self.operation)


def find_records(given: Sequence[str]) -> list[Path]:
    """Return the files that are meant by names of files and folders, and by patterns such as mill/*.CFG.

    A folder stands for all recordings in it and below. A file is taken once. A name that leads nowhere is
    kept, so that reading it says what is wrong.
    """
    found: dict[Path, Path] = {}
    for name in given:
        for path in _meant(name):
            found.setdefault(path.resolve(), path)
    return list(found.values())


def _meant(name: str) -> Iterator[Path]:
    path = Path(name)
    if path.is_dir():
        yield from _inside(path)
    elif path.exists() or not GLOB_CHARACTERS.intersection(name):
        yield path
    else:
        matching = sorted(Path(path.anchor).glob(str(path.relative_to(path.anchor))))
        for one in matching:
            yield from _meant(str(one))
        if not matching:
            yield path


def _inside(folder: Path) -> Iterator[Path]:
    """Yield the recordings of a folder, each event once: a relay may keep it as COMTRADE and as CEV."""
    known = [path for path in folder.rglob("*") if is_recording_name(path.name) and path.is_file()]
    known.sort(key=lambda path: (str(path.with_suffix("")), SUFFIXES.index(path.suffix.casefold())))
    before = None
    for path in known:
        event = path.with_suffix("")
        if event != before:
            yield path
        before = event


def observe_all(
    paths: Sequence[Path], motor: Motor, *, lenient: bool, advance: Callable[[int, int], None]
) -> list[Seen]:
    """Read and observe the records, and return them in the order of time; those without a time come last.

    Of copies of one record the finest is used, else the first. advance: is told how many of all are done.
    """
    look = partial(observe_record, motor=motor, lenient=lenient)
    seen: list[Seen] = []
    for one in _each(look, paths):
        seen.append(one)
        advance(len(seen), len(paths))
    seen.sort(key=lambda one: (one.time_ns is None, one.time_ns or 0, str(one.path)))
    return list(_without_copies(seen))


def _each(look: Callable[[Path], Seen], paths: Sequence[Path]) -> Iterator[Seen]:
    processes = min(len(os.sched_getaffinity(0)), len(paths) // AT_ONCE)
    if processes < 2 or len(paths) < FEW:
        yield from map(look, paths)
        return
    done = 0
    try:
        with ProcessPoolExecutor(processes) as pool:
            for one in pool.map(look, paths, chunksize=AT_ONCE):
                yield one
                done += 1
    except BrokenProcessPool:
        # A process was killed from outside, for want of memory for example: go on more slowly without it.
        yield from map(look, paths[done:])


def observe_record(path: Path, motor: Motor, *, lenient: bool) -> Seen:
    """Read one record and observe the motor in it; whatever is wrong with it is told in the answer."""
    if not path.exists():
        is_pattern = GLOB_CHARACTERS.intersection(str(path))
        return Seen(path, None, None, "no file matches" if is_pattern else "there is no such file or folder")
    try:
        recording = read(path, lenient=lenient, most_values=MOST_VALUES, layout=layout_of(motor))
    except RecordingTooLongError as error:
        return Seen(path, None, None, str(error))
    except RecordingError as error:
        mended = None if lenient else mended_by(path)
        advice = "" if mended is None else "; --lenient reads it all the same"
        return Seen(path, None, None, f"{error}{advice}")
    except OSError as error:
        return Seen(path, None, None, str(error))
    try:
        time_ns = recording.trigger_time_ns
    except UnknownTimeError as error:
        return Seen(path, None, None, f"{error}: it has no place among the others")
    unused = Seen(path, time_ns, None)
    try:
        acceptance = accept(recording, motor)
    except RecordingError as error:
        return unused.refused(str(error))
    unused = replace(unused, operation=acceptance.operation)
    if acceptance.accepted is None:
        failed = (f"{one.name}: {one.message}" for one in acceptance.quality if not one.passed)
        return unused.refused("; ".join(failed))
    observation = observation_of(recording, acceptance.accepted)
    if observation is None:
        return unused.refused("it gives no finite negative-sequence voltage and current")
    outline = outline_of(recording, motor, fidelity_of(path))
    seen = Seen(path, time_ns, observation, outline=outline)
    if recording.duration_s >= LEAST_OF_ROTOR_S:
        examined = examine(recording, motor)  # the rotor takes the running point of a diagnosis
        return replace(seen, rotor=examined.rotor, supply=examined.supply)
    return replace(seen, supply=supply_of(recording, motor, acceptance)[0])


def _without_copies(seen: Sequence[Seen]) -> Iterator[Seen]:
    """Yield the records, the coarser copies of an event as refused. seen: in the order of time."""
    kept: list[Seen] = []
    copies: dict[Path, Path] = {}
    for one in seen:
        if one.observation is None:
            continue
        same = next((place for place in _near(kept, one) if _is_copy(one, kept[place])), None)
        if same is None:
            kept.append(one)
            continue
        best, worse = sorted((kept[same], one), key=_coarseness)
        kept[same] = best
        copies[worse.path] = best.path
    for one in seen:
        copied = copies.get(one.path)
        while copied in copies:
            copied = copies[copied]
        yield one if copied is None else one.refused(f"a copy of {copied}: the same event")


def _near(kept: Sequence[Seen], one: Seen) -> Iterator[int]:
    """Yield the places of records that may be of the same time; they are in the order of time."""
    for place in reversed(range(len(kept))):
        if (one.time_ns or 0) - (kept[place].time_ns or 0) > SAME_TIME_NS:
            return
        yield place


def _is_copy(one: Seen, other: Seen) -> bool:
    return one.outline is not None and other.outline is not None and is_copy(one.outline, other.outline)


def _coarseness(one: Seen) -> int:
    return Fidelity.TEXT if one.outline is None else one.outline.fidelity
