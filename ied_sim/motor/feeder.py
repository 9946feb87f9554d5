"""The motor's feeder: what lies behind the relay's transformers besides the motor.

Capacitors and heaters draw currents that follow from the voltages alone, as elements between the lines do:
i = C dv/dt + G v, with node matrices C and G of lines a, b, c. A cable lies in series with the motor. Another
motor has the same voltages and its own load. All of them are connected and disconnected with the motor.
"""

from dataclasses import dataclass
from math import inf, pi

import numpy as np
from numpy.typing import NDArray

from core.machines.parameters import Connection, Motor, Nameplate
from ied_sim.motor.course import Points, value_at
from ied_sim.motor.load import Load
from ied_sim.motor.supply import Supply

Array = NDArray[np.float64]

INTACT: Points = ((0.0, 0.0),)
HALF_STEP_S = 1e-6
"""Half the time over which the slope of a voltage is taken: its 50th harmonic comes out within 0.1 %."""


@dataclass(frozen=True, slots=True)
class Capacitors:
    """A bank of capacitors, in delta or in a star whose star point is free.

    Parameters
    ----------
    kvar : float
        Reactive power of the whole bank at rated voltage and frequency [kvar].
    connection : Connection
        Star or delta.
    branch : int
        Branch that has lost elements: 0, 1, 2 for that on terminal a, b, c; in delta 0 is from a to b.
    lost : Points
        Lost share of this branch over time: points (time [s], share).
    """

    kvar: float
    connection: Connection = Connection.DELTA
    branch: int = 0
    lost: Points = INTACT

    def capacitance(self, nameplate: Nameplate, time_s: float) -> Array:
        """Return the node matrix of capacitances at one moment, shape (3, 3) [F]."""
        square = nameplate.rated_voltage_V**2 * 2.0 * pi * nameplate.rated_frequency_Hz
        whole = 1e3 * self.kvar / square
        if self.connection is Connection.DELTA:
            whole /= 3.0
        branches = np.full(3, whole)
        branches[self.branch] *= 1.0 - value_at(self.lost, time_s)
        if self.connection is Connection.DELTA:
            return sum((branches[k] * _between(k, (k + 1) % 3) for k in range(3)), np.zeros((3, 3)))
        if not branches.any():
            return np.zeros((3, 3))
        return np.asarray(np.diag(branches) - np.outer(branches, branches) / branches.sum())


@dataclass(frozen=True, slots=True)
class Heater:
    """A resistance between two lines, or from one to the neutral.

    Parameters
    ----------
    power_W : float
        Power at rated voltage [W].
    line, other : int or None
        The lines 0, 1, 2 (a, b, c); `other` None for the neutral.
    since_s : float
        When it is connected [s].
    """

    power_W: float
    line: int
    other: int | None = None
    since_s: float = -inf

    def conductance(self, nameplate: Nameplate, time_s: float) -> Array:
        """Return the node matrix of conductances at one moment, shape (3, 3) [S]."""
        if time_s < self.since_s:
            return np.zeros((3, 3))
        square = nameplate.rated_voltage_V**2
        if self.other is None:
            return np.asarray(np.diag(3.0 * self.power_W / square * (np.arange(3) == self.line)))
        return self.power_W / square * _between(self.line, self.other)


@dataclass(frozen=True, slots=True)
class Cable:
    """A cable between the voltage transformers and the motor: of one line, reactance at rated frequency."""

    resistance_ohm: float = 0.0
    reactance_ohm: float = 0.0


@dataclass(frozen=True, slots=True)
class OtherMotor:
    """Another motor behind the same transformers, connected since `since_s` [s]."""

    motor: Motor
    load: Load
    since_s: float = -inf


@dataclass(frozen=True, slots=True)
class Feeder:
    """What lies behind the relay's transformers besides the motor, and how they are connected.

    Parameters
    ----------
    capacitors : Capacitors or None, optional
        A bank.
    heaters : tuple of Heater, optional
        Loads of one or two phases.
    cable : Cable, optional
        In series with the motor.
    other_motor : OtherMotor or None, optional
        A second motor.
    neutral : bool, default False
        Whether the star point is on the neutral.
    inside_delta : bool, default False
        Whether the current transformers measure the windings ab, bc, ca inside the delta: only these then.
    """

    capacitors: Capacitors | None = None
    heaters: tuple[Heater, ...] = ()
    cable: Cable = Cable()
    other_motor: OtherMotor | None = None
    neutral: bool = False
    inside_delta: bool = False

    def currents(self, supply: Supply, nameplate: Nameplate, times: Array) -> Array:
        """Return what capacitors and heaters draw at the times [s], shape (3, n) [A]."""
        drawn, begin_s = np.zeros((3, times.size)), float(times[0])
        if self.capacitors is not None:
            C = self.capacitors.capacitance(nameplate, begin_s)
            later, earlier = (supply.phase_voltages(times + step) for step in (HALF_STEP_S, -HALF_STEP_S))
            drawn += C @ (later - earlier) / (2.0 * HALF_STEP_S)
        G = sum((one.conductance(nameplate, begin_s) for one in self.heaters), np.zeros((3, 3)))
        if G.any():
            drawn += G @ supply.phase_voltages(times)
        return drawn


MOTOR_ALONE = Feeder()


def _between(line: int, other: int) -> Array:
    """Return the node matrix of an element of one unit between two lines."""
    ends = (np.arange(3) == line).astype(np.float64) - (np.arange(3) == other)
    return np.outer(ends, ends)
