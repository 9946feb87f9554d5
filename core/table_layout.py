"""What a motor's file tells of its tables: which column is which phase, and how its values become SI."""

from dataclasses import dataclass

PhaseFactors = tuple[float, float, float]
"""One number for each of phases a, b, c (or ab, bc, ca)."""


@dataclass(frozen=True, slots=True)
class TableScaling:
    """How the values of a table become amperes and volts: scale times the value as written, plus offset.

    Parameters
    ----------
    sample_rate_hz : float or None, optional
        Sampling rate of files that have no times [Hz].
    current_scale, voltage_scale : tuple of float or None, optional
        Amperes and volts of one as it is written, a phase; None where the file has units.
    current_offset, voltage_offset : tuple of float, default (0.0, 0.0, 0.0)
        What is added [A], [V].
    """

    sample_rate_hz: float | None = None
    current_scale: PhaseFactors | None = None
    voltage_scale: PhaseFactors | None = None
    current_offset: PhaseFactors = (0.0, 0.0, 0.0)
    voltage_offset: PhaseFactors = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class TableLayout:
    """Columns of a motor's tables by what they measure, and how their values become SI.

    Parameters
    ----------
    columns : tuple of tuple of str, optional
        Quantity ("ia", "vb", "vca") and name of each column; those not given are found by name and unit.
    scaling : TableScaling, optional
        How their values become SI.
    """

    columns: tuple[tuple[str, str], ...] = ()
    scaling: TableScaling = TableScaling()


ANY_LAYOUT = TableLayout()
"""Columns are found by name and unit."""
