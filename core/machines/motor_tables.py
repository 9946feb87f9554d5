"""How tables of samples of one motor are read: by its channels' names, and the scale in its file."""

from typing import Protocol

from core.machines.parameters import ChannelNames
from core.signals.terminals import LINES, PHASES
from core.table_layout import ANY_LAYOUT, TableLayout, TableScaling


class OfAMotor(Protocol):
    """What is known of a motor: all of it, or its plate alone."""

    @property
    def channels(self) -> ChannelNames:
        """Names of its channels."""
        ...

    @property
    def tables(self) -> TableScaling:
        """How its tables become amperes and volts."""
        ...


def layout_of(motor: OfAMotor | None) -> TableLayout:
    """Return how tables of a motor are read.

    Parameters
    ----------
    motor : OfAMotor or None
        The motor; None where it is not known.

    Returns
    -------
    TableLayout
        The layout; columns are found by name and unit where the motor's file names none.
    """
    if motor is None:
        return ANY_LAYOUT
    channels = motor.channels
    named = (
        ("i", PHASES, channels.currents),
        ("v", PHASES, channels.phase_voltages),
        ("v", LINES, channels.line_voltages),
    )
    columns = (
        (f"{letter}{phase}", name)
        for letter, phases, names in named
        if names
        for phase, name in zip(phases, names, strict=True)
    )
    return TableLayout(tuple(columns), motor.tables)
