"""Recorded starts, filled with what the relay's own report tells of them."""

from dataclasses import replace

from core.starts.examined import ExaminedStart

_FILLED = ("acceleration_s", "running_current_A", "lowest_voltage_V")


def filled_by_report(
    recorded: ExaminedStart, reported: ExaminedStart
) -> tuple[ExaminedStart, tuple[str, ...]]:
    """Return a recorded start with what its record does not show from the relay's report of the same start.

    What was recorded stays. Where the acceleration time is the report's, so are I2t and heating: those of the
    record are of a part of the start.

    Parameters
    ----------
    recorded : ExaminedStart
        The start by its samples.
    reported : ExaminedStart
        The same start by the relay's report.

    Returns
    -------
    ExaminedStart
        The start.
    tuple of str
        Names of the figures that are the report's.
    """
    figures, told = recorded.figures, reported.figures
    filled = {
        name: getattr(told, name)
        for name in _FILLED
        if getattr(figures, name) is None and getattr(told, name) is not None
    }
    stress = recorded.stress
    if "acceleration_s" in filled:
        filled |= {"i2t_A2s": told.i2t_A2s, "i2t_over_s": told.i2t_over_s}
        stress = reported.stress
    return replace(recorded, figures=replace(figures, **filled), stress=stress), tuple(filled)
