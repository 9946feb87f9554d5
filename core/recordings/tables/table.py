"""A table of samples: columns as a file has them, and what its column of times says."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

FEWEST_SAMPLES = 16
MOST_OCTETS = 500_000_000
"""Files of tables are read at once; larger ones are refused."""


@dataclass(frozen=True, slots=True)
class Column:
    """One column of a file.

    Parameters
    ----------
    name : str
        Name as the file has it; its number from 1 on where there is none.
    unit : str
        Unit as the file has it; "" where there is none.
    values : ndarray, shape (n,)
        Values as they are written; of dates and times the seconds after the first.
    dates_ns : int or None, optional
        UTC of the first row, of a column of dates and times [ns since 1970].
    is_time : bool, default False
        Whether the file itself declares it a column of times.
    """

    name: str
    unit: str
    values: NDArray[np.float64]
    dates_ns: int | None = None
    is_time: bool = False


@dataclass(frozen=True, slots=True)
class Table:
    """Columns of samples, and how fast they were taken.

    Parameters
    ----------
    columns : tuple of Column
        The columns; those of times and of row numbers are not among them.
    sample_rate_hz : float or None
        Sampling rate by the file [Hz]; None where it tells none.
    instants_s : ndarray or None, shape (n,), optional
        Time of every row after the first [s], where they are not evenly spaced.
    start_time_ns : int or None, optional
        UTC of the first row [ns since 1970]; None where the file tells none.
    numbered_by : str or None, optional
        Name of the column that numbers the rows; None where there is none.
    notes : tuple of str, optional
        What was left out or taken for granted, in words.
    """

    columns: tuple[Column, ...]
    sample_rate_hz: float | None
    instants_s: NDArray[np.float64] | None = None
    start_time_ns: int | None = None
    numbered_by: str | None = None
    notes: tuple[str, ...] = field(default=())

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the columns."""
        return tuple(column.name for column in self.columns)
