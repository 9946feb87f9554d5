"""Channels with the very same samples: one was recorded, or named, in place of the others."""

from collections.abc import Iterator

import numpy as np

from core.quality.finding import QualityFinding, finding
from core.signals.terminals import Terminals

FEWEST_VALUES = 8
"""Channels of fewer different values may agree because nothing is measured."""


def copied(terminals: Terminals) -> Iterator[QualityFinding]:
    """Refuse channels of which two have the very same samples; only failures are told.

    Parameters
    ----------
    terminals : Terminals
        Currents and voltages at the motor's terminals.

    Yields
    ------
    QualityFinding
        A failure.
    """
    for channels, samples in (
        (terminals.current_channels, terminals.current_abc),
        (terminals.voltage_channels, terminals.voltages),
    ):
        if len(channels) < 2:
            continue
        first = samples[0]
        same = [k for k in range(len(channels)) if np.array_equal(samples[k], first)]
        if len(same) > 1 and np.unique(first).size >= FEWEST_VALUES:
            names = " and ".join(repr(channels[k].name) for k in same)
            yield finding(
                "copied channel", len(same), 1, "channels", passed=False,
                message=f"{names} have the very same samples: one channel stands for several phases; correct "
                "[channels] of the motor's file, or the recorder's settings",
            )  # fmt: skip
            return
