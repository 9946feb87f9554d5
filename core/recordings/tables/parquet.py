"""Tables in Parquet files, by pyarrow."""

from pathlib import Path
from typing import Any

import numpy as np

from core.recordings.errors import RecordingError
from core.recordings.tables.arrays import MOST_COLUMNS
from core.recordings.tables.library import library, refusing_damage
from core.recordings.tables.table import Column, Table
from core.recordings.tables.time_column import table_of
from core.units import NANOSECONDS_PER_SECOND

MOST_VALUES = 200_000_000
"""Parquet is compressed: so many values of a file are taken into memory at most."""
FORM = "a Parquet file"


def read_parquet_table(path: Path) -> Table:
    """Read a table from a Parquet file: its columns of numbers, and one of time stamps.

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
        If the file is damaged, too long or has no columns of numbers, or pyarrow is not installed.
    """
    parquet = library(path, "pyarrow.parquet", "Parquet files")
    with refusing_damage(path, FORM), parquet.ParquetFile(path) as file:
        rows, width = file.metadata.num_rows, file.metadata.num_columns
        if width > MOST_COLUMNS or rows * width > MOST_VALUES:
            expected = f"at most {MOST_COLUMNS} columns and {MOST_VALUES} values"
            raise RecordingError(path, "size", expected=expected, found=f"{width} columns of {rows} rows")
        table = file.read()
        columns, left_out = [], []
        for field, values in zip(table.schema, table.columns, strict=True):
            column = _column(field, values)
            if column is None:
                left_out.append(f"{field.name} ({field.type})")
            else:
                columns.append(column)
    notes = (f"left out, no numbers: {', '.join(left_out[:12])}",) if left_out else ()
    return table_of(path, columns, notes=notes)


def _column(field: Any, values: Any) -> Column | None:
    """Return a column; None of one that has no numbers."""
    metadata = field.metadata or {}
    unit = next((metadata[key] for key in (b"unit", b"units") if key in metadata), b"").decode(
        "utf-8", "replace"
    )
    kind = str(field.type)
    array = values.to_numpy()
    if kind.startswith("timestamp"):
        instants = array.astype("datetime64[ns]")
        first = instants[0] if instants.size else np.datetime64(0, "ns")
        seconds = np.where(np.isnat(instants), np.nan, (instants - first).astype(np.float64))
        return Column(
            field.name, "", seconds / NANOSECONDS_PER_SECOND, int(first.astype(np.int64)), is_time=True
        )
    if kind.startswith(("int", "uint", "float", "double", "halffloat", "decimal")):
        return Column(field.name, unit, array.astype(np.float64))
    if kind.startswith("duration"):
        seconds = array.astype("timedelta64[ns]").astype(np.float64) / NANOSECONDS_PER_SECOND
        return Column(field.name, "s", seconds, is_time=True)
    return None
