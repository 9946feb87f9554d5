"""COMTRADE 1999 binary, 1 s x 10 kHz x 6 channels: our strict reader against PyPI's comtrade."""

import tempfile
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import comtrade as peer

from benchmarks.stopwatch import best_of
from core.recordings import comtrade, read
from tests.core.motors import REFERENCE
from tests.core.phase_circuits import recording, running


def measure() -> Iterator[str]:
    with tempfile.TemporaryDirectory() as folder:
        record = recording(running(REFERENCE, 0.5), seconds=1.0)
        channels = tuple(replace(channel, full_scale=1000.0) for channel in record.channels)
        path = comtrade.write(Path(folder) / "bench.cfg", replace(record, channels=channels))
        ours = best_of(10, lambda: read(path))
        theirs = best_of(3, lambda: peer.load(str(path)))
    yield f"ours {ours * 1e3:.1f} ms, comtrade {theirs * 1e3:.1f} ms: {theirs / ours:.0f} times faster"
