"""Every COMTRADE file of a folder, read by ours and by PyPI's comtrade.

    python -m benchmarks.recordings.comtrade_corpus DIR

One line a file: where both read it, whether values, times and states agree; else what each says.
"""

import argparse
import sys
import warnings
from pathlib import Path

import comtrade as peer
import numpy as np
from numpy.typing import NDArray

from core.recordings import Recording, RecordingError, read
from core.recordings.channel_roles import channel_roles

TIME_TOLERANCE_S = 2e-6
"""Time stamps are written in microseconds; ours goes by the rate where both are told."""


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("folder", type=Path)
    folder: Path = parser.parse_args().folder
    for path in sorted(folder.rglob("*")):
        if path.suffix.casefold() in (".cfg", ".cff"):
            print(f"{path.relative_to(folder)}: {_verdict(path)}")
    return 0


def _verdict(path: Path) -> str:
    theirs = _their_reading(path)
    try:
        ours = read(path)
    except RecordingError as refusal:
        try:
            mended = read(path, lenient=True)
        except RecordingError:
            how = "refused"
        else:
            how = f"read leniently ({_compared(mended, theirs)})"
        return f"{how}: {refusal}" + (f"; comtrade: {theirs}" if isinstance(theirs, str) else "")
    return _compared(ours, theirs)


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
        if file.stem == path.stem and file.suffix.casefold() == ".dat" and path.suffix.casefold() == ".cfg"
    ]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            record.load(str(path), *map(str, data), encoding=encoding)
        except UnicodeDecodeError:
            raise
        except Exception as error:  # noqa: BLE001 - whatever the package fails with is its answer
            return f"{type(error).__name__}: {error}"
    return record


def _compared(ours: Recording, theirs: "peer.Comtrade | str") -> str:
    if isinstance(theirs, str):
        return f"comtrade fails, {theirs}"
    values = np.array(theirs.analog, dtype=np.float64)
    if values.shape != ours.samples.shape:
        return f"shape {ours.samples.shape}, comtrade {values.shape}"
    differences = [
        *_of_values(ours, values, theirs),
        *_of_times(ours, theirs),
        *_of_states(ours, np.array(theirs.status)),
    ]
    return "; ".join(differences) or "agrees"


def _of_values(ours: Recording, values: NDArray[np.float64], theirs: "peer.Comtrade") -> list[str]:
    """Ours in SI and primary units, against theirs brought there by the configuration's ratios."""
    channels = theirs.cfg.analog_channels
    roles = channel_roles([(c.name, c.ph, c.uu) for c in channels])
    ratios = [c.primary / c.secondary if c.pors.upper() == "S" and c.secondary else 1.0 for c in channels]
    scale = np.array([role.scale * ratio for role, ratio in zip(roles, ratios, strict=True)])[:, None]
    expected = values * scale
    skewed = np.array([c.skew != 0 for c in channels])[:, None]
    missing = np.isnan(ours.samples) & ~np.isnan(expected)
    tolerance = 1e-9 * np.nanmax(np.abs(expected), axis=1, keepdims=True, initial=0) + 1e-12
    wrong = (np.abs(ours.samples - expected) > tolerance) & ~skewed & ~missing
    said = []
    if (scale != 1).any():
        said.append("values in primary SI units")
    if skewed.any():
        said.append("skew removed")
    if missing.any():
        said.append(f"{int(missing.sum())} missing values, there numbers")
    if wrong.any():
        said.append(f"OTHER VALUES in {int(wrong.any(axis=1).sum())} channels")
    return said


def _of_times(ours: Recording, theirs: "peer.Comtrade") -> list[str]:
    said = []
    times = np.asarray(theirs.time, dtype=np.float64)
    late = float(np.max(np.abs(ours.time_s - (times - times[0])), initial=0.0))
    if late > TIME_TOLERANCE_S:
        said.append(f"times differ by up to {late:.3g} s")
    if ours.start_time_ns // 1000 != int(np.datetime64(theirs.start_timestamp, "us").astype(np.int64)):
        said.append(f"starts {np.datetime64(ours.start_time_ns, 'ns')}, comtrade {theirs.start_timestamp}")
    return said


def _of_states(ours: Recording, states: NDArray[np.int64]) -> list[str]:
    if ours.digitals is None:
        return [] if states.size == 0 else ["STATES not read"]
    same = np.array_equal(ours.digitals.unpacked().T, states != 0)
    return [] if same else ["OTHER STATES"]


if __name__ == "__main__":
    sys.exit(main())
