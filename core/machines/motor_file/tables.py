"""How a motor's tables of samples are read: what its file says of their rate, scale and offset."""

from core.machines.motor_file.table import MotorTable
from core.table_layout import PhaseFactors, TableScaling

SAMPLE_RATES_HZ = (1.0, 1e8)
NO_OFFSET = (0.0, 0.0, 0.0)


def table_scaling(table: MotorTable) -> TableScaling:
    """Read the table [tables].

    Parameters
    ----------
    table : MotorTable
        The table.

    Returns
    -------
    TableScaling
        What it says.
    """
    return TableScaling(
        sample_rate_hz=table.optional_number("sample_rate_Hz", SAMPLE_RATES_HZ, unit="Hz"),
        current_scale=_scale(table, "current_scale"),
        voltage_scale=_scale(table, "voltage_scale"),
        current_offset=table.phase_numbers("current_offset") or NO_OFFSET,
        voltage_offset=table.phase_numbers("voltage_offset") or NO_OFFSET,
    )


def _scale(table: MotorTable, key: str) -> PhaseFactors | None:
    scale = table.phase_numbers(key)
    if scale is not None and 0.0 in scale:
        table.refuse(key, "numbers other than zero", scale)
        return None
    return scale
