"""A record as PyPI's comtrade reads it, compared with the project's reading of it."""

import warnings
from pathlib import Path

import comtrade as peer
import numpy as np
from numpy.typing import NDArray

from benchmarks.corpus.outcomes import Agreement, Comparison
from core.recordings import Recording
from core.recordings.channel_roles import channel_roles

TIME_TOLERANCE_S = 2e-6
"""Time stamps are written in microseconds; ours goes by the rate where both are told."""
VALUE_TOLERANCE = 1e-9
SINGLE_PRECISION = 1e-6


def compared(ours: Recording, path: Path) -> Comparison:
    """Compare a recording with the peer's reading of its file."""
    theirs = _their_reading(path)
    if isinstance(theirs, str):
        return Comparison(Agreement.PEER_FAILS, (theirs,))
    values = np.array(theirs.analog, dtype=np.float64)
    if values.shape != ours.samples.shape:
        told = ours.repairs or any("read as counts" in warning for warning in ours.warnings)
        return Comparison(
            Agreement.EXPLAINED if told else Agreement.DIFFERS,
            (f"channels and samples {ours.samples.shape}, there {values.shape}",),
        )
    explained, other = _of_values(ours, values, theirs)
    explained += _of_times(ours, theirs)
    if not _same_states(ours, np.array(theirs.status)):
        other.append("other states")
    if other:
        return Comparison(Agreement.DIFFERS, (*other, *explained))
    return Comparison(Agreement.EXPLAINED if explained else Agreement.AGREES, tuple(explained))


def _their_reading(path: Path) -> "peer.Comtrade | str":
    try:
        return _loaded(path, "utf-8")
    except UnicodeDecodeError:  # it takes any text in Latin-1, and misspells names
        return _loaded(path, "latin-1")


def _loaded(path: Path, encoding: str) -> "peer.Comtrade | str":
    record = peer.Comtrade(ignore_warnings=True, use_numpy_arrays=True, use_double_precision=True)
    data = [
        file
        for file in path.parent.iterdir()
        if file.stem.casefold() == path.stem.casefold()
        and file.suffix.casefold() == ".dat"
        and path.suffix.casefold() == ".cfg"
    ]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            record.load(str(path), *map(str, data[:1]), encoding=encoding)
        except (UnicodeDecodeError, MemoryError):
            raise
        except Exception as error:  # noqa: BLE001 - whatever the package fails with is its answer
            return f"{type(error).__name__}: {error}"
    return record


def _of_values(
    ours: Recording, values: NDArray[np.float64], theirs: "peer.Comtrade"
) -> tuple[list[str], list[str]]:
    """What is explained, and what is not: theirs brought to primary SI values by the file's own ratios."""
    channels = theirs.cfg.analog_channels
    roles = channel_roles([(c.name, c.ph, c.uu) for c in channels])
    ratios = [c.primary / c.secondary if c.pors.upper() == "S" and c.secondary else 1.0 for c in channels]
    scale = np.array([role.scale * ratio for role, ratio in zip(roles, ratios, strict=True)])[:, None]
    with np.errstate(over="ignore", invalid="ignore"):
        expected = values * scale
        skewed = np.array([c.skew != 0 for c in channels])[:, None]
        missing = np.isnan(ours.samples) & ~np.isnan(expected)
        precision = SINGLE_PRECISION if theirs.ft.upper() == "FLOAT32" else VALUE_TOLERANCE
        largest = np.nanmax(np.abs(expected), axis=1, keepdims=True, initial=0)
        wrong = (np.abs(ours.samples - expected) > precision * largest + 1e-12) & ~skewed & ~missing
    explained, other = [], []
    if (scale != 1).any():
        explained.append("values in primary SI units")
    if skewed.any():
        explained.append("skew removed")
    if missing.any():
        explained.append(f"{int(missing.sum())} missing values, there numbers")
    if wrong.any():
        other.append(f"other values in {int(wrong.any(axis=1).sum())} channels")
    return explained, other


def _of_times(ours: Recording, theirs: "peer.Comtrade") -> list[str]:
    said = []
    times = np.asarray(theirs.time, dtype=np.float64)
    late = float(np.max(np.abs(ours.time_s - (times - times[0])), initial=0.0)) if times.size else 0.0
    if late > TIME_TOLERANCE_S:
        said.append(f"times of samples differ by up to {late:.3g} s")
    if ours.start_time_ns is None:
        said.append(f"time unknown, there {theirs.start_timestamp}")
    elif ours.start_time_ns // 1000 != int(np.datetime64(theirs.start_timestamp, "us").astype(np.int64)):
        said.append(f"starts {np.datetime64(ours.start_time_ns, 'ns')}, there {theirs.start_timestamp}")
    return said


def _same_states(ours: Recording, states: NDArray[np.int64]) -> bool:
    if ours.digitals is None:
        return states.size == 0
    return np.array_equal(ours.digitals.unpacked().T, states != 0)
