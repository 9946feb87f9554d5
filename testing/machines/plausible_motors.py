"""Motors of every rating that a motor file may describe, for property tests."""

import math
from typing import Any

import numpy as np
from hypothesis import strategies as st

from core.machines import plausibility
from core.machines.parameters import Connection, MachineParameters, Motor, Nameplate
from core.recordings import Quantity, Recording

INWARDS = 1e-6
"""Figures are rounded when they are written; so far from its ends a range is left alone."""


def between(least: float, most: float) -> st.SearchStrategy[float]:
    """Numbers of a range, each decade as likely as the others."""
    low, high = math.log(least) + INWARDS, math.log(most) - INWARDS
    return st.floats(low, high).map(math.exp)


@st.composite
def plausible_motors(draw: st.DrawFn, *, frequency_Hz: float | None = None) -> Motor:
    """Motors whose every figure lies in its range, together or not."""
    voltage_V = draw(between(*plausibility.RATED_VOLTAGE_V))
    power = plausibility.plausible_power(voltage_V)
    nameplate = Nameplate(
        rated_power_W=draw(between(power.least, power.most)),
        rated_voltage_V=voltage_V,
        rated_frequency_Hz=frequency_Hz or draw(between(*plausibility.RATED_FREQUENCY_HZ)),
        pole_pairs=draw(st.integers(1, plausibility.MOST_POLE_PAIRS)),
        connection=draw(st.sampled_from(Connection)),
    )
    figures = {
        one.field: draw(between(one.least, one.most)) for one in plausibility.plausible_parameters(nameplate)
    }
    return Motor("PUMP-7", nameplate, MachineParameters(**figures))


def scaled_to(recording: Recording, of: Nameplate, to: Nameplate) -> Recording:
    """The recording as a motor of another rating would give it: the same in per unit."""
    voltage = to.rated_voltage_V / of.rated_voltage_V
    current = to.rated_power_W / of.rated_power_W / voltage
    factors = np.array(
        [current if channel.quantity is Quantity.CURRENT else voltage for channel in recording.channels]
    )
    fields: dict[str, Any] = {name: getattr(recording, name) for name in recording.__dataclass_fields__}
    return Recording(**(fields | {"samples": recording.samples * factors[:, np.newaxis]}))
