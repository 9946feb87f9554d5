"""The motor as a circuit of coupled windings in phase variables.

Every winding is a coil with a number of turns (a fraction of the phase's), an axis, a resistance and a
leakage of its own. A shorted phase is two coils in series on one axis: mu of the turns, bridged by the fault
path, and 1 - mu of them. The cage is three coils on axes that turn with the rotor. Nothing is transformed:
coils couple by the cosine of the angle between their axes,

    L_ij = L_s N_i N_j cos(axis_i - axis_j)  +  leakage_i  where i = j,

and the star or the delta, the fault path and the closed cage are stated as loop currents q with
i_windings = C q (Kron). What is left is

    flux = L(theta) q,   d(flux)/dt = E v_abc - R q,   L(theta) = A + B cos(theta) + D sin(theta)

with theta the electrical angle of the rotor, and by reciprocity the line currents are E' q.
References: P. C. Krause, Analysis of Electric Machinery, ch. 1 and 4; Tallam, Habetler and Harley,
doi:10.1109/TIA.2002.800567, for the split phase.
"""

from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import NDArray

from core.machines.parameters import Connection, MachineParameters
from ied_sim.motor.fault import NEGLIGIBLE_LEVEL, TurnFault
from ied_sim.motor.warming import COLD, ResistanceFactors

Matrix = NDArray[np.float64]

PHASE_AXES = np.array([0.0, 2 * pi / 3, 4 * pi / 3])

# Loop currents of three coils whose common point floats: the third returns the sum of the other two.
_FLOATING_POINT = np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, -1.0]])
# Terminal voltages of the delta's windings: a to b, b to c, c to a.
_LINE_TO_LINE = np.array([[1.0, -1.0, 0.0], [0.0, 1.0, -1.0], [-1.0, 0.0, 1.0]])


@dataclass(frozen=True, slots=True)
class WindingCircuit:
    """Loop matrices of one motor: m loops, the stator's first, then the fault's if any, then the rotor's two.

    Parameters
    ----------
    constant, cosine, sine : ndarray, shape (m, m)
        A, B and D of L(theta) [H].
    resistance : ndarray, shape (m, m)
        R [ohm].
    drive : ndarray, shape (m, 3)
        E, voltage around each loop for the three terminal voltages.
    """

    constant: Matrix
    cosine: Matrix
    sine: Matrix
    resistance: Matrix
    drive: Matrix

    @property
    def loops(self) -> int:
        """Number of loops."""
        return len(self.resistance)

    def inductance(self, angle_rad: float) -> Matrix:
        """Return L(theta) at the electrical rotor angle `angle_rad`, shape (m, m) [H]."""
        inductance: Matrix = self.constant + self.cosine * np.cos(angle_rad) + self.sine * np.sin(angle_rad)
        return inductance

    def line_currents(self, loop_currents: Matrix) -> Matrix:
        """Return currents into terminals a, b, c, shape (3, n) [A], from loop currents, shape (n, m) [A]."""
        return self.drive.T @ loop_currents.T

    def fastest_rate(self) -> float:
        """Return the largest decay rate of the loops with the rotor held still [1/s]."""
        rates = np.linalg.eigvals(np.linalg.solve(self.inductance(0.0), self.resistance))
        return float(np.max(np.abs(rates)))


def highest_fault_resistance(parameters: MachineParameters, fastest_rate: float) -> float:
    """Return the fault resistance [ohm] whose loop decays at `fastest_rate` [1/s] at NEGLIGIBLE_LEVEL.

    The loop of few turns decays at r_f / (mu L_ls), and mu_eq is then mu^2 R_s / r_f.
    """
    rate = fastest_rate * parameters.stator_leakage_H
    return rate**2 * NEGLIGIBLE_LEVEL / parameters.stator_resistance_ohm


def winding_circuit(
    parameters: MachineParameters,
    connection: Connection,
    fault: TurnFault | None = None,
    *,
    resistance_factors: ResistanceFactors = COLD,
    broken_bars: float = 0.0,
    line_resistance_ohm: tuple[float, float, float] = (0.0, 0.0, 0.0),
) -> WindingCircuit:
    """Build the loops of a motor, healthy or with a part of one phase bridged.

    With `fault` None or of no turns there is no fault loop at all, so a healthy motor is exactly that.

    Parameters
    ----------
    parameters : MachineParameters
        Parameters of the motor.
    connection : Connection
        Star or delta.
    fault : TurnFault, optional
        The bridged turns.
    resistance_factors : ResistanceFactors
        Stator and rotor resistance over those of the parameters, for warm windings.
    broken_bars : float
        Share k = n / N of the cage's bars that are broken, all in one place. One rotor coil then has R (1 + 3
        k / (1 - 2 k)): along its axis the cage has lost the share 2 k of its conductance, across it none.
    line_resistance_ohm : tuple of float
        Resistance in the lines to terminals a, b, c, as of bad joints. The line currents are E' q, so it adds
        E diag(r) E' to the loops' resistance.

    Returns
    -------
    WindingCircuit
        The loops.

    References
    ----------
    Bellini et al., doi:10.1109/28.968187, for broken bars.
    """
    if fault is not None and fault.turns == 0:
        fault = None
    phases = _FLOATING_POINT if connection is Connection.STAR else np.eye(3)
    drive = _FLOATING_POINT.T if connection is Connection.STAR else _LINE_TO_LINE

    turns, axes, stator_rows = [], [], []
    for phase in range(3):
        shares = [1.0] if fault is None or fault.phase != phase else [1 - fault.turns, fault.turns]
        for share in shares:
            turns.append(share)
            axes.append(PHASE_AXES[phase])
            stator_rows.append(phases[phase])
    stator = len(turns)

    stator_loops = phases.shape[1]
    fault_loops = 0 if fault is None else 1
    loops = stator_loops + fault_loops + 2
    incidence = np.zeros((stator + 3, loops))
    incidence[:stator, :stator_loops] = stator_rows
    if fault is not None:
        # The fault path takes its current away from the bridged turns, the second coil of its phase.
        incidence[fault.phase + 1, stator_loops] = -1.0
    incidence[stator:, -2:] = _FLOATING_POINT

    N = np.array([*turns, 1.0, 1.0, 1.0])
    axis = np.array([*axes, *PHASE_AXES])
    on_rotor = np.arange(N.size) >= stator
    leakage = np.where(on_rotor, parameters.rotor_leakage_H, N * parameters.stator_leakage_H)
    resistance = np.where(on_rotor, parameters.rotor_resistance_ohm, N * parameters.stator_resistance_ohm)
    resistance *= np.where(on_rotor, resistance_factors.rotor, resistance_factors.stator)
    resistance[stator] *= 1 + 3 * broken_bars / (1 - 2 * broken_bars)

    between = np.subtract.outer(axis, axis)
    coupling = parameters.stator_self_inductance_H * np.outer(N, N)
    same_side = np.equal.outer(on_rotor, on_rotor)
    # The rotor's axes lead by theta: cos(d - theta) from stator to rotor, cos(d + theta) back.
    turning = np.where(same_side, 0.0, np.where(on_rotor[:, None], -1.0, 1.0))
    loop_resistance = incidence.T @ np.diag(resistance) @ incidence
    if fault is not None:
        loop_resistance[stator_loops, stator_loops] += fault.resistance_ohm
    loop_drive = np.zeros((loops, 3))
    loop_drive[:stator_loops] = drive
    loop_resistance += loop_drive @ np.diag(line_resistance_ohm) @ loop_drive.T
    return WindingCircuit(
        constant=incidence.T
        @ (np.where(same_side, coupling * np.cos(between), 0.0) + np.diag(leakage))
        @ incidence,
        cosine=incidence.T @ np.where(same_side, 0.0, coupling * np.cos(between)) @ incidence,
        sine=incidence.T @ (turning * coupling * np.sin(between)) @ incidence,
        resistance=loop_resistance,
        drive=loop_drive,
    )
