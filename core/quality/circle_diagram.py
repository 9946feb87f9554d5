"""Circle diagram of the equivalent circuit: the currents that a healthy machine can draw.

Two points bound every running motor: at no load it draws what magnetises it, at standstill the most it ever
does. Both follow from the motor's parameters, so the gate needs no rule of thumb on the nameplate.
"""

from dataclasses import dataclass
from math import pi, sqrt

import numpy as np
from numpy.typing import NDArray

from core.machines.base import Array
from core.machines.parameters import Connection, Motor

_SLIPS = np.concatenate([[1e-6], np.geomspace(1e-4, 1.0, 400)])


@dataclass(frozen=True, slots=True)
class CircleDiagram:
    """Line current per volt of phase-to-neutral voltage over the slip: conductances of one sequence [S].

    Parameters
    ----------
    admittance : ndarray of complex, shape (slips,)
        From no load to standstill [S].
    rated_current_A : float
        Line current at rated torque and voltage, rms [A].
    pull_out_torque_Nm : float
        Greatest torque of all slips at rated voltage [N m].
    generating : ndarray of complex, shape (slips,)
        The admittance at the same slips below zero, where the load drives the machine [S].
    is_delta : bool
        Whether the windings are in delta.
    """

    admittance: NDArray[np.complex128]
    rated_current_A: float
    pull_out_torque_Nm: float
    generating: NDArray[np.complex128]
    is_delta: bool

    @property
    def at_no_load(self) -> float:
        """Least admittance of a running motor [S]."""
        return float(abs(self.admittance[0]))

    @property
    def at_standstill(self) -> float:
        """Greatest admittance, that of the locked rotor [S]."""
        return float(abs(self.admittance[-1]))

    def running_range_A(self, phase_voltage_V: float) -> tuple[float, float]:
        """Return the currents of a motor that runs.

        Parameters
        ----------
        phase_voltage_V : float
            Voltage phase to neutral, rms [V].

        Returns
        -------
        tuple of float
            From no load to rated load, rms [A].
        """
        no_load = self.at_no_load * phase_voltage_V
        return no_load, max(no_load, self.rated_current_A)

    def lag_deg(self, admittance: float) -> float:
        """Return by how much the current lags the voltage where the machine draws as much.

        Parameters
        ----------
        admittance : float
            Size of the admittance [S].

        Returns
        -------
        float
            Angle at the nearest point of the diagram [deg].
        """
        return _lag_deg(self.admittance, admittance)

    def generating_lag_deg(self, admittance: float) -> float:
        """Return by how much the current lags the voltage where the machine generates as much.

        Parameters
        ----------
        admittance : float
            Size of the admittance [S].

        Returns
        -------
        float
            Angle at the nearest point [deg].
        """
        return _lag_deg(self.generating, admittance)


def circle_diagram(motor: Motor, frequency_hz: float) -> CircleDiagram:
    """Compute the circle diagram of the healthy machine, seen from its terminals.

    A delta is seen as the star equal to it.

    Parameters
    ----------
    motor : Motor
        Nameplate, parameters, channel names and limits of the motor.
    frequency_hz : float
        Supply frequency [Hz].

    Returns
    -------
    CircleDiagram
        The diagram.
    """
    machine, nameplate = motor.parameters, motor.nameplate
    w = 2.0 * pi * frequency_hz
    rotor = machine.rotor_resistance_ohm / _SLIPS + 1j * w * machine.rotor_leakage_H
    driven = -machine.rotor_resistance_ohm / _SLIPS + 1j * w * machine.rotor_leakage_H
    magnetising = 1j * w * machine.magnetising_inductance_H
    stator = machine.stator_resistance_ohm + 1j * w * machine.stator_leakage_H
    impedance = stator + magnetising * rotor / (magnetising + rotor)
    rotor_share = np.abs(magnetising / (magnetising + rotor))
    star = 1.0 / sqrt(3.0) if nameplate.connection is Connection.STAR else 1.0
    current: Array = star * nameplate.rated_voltage_V / np.abs(impedance)
    torque = 3.0 * (rotor_share * current) ** 2 * rotor.real * nameplate.pole_pairs / w
    # A motor that cannot bear its rated torque has no rated current, so its greatest torque is used.
    pull_out = int(np.argmax(torque))
    reached = torque[: pull_out + 1] >= nameplate.rated_torque_Nm
    point = int(np.argmax(reached)) if reached.any() else pull_out
    per_line = 1.0 if nameplate.connection is Connection.STAR else 3.0
    return CircleDiagram(
        admittance=np.asarray(per_line / impedance, dtype=np.complex128),
        rated_current_A=float(current[point]) * (1.0 if per_line == 1.0 else sqrt(3.0)),
        pull_out_torque_Nm=float(torque[pull_out]),
        generating=np.asarray(
            per_line / (stator + magnetising * driven / (magnetising + driven)), dtype=np.complex128
        ),
        is_delta=nameplate.connection is Connection.DELTA,
    )


def _lag_deg(points: NDArray[np.complex128], admittance: float) -> float:
    nearest = int(np.argmin(np.abs(np.abs(points) - admittance)))
    return -float(np.degrees(np.angle(points[nearest])))
