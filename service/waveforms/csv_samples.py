"""All samples and states of a recording as CSV (RFC 4180), in UTF-8, piece by piece."""

import csv
import io
from collections.abc import Iterator
from math import isnan
from typing import Final

import numpy as np
from numpy.typing import NDArray

from service.exports.csv_file import without_formula
from service.waveforms.opened import Opened

LINES_A_PIECE: Final = 5000
DIGITS: Final = 7


def csv_samples(shown: Opened) -> Iterator[bytes]:
    """Return the file. Names are headings with their units; states are 0 and 1."""
    recording = shown.recording
    names = [f"{one.name} ({one.unit})" if one.unit else one.name for one in shown.channels]
    states = () if recording.digitals is None else recording.digitals.names
    sink = io.StringIO(newline="")
    writer = csv.writer(sink)
    writer.writerow(["time_s", *map(without_formula, names), *map(without_formula, states)])
    times = recording.time_s
    for first in range(0, max(shown.samples, 1), LINES_A_PIECE):
        last = min(first + LINES_A_PIECE, shown.samples)
        columns = [[f"{time:.9g}" for time in times[first:last]]]
        columns += [_figures(shown.values(one, first, last)) for one in shown.channels]
        if recording.digitals is not None:
            bits = np.unpackbits(
                recording.digitals.packed[first:last], axis=1, count=len(states), bitorder="little"
            )
            columns += [[str(bit) for bit in column] for column in bits.T.tolist()]
        writer.writerows(zip(*columns, strict=True))
        yield sink.getvalue().encode()
        sink.seek(0)
        sink.truncate()


def _figures(values: NDArray[np.float64]) -> list[str]:
    return ["" if isnan(value) else f"{value:.{DIGITS}g}" for value in values.tolist()]
