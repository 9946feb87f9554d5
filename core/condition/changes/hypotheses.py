"""Kinds of change that are told apart, and what each looks like in every measurement of a motor."""

from cmath import rect
from enum import IntEnum
from functools import lru_cache
from math import radians, sqrt
from typing import Any, Final, Protocol

import numpy as np

from core.condition.filter.state import BUS, I0, SIDES, TURNS, V0, V2, ComplexArray
from core.condition.filter.state import CHANNEL as IN_CHANNEL
from core.condition.filter.state import JOINT as IN_JOINT
from core.condition.measuring.impedance import negative_impedance
from core.condition.measuring.turns_grid import turns_grid
from core.condition.observation import VoltageChannels
from core.diagnosis.channel_errors import A, terminal_turn, voltage_channels, voltage_forward_shares
from core.machines.parameters import Connection, Motor
from core.signals.sequence import PhaseSequence


class Cause(IntEnum):
    """Causes of a change. Those from IMPEDANCE on are free: they have no place and no signature."""

    SHORTED_TURNS = 0
    VOLTAGE_CHANNEL = 1
    CURRENT_CHANNEL = 2
    JOINT = 3
    ELEMENT = 4
    """What hangs between two lines behind the relay's transformers: a heater, a capacitor that is lost."""
    IMPEDANCE = 5
    RECORDER = 6
    ASYMMETRY = 7
    """An asymmetry of unknown cause, which the current's forward-turning part does not show."""
    OTHER_LOAD = 8
    """Three-phase load behind the relay's transformers, such as another motor."""


CAUSES: Final = len(Cause)
FREE: Final = CAUSES - int(Cause.IMPEDANCE)
"""Number of the free causes."""
WEIGHTS: Final = (1.0, 1.0, 1.0, 1.0, 0.03, 0.01, 0.01, 0.1, 0.01)
"""Weights of the causes before."""
LEVEL: Final = 0.01
CHANNEL: Final = 0.02
JOINT_DROP: Final = 0.015
"""Standard deviations of their sizes: equivalent level, relative error, and voltage drop at rated current
over the rated voltage."""
CHANNEL_DIRECTION: Final = 0.12
JOINT_DIRECTION: Final = 0.05
"""Standard deviations of the signatures' directions [rad]. Z2 leaves more of those in proportion to it
uncertain. A channel errs in phase as well as in ratio; a joint is a resistance."""
ELEMENT_CURRENT: Final = 0.03
"""Standard deviation of an element's current over the rated one."""
ELEMENTS: Final = ((90.0, 0.3), (-90.0, 0.3), (0.0, 0.25), (180.0, 0.15))
"""Angle of an element's admittance [degrees], and share of such elements: a capacitor that is connected or
lost, a heater that is."""
ELEMENT_DIRECTION: Final = 0.04
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
    node : int
        Node of the grid of axes and leakages; 0 of other causes than shorted turns.
    column : int
        0 for a signature in y, 1 for one in proportion to j1.
    u : complex
        Signature in y per size.
    side : ndarray of complex, shape (4,)
        Signatures in the side channels per size.
    current : complex
        Signature in z I1/V1 per size, in proportion to what `current_column` says.
    current_column : int
        TURNS, CHANNEL or JOINT of `core.condition.filter.state`.
    spread : float
        Standard deviation of the size before.
    direction : float
        Standard deviation of the signature's direction [rad].
    impedance : bool
        Whether the signature is in proportion to Z2.
    one_sided : bool
        Whether the size is positive.
    share : float
        Share of this place in its cause before; of shorted turns it goes with the level.
    unit : float
        Size as it is told, per size.
    """

    cause: int
    place: int
    node: int
    column: int
    u: complex
    side: ComplexArray
    current: complex
    current_column: int
    spread: float
    direction: float
    impedance: bool
    one_sided: bool
    share: float
    unit: float


HYPOTHESIS: Final = np.dtype(
    [
        ("cause", "i8"),
        ("place", "i8"),
        ("node", "i8"),
        ("column", "i8"),
        ("u", "c16"),
        ("side", "c16", (SIDES,)),
        ("current", "c16"),
        ("current_column", "i8"),
        ("spread", "f8"),
        ("direction", "f8"),
        ("impedance", "?"),
        ("one_sided", "?"),
        ("share", "f8"),
        ("unit", "f8"),
    ]
)

Hypotheses = Any
"""Array of Hypothesis."""


@lru_cache(maxsize=1024)
def hypotheses_of(
    motor: Motor, sequence: PhaseSequence, channels: VoltageChannels, scale_ohm: float
) -> Hypotheses:
    """Return all places of all causes, as the filter of a motor sees them.

    Parameters
    ----------
    motor : Motor
        The motor.
    sequence : PhaseSequence
        Order of the supply's phases at the terminals.
    channels : VoltageChannels
        Which voltages are measured.
    scale_ohm : float
        Impedance z [ohm].

    Returns
    -------
    array of Hypothesis
        Channels and joints, then shorted turns by winding and node of the coarse grid.
    """
    others = _others(motor, channels, scale_ohm)
    grid = turns_grid(motor, sequence, scale_ohm)
    nodes = grid.y.size
    found = np.zeros(len(others) + 3 * nodes, HYPOTHESIS)
    found[: len(others)] = np.array(others, HYPOTHESIS)
    turns = found[len(others) :]
    turns["cause"], turns["one_sided"], turns["impedance"] = Cause.SHORTED_TURNS, True, True
    turns["place"], turns["node"] = np.repeat(np.arange(3), nodes), np.tile(np.arange(nodes), 3)
    turns["u"] = (A ** np.arange(3)[:, np.newaxis] * grid.y).ravel()
    turns["current"], turns["current_column"] = np.tile(grid.current, 3), TURNS
    turns["direction"], turns["share"] = np.tile(grid.direction, 3), np.tile(grid.usual, 3) / 3.0
    turns["spread"], turns["unit"] = LEVEL, 1.0
    return found


def _others(motor: Motor, channels: VoltageChannels, scale_ohm: float) -> list[tuple[object, ...]]:
    """Return the rows of channels and joints."""
    turn, z = terminal_turn(motor), scale_ohm
    Z2n = negative_impedance(motor, motor.nameplate.rated_frequency_Hz)
    none = (0j,) * SIDES
    rows: list[tuple[object, ...]] = []
    seen = zip(voltage_channels(channels), voltage_forward_shares(channels), strict=True)
    for x, (e, forward) in enumerate(seen):
        side = [0j] * SIDES
        side[V2] = side[BUS] = e
        if channels is VoltageChannels.PHASE:
            side[V0] = A**-x / 3.0
        rows.append(
            (
                Cause.VOLTAGE_CHANNEL, x, 0, 0, e * turn, tuple(side), -forward, IN_CHANNEL, CHANNEL,
                CHANNEL_DIRECTION, False, False, 1.0 / 3.0, 1.0,
            )
        )  # fmt: skip
    for x in range(3):
        side = [0j] * SIDES
        side[I0] = A**-x / 3.0
        u = -Z2n / z * A**x / 3.0 * turn
        rows.append(
            (
                Cause.CURRENT_CHANNEL, x, 0, 1, u, tuple(side), 1.0 / 3.0, IN_CHANNEL, CHANNEL,
                CHANNEL_DIRECTION, True, False, 1.0 / 3.0, 1.0,
            )
        )  # fmt: skip
    rated = rated_current(motor, z)
    delta = motor.nameplate.connection is Connection.DELTA
    # In delta a joint in the line carries the line current, which is not the winding's.
    for place in range(6 if delta else 3):
        u = A ** (place % 3) / 3.0 * (turn if place >= 3 else 1.0)
        rows.append(
            (
                Cause.JOINT, place, 0, 1, u, none, 1.0 / 3.0, IN_JOINT, JOINT_DROP / rated,
                JOINT_DIRECTION, False, True, 1.0 / 6.0 if delta else 1.0 / 3.0, rated,
            )
        )  # fmt: skip
    rows += _elements(Z2n, z, turn, rated)
    return rows


def _elements(Z2n: complex, z: float, turn: complex, rated: float) -> list[tuple[object, ...]]:
    """Return the rows of elements between two lines.

    An element of the admittance Y between the two lines beside x draws I1 = Y V1 and I2 = -a^x Y V1, whatever
    the motor does. Its size is |z Y|.
    """
    spread = ELEMENT_CURRENT * rated / sqrt(3.0)
    return [
        (
            Cause.ELEMENT, x, 0, 0, Z2n / z * A**x * admittance * turn, (0j,) * SIDES, admittance, TURNS,
            spread, ELEMENT_DIRECTION, True, True, share / 3.0, sqrt(3.0) / rated,
        )
        for x in range(3)
        for angle, share in ELEMENTS
        for admittance in [rect(1.0, radians(angle))]
    ]  # fmt: skip


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
