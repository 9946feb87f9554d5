"""Kinds of change that are told apart, and what each looks like in every measurement of a motor."""

from enum import IntEnum
from functools import lru_cache
from math import hypot, sqrt
from typing import Any, Final, Protocol

import numpy as np

from core.condition.filter.state import BUS, I0, SIDES, V0, V2, ComplexArray
from core.condition.measuring.measurement import negative_impedance
from core.condition.measuring.signatures import (
    PATHS,
    A,
    shorted_turns,
    terminal_turn,
    turns_angle_slope,
    turns_size_slope,
    voltage_channels,
)
from core.condition.observation import VoltageChannels
from core.machines.parameters import Connection, Motor


class Cause(IntEnum):
    """Causes of a change."""

    SHORTED_TURNS = 0
    VOLTAGE_CHANNEL = 1
    CURRENT_CHANNEL = 2
    JOINT = 3
    IMPEDANCE = 4
    RECORDER = 5


CAUSES: Final = len(Cause)
PATH_SHARES: Final = (0.5, 0.2, 0.15, 0.1, 0.05)
"""Weights of the paths before. Where records cannot tell the path, the level shall rather be too high."""
WEIGHTS: Final = (1.0, 1.0, 1.0, 1.0, 0.01, 0.01)
"""Weights of the causes before."""
LEVEL: Final = 0.01
CHANNEL: Final = 0.02
JOINT_DROP: Final = 0.015
"""Standard deviations of their sizes: equivalent level, relative error, and voltage drop at rated current
over the rated voltage."""
TURNS_DIRECTION: Final = 0.02
STATOR: Final = 0.08
CHANNEL_DIRECTION: Final = 0.12
JOINT_DIRECTION: Final = 0.05
"""Standard deviations of the signatures' directions [rad]. Z2 leaves more of those in proportion to it
uncertain, and R_s over X_ls, of relative standard deviation STATOR, more of that of shorted turns. A channel
errs in phase as well as in ratio; a joint is a resistance."""
MACHINE, RESISTANCE = 0.06, 0.12
"""Relative standard deviations of the leakage and of R_s, which a motor's file gives at some temperature.
What a level adds to y goes with them."""
IMPEDANCE: Final = 0.1
LOAD: Final = 0.75
"""Efficiency times power factor of a motor at rated load, from which its rated current follows."""


class Hypothesis(Protocol):
    """One cause in one place.

    Attributes
    ----------
    cause : int
        A `Cause`.
    place : int
        Winding or channel of the positive-sequence frame.
    path : float
        Resistance of a fault's path over that of the shorted turns.
    column : int
        0 for a signature in y, 1 for one in proportion to j1.
    u : complex
        Signature in y per size.
    side : ndarray of complex, shape (4,)
        Signatures in the side channels per size.
    spread : float
        Standard deviation of the size before.
    direction : float
        Standard deviation of the signature's direction [rad].
    impedance : bool
        Whether the signature is in proportion to Z2.
    one_sided : bool
        Whether the size is positive.
    share : float
        Share of this place and path in its cause before.
    unit : float
        Size as it is told, per size.
    scale : float
        Relative standard deviation of the signature's size.
    """

    cause: int
    place: int
    path: float
    column: int
    u: complex
    side: ComplexArray
    spread: float
    direction: float
    impedance: bool
    one_sided: bool
    share: float
    unit: float
    scale: float


HYPOTHESIS: Final = np.dtype(
    [
        ("cause", "i8"),
        ("place", "i8"),
        ("path", "f8"),
        ("column", "i8"),
        ("u", "c16"),
        ("side", "c16", (SIDES,)),
        ("spread", "f8"),
        ("direction", "f8"),
        ("impedance", "?"),
        ("one_sided", "?"),
        ("share", "f8"),
        ("unit", "f8"),
        ("scale", "f8"),
    ]
)

Hypotheses = Any
"""Array of Hypothesis."""


@lru_cache(maxsize=1024)
def hypotheses_of(motor: Motor, channels: VoltageChannels, scale_ohm: float) -> Hypotheses:
    """Return all places of all causes, as the filter of a motor sees them.

    Parameters
    ----------
    motor : Motor
        The motor.
    channels : VoltageChannels
        Which voltages are measured.
    scale_ohm : float
        Impedance z [ohm].

    Returns
    -------
    array of Hypothesis
        Shorted turns by winding and path, voltage channels, current channels, joints.
    """
    turn, z = terminal_turn(motor), scale_ohm
    Z2n = negative_impedance(motor.parameters, motor.nameplate.rated_frequency_Hz)
    rows: list[tuple[object, ...]] = []
    none = (0j,) * SIDES
    for x in range(3):
        for p, share in zip(PATHS, PATH_SHARES, strict=True):
            u = shorted_turns(motor, x, p)
            direction = hypot(TURNS_DIRECTION, STATOR * turns_angle_slope(motor, p))
            scale = hypot(MACHINE, RESISTANCE * turns_size_slope(motor, p))
            rows.append(
                (
                    Cause.SHORTED_TURNS,
                    x,
                    p,
                    0,
                    u,
                    none,
                    LEVEL,
                    direction,
                    True,
                    True,
                    share / 3.0,
                    1.0,
                    scale,
                )
            )
    for x, e in enumerate(voltage_channels(channels)):
        side = [0j] * SIDES
        side[V2] = side[BUS] = e
        if channels is VoltageChannels.PHASE:
            side[V0] = A**-x / 3.0
        rows.append(
            (
                Cause.VOLTAGE_CHANNEL,
                x,
                0.0,
                0,
                e * turn,
                tuple(side),
                CHANNEL,
                CHANNEL_DIRECTION,
                False,
                False,
                1.0 / 3.0,
                1.0,
                0.0,
            )
        )
    for x in range(3):
        side = [0j] * SIDES
        side[I0] = A**-x / 3.0
        u = -Z2n / z * A**x / 3.0 * turn
        rows.append(
            (
                Cause.CURRENT_CHANNEL,
                x,
                0.0,
                1,
                u,
                tuple(side),
                CHANNEL,
                CHANNEL_DIRECTION,
                True,
                False,
                1.0 / 3.0,
                1.0,
                0.0,
            )
        )
    rated = rated_current(motor, z)
    delta = motor.nameplate.connection is Connection.DELTA
    for x in range(3):
        # In delta a joint in the line carries the line current, which is not the winding's.
        u = A**x / 3.0
        share = 1.0 / 6.0 if delta else 1.0 / 3.0
        rows.append(
            (
                Cause.JOINT,
                x,
                0.0,
                1,
                u,
                none,
                JOINT_DROP / rated,
                JOINT_DIRECTION,
                False,
                True,
                share,
                rated,
                0.0,
            )
        )
        if delta:
            rows.append(
                (
                    Cause.JOINT,
                    3 + x,
                    0.0,
                    1,
                    u * turn,
                    none,
                    JOINT_DROP / rated,
                    JOINT_DIRECTION,
                    False,
                    True,
                    share,
                    rated,
                    0.0,
                )
            )
    return np.array(rows, HYPOTHESIS)


def rated_current(motor: Motor, scale_ohm: float) -> float:
    """Return |j1| at rated load.

    Parameters
    ----------
    motor : Motor
        The motor.
    scale_ohm : float
        Impedance z [ohm].

    Returns
    -------
    float
        Current times z over V1.
    """
    plate = motor.nameplate
    winding = plate.rated_voltage_V / (1.0 if plate.connection is Connection.DELTA else sqrt(3.0))
    return scale_ohm * plate.rated_power_W / (3.0 * winding**2 * LOAD)
