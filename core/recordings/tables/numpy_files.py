"""Tables in NumPy's files: .npy with one array, .npz with several by name. Pickled objects are refused."""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from core.recordings.tables.arrays import table_of_arrays
from core.recordings.tables.library import refusing_damage
from core.recordings.tables.table import Table

FORM = "a NumPy file of plain numbers (numpy.save, numpy.savez; no pickled objects)"


def read_numpy_table(path: Path) -> Table:
    """Read a table from a NumPy file.

    Columns of a single array are named 1, 2, 3 ..., those of a structured one by its fields.

    Parameters
    ----------
    path : pathlib.Path
        The file.

    Returns
    -------
    Table
        The table.

    Raises
    ------
    RecordingError
        If the file is damaged, or has no arrays of numbers.
    """
    with refusing_damage(path, FORM):
        loaded = np.load(path, allow_pickle=False)
        if isinstance(loaded, np.ndarray):
            arrays = _parts(loaded)
        else:
            with loaded:
                arrays = {name: loaded[name] for name in loaded.files}
        return table_of_arrays(path, arrays)


def _parts(array: NDArray[Any]) -> dict[str, NDArray[np.generic]]:
    """Return the columns of an array by their names."""
    if array.dtype.names:
        return {name: array[name] for name in array.dtype.names}
    if array.ndim != 2:
        return {"1": array}
    rows = array if array.shape[0] >= array.shape[1] else array.T
    return {str(number + 1): rows[:, number] for number in range(rows.shape[1])}
