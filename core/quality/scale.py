"""Advice on the scale of the currents, where a diagnosis finds them odd."""

from core.machines.parameters import Motor
from core.quality.circle_diagram import circle_diagram
from core.quality.currents import currents_of
from core.quality.finding import QualityFinding
from core.quality.ratios import current_advice
from core.quality.supply import feed_of
from core.signals.terminals import Terminals

LEAST_OF_NO_LOAD = 0.85
"""Least share of the no-load current that errors of sensors and parameters within 10 % leave."""


def current_scale_advice(terminals: Terminals, motor: Motor) -> str:
    """Tell which ratio would make the currents those between no load and rated load.

    Parameters
    ----------
    terminals : Terminals
        Currents and voltages at the motor's terminals, of a record that passed the quality gate.
    motor : Motor
        Nameplate and parameters of the motor.

    Returns
    -------
    str
        What explains the currents, and the key to write; "" where they are between the two.
    """
    feed = feed_of(terminals, motor.nameplate)
    if isinstance(feed, QualityFinding):
        return ""
    circle = circle_diagram(motor, feed.frequency_hz)
    amps = currents_of(terminals, feed.frequency_hz).strong
    least, most = circle.running_range_A(feed.strong)
    if LEAST_OF_NO_LOAD * least <= amps <= most:
        return ""
    return current_advice(amps, (least, most), circle.rated_current_A, terminals.current_channels)
