"""Numbers of a converter that nobody has scaled: counts or volts of a sensor, which are neither A nor V.

They show where a file has no unit, or where all samples are whole numbers, and the nameplate cannot fit them.
"""

from collections.abc import Iterator
from math import sqrt

import numpy as np

from core.machines.base import Array
from core.machines.parameters import Nameplate
from core.quality.finding import QualityFinding, finding
from core.quality.magnitude import LEAST_SIGNAL, rated_current_A
from core.quantity_text import plain
from core.recordings import Channel
from core.signals.terminals import Terminals

CURRENTS = (0.05, 15.0)
"""Swing of a running or starting motor's current over that of the rated one."""
VOLTAGES = (0.3, 2.0)
"""Swing of its voltages over that of the rated line voltage; phase voltages have 0.58 of it."""
FEWEST_VALUES = 8
"""Fewer different whole numbers are a record of nothing, rather than of counts."""


def counts(terminals: Terminals, nameplate: Nameplate) -> Iterator[QualityFinding]:
    """Refuse samples that are counts rather than amperes or volts; only failures are told.

    Parameters
    ----------
    terminals : Terminals
        Currents and voltages at the motor's terminals.
    nameplate : Nameplate
        Rated values of the motor.

    Yields
    ------
    QualityFinding
        A failure.
    """
    amps = _swing(terminals.current_abc) / (sqrt(2.0) * rated_current_A(nameplate))
    volts = _swing(terminals.voltages) / (sqrt(2.0) * nameplate.rated_voltage_V)
    is_on = volts >= VOLTAGES[0] or amps >= LEAST_SIGNAL
    if not is_on:
        return
    yield from _told("current", "amperes", amps, CURRENTS, terminals.current_channels, terminals.current_abc)
    yield from _told("voltage", "volts", volts, VOLTAGES, terminals.voltage_channels, terminals.voltages)


def _told(
    name: str,
    unit: str,
    share: float,
    plausible: tuple[float, float],
    channels: tuple[Channel, ...],
    samples: Array,
) -> Iterator[QualityFinding]:
    least, most = plausible
    if not channels or least <= share <= most:
        return
    assumed = any(channel.unit_is_assumed for channel in channels)
    # Small whole numbers of a relay are rather those of a channel that measures nothing.
    if not (assumed or (share > most and _are_whole(samples))):
        return
    key = f"{name}_scale in [tables] of the motor file (--{name}-scale)"
    yield finding(
        name, share, most if share > most else least, "of rated", passed=False,
        message=f"counts, not {unit}: {', '.join(repr(channel.name) for channel in channels)} have "
        f"{'no unit' if assumed else 'whole numbers only'}, and {plain(share, 3)} of the rated {name}: give "
        f"{key if assumed else f'{name}_ratio in [transformers] of the motor file'}, the {unit} of one count",
    )  # fmt: skip


def _are_whole(samples: Array) -> bool:
    known = samples[np.isfinite(samples)]
    return (
        known.size > 0 and bool((known == np.round(known)).all()) and np.unique(known).size >= FEWEST_VALUES
    )


def _swing(samples: Array) -> float:
    if samples.size == 0:
        return 0.0
    half = samples / 2.0
    return float(np.ptp(half, axis=1).max())
