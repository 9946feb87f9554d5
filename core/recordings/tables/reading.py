"""Reading of tables of samples, whatever their format."""

from collections.abc import Callable, Mapping
from pathlib import Path

from core.recordings.errors import RecordingError
from core.recordings.tables.matlab import read_matlab_table
from core.recordings.tables.numpy_files import read_numpy_table
from core.recordings.tables.parquet import read_parquet_table
from core.recordings.tables.table import MOST_OCTETS, Table
from core.recordings.tables.tdms import read_tdms_table
from core.recordings.tables.text import read_text_table

TABLE_READERS: Mapping[str, Callable[[Path], Table]] = {
    ".csv": read_text_table,
    ".tsv": read_text_table,
    ".txt": read_text_table,
    ".parquet": read_parquet_table,
    ".mat": read_matlab_table,
    ".h5": read_matlab_table,
    ".hdf5": read_matlab_table,
    ".tdms": read_tdms_table,
    ".npy": read_numpy_table,
    ".npz": read_numpy_table,
}
"""Reader of each file name suffix, lower case."""


def read_table(path: Path) -> Table:
    """Read a table of samples; the suffix of its file tells the format.

    Parameters
    ----------
    path : pathlib.Path
        Path of the file.

    Returns
    -------
    Table
        The table.

    Raises
    ------
    RecordingError
        If the file is missing, of another kind, or damaged, or a library that reads it is not installed.
    OSError
        If a file that exists cannot be read.
    """
    if not path.is_file():
        raise RecordingError(path, "file", expected="a file", found="a folder" if path.is_dir() else "none")
    size = path.stat().st_size
    if size > MOST_OCTETS:
        raise RecordingError(path, "size", expected=f"at most {MOST_OCTETS} octets", found=str(size))
    return TABLE_READERS[path.suffix.casefold()](path)
