"""Tables in MATLAB's files: version 5 by SciPy, 7.3 (HDF5) by h5py. Any other HDF5 file is read alike.

Fields of structures are named with points (motor.ia); cells, texts and objects are left out.
"""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from core.recordings.tables.arrays import table_of_arrays
from core.recordings.tables.library import library, refusing_damage
from core.recordings.tables.table import Table

HDF5 = b"\x89HDF\r\n\x1a\n"
OFFSETS = (0, 512, 1024, 2048)
"""MATLAB puts a head of its own before the HDF5 file."""
DEEPEST = 8
UNITS = ("unit", "units", "Unit", "Units")


def read_matlab_table(path: Path) -> Table:
    """Read a table from a MATLAB or HDF5 file.

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
        If the file is damaged or has no arrays of numbers, or h5py is not installed.
    OSError
        If it cannot be read.
    """
    with path.open("rb") as file:
        head = file.read(max(OFFSETS) + len(HDF5))
    if any(head[offset:].startswith(HDF5) for offset in OFFSETS):
        return _from_hdf5(path)
    from scipy.io import loadmat

    with refusing_damage(path, "a MATLAB file, or an HDF5 file"):
        return table_of_arrays(path, dict(_fields("", loadmat(path, simplify_cells=True), DEEPEST)))


def _fields(prefix: str, values: Mapping[str, Any], deeper: int) -> Iterator[tuple[str, NDArray[np.generic]]]:
    for name, value in values.items():
        if name.startswith("__"):
            continue
        if isinstance(value, dict) and deeper:
            yield from _fields(f"{prefix}{name}.", value, deeper - 1)
        elif isinstance(value, np.ndarray | int | float):
            yield f"{prefix}{name}", np.asarray(value)


def _from_hdf5(path: Path) -> Table:
    h5py = library(path, "h5py", "MATLAB 7.3 and HDF5 files")
    arrays: dict[str, NDArray[np.generic]] = {}
    units: dict[str, str] = {}

    def take(name: str, item: Any) -> None:
        is_text = item.attrs.get("MATLAB_class", b"") in (b"char", b"cell", b"function_handle")
        if not isinstance(item, h5py.Dataset) or is_text or item.dtype.kind not in "fiu" or name[0] == "#":
            return
        told = name.replace("/", ".")
        arrays[told] = item[()]
        unit = next((item.attrs[key] for key in UNITS if key in item.attrs), "")
        units[told] = unit.decode("utf-8", "replace") if isinstance(unit, bytes) else str(unit)

    with refusing_damage(path, "a MATLAB 7.3 or HDF5 file"), h5py.File(path, "r") as file:
        file.visititems(take)
        return table_of_arrays(path, arrays, units)
