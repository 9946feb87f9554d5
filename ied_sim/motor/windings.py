"""The motor as a circuit of coupled windings in phase variables.

Every winding is a coil with a number of turns (a fraction of the phase's), an axis, a resistance and a
leakage of its own. A shorted phase is two coils in series on one axis: mu of the turns, bridged by the fault
path, and 1 - mu of them. The cage is three coils on axes that turn with the rotor. Nothing is transformed:
coils couple by the cosine of the angle between their axes,

    L_ij = L_s N_i N_j cos(axis_i - axis_j)  +  leakage_i  where i = j,

and the star or the delta, the fault path and the closed cage are stated as loop currents q with
i_windings = C q (Kron). What is left is

    flux = L(theta) q,   d(flux)/dt = E v_abc - R q,
    L(theta) = leakage + A + B cos(theta) + D sin(theta)

with A, B and D those of the air-gap field, theta the electrical angle of the rotor, and by reciprocity the
line currents are E' q.
References: P. C. Krause, Analysis of Electric Machinery, ch. 1 and 4; Tallam, Habetler and Harley,
doi:10.1109/TIA.2002.800567, for the split phase.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from core.machines.parameters import Connection, MachineParameters
from ied_sim.motor.fault import NEGLIGIBLE_LEVEL, TurnFault
from ied_sim.motor.rotor import FLOATING_POINT, PHASE_AXES, RotorLoops, three_coils
from ied_sim.motor.warming import COLD, ResistanceFactors

Matrix = NDArray[np.float64]

# Terminal voltages of the delta's windings: a to b, b to c, c to a.
_LINE_TO_LINE = np.array([[1.0, -1.0, 0.0], [0.0, 1.0, -1.0], [-1.0, 0.0, 1.0]])


@dataclass(frozen=True)
class WindingCircuit:
    """Loop matrices of one motor: m loops, the stator's first, then the fault's if any, then the rotor's.

    Parameters
    ----------
    leakage : ndarray, shape (m, m)
        Inductance of the leakage [H].
    constant, cosine, sine : ndarray, shape (m, m)
        A, B and D, the inductance of the air-gap field [H].
    resistance : ndarray, shape (m, m)
        R [ohm].
    drive : ndarray, shape (m, 3)
        E, voltage around each loop for the three terminal voltages.
    """

    leakage: Matrix
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
        gap = self.constant + self.cosine * np.cos(angle_rad) + self.sine * np.sin(angle_rad)
        inductance: Matrix = self.leakage + gap
        return inductance

    def line_currents(self, loop_currents: Matrix) -> Matrix:
        """Return currents into terminals a, b, c, shape (3, n) [A], from loop currents, shape (n, m) [A]."""
        return self.drive.T @ loop_currents.T

    @cached_property
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
    rotor: RotorLoops | None = None,
    resistance_factors: ResistanceFactors = COLD,
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
    rotor : RotorLoops, optional
        The rotor's loops; None for the three coils of a healthy one.
    resistance_factors : ResistanceFactors
        Stator and rotor resistance over those of the parameters, for warm windings.
    line_resistance_ohm : tuple of float
        Resistance in the lines to terminals a, b, c, as of bad joints. The line currents are E' q, so it adds
        E diag(r) E' to the loops' resistance.

    Returns
    -------
    WindingCircuit
        The loops.
    """
    if fault is not None and fault.turns == 0:
        fault = None
    if rotor is None:
        rotor = three_coils(parameters)
    phases = FLOATING_POINT if connection is Connection.STAR else np.eye(3)
    drive = FLOATING_POINT.T if connection is Connection.STAR else _LINE_TO_LINE

    turns, axes, rows = [], [], []
    for phase in range(3):
        shares = [1.0] if fault is None or fault.phase != phase else [1 - fault.turns, fault.turns]
        for share in shares:
            turns.append(share)
            axes.append(PHASE_AXES[phase])
            rows.append(phases[phase])

    stator_loops = phases.shape[1]
    stator = stator_loops + (0 if fault is None else 1)
    incidence = np.zeros((len(turns), stator))
    incidence[:, :stator_loops] = rows
    if fault is not None:
        # The fault path takes its current away from the bridged turns, the second coil of its phase.
        incidence[fault.phase + 1, stator_loops] = -1.0

    N, axis = np.array(turns), np.array(axes)
    L_s = parameters.stator_self_inductance_H
    own = incidence.T @ np.diag(N) @ incidence
    coupling = L_s * np.outer(N, N) * np.cos(np.subtract.outer(axis, axis))
    # The rotor's axes lead by theta: a coil and a rotor loop couple by cos(axis - theta) on the first axis of
    # the rotor and by sin(axis - theta) on the second.
    on_stator = incidence.T @ (L_s * N * np.vstack((np.cos(axis), np.sin(axis)))).T
    across = np.array([[0.0, -1.0], [1.0, 0.0]])

    loop_drive = np.zeros((stator + rotor.axes.shape[1], 3))
    loop_drive[:stator_loops] = drive
    resistance = _diagonal(
        resistance_factors.stator * parameters.stator_resistance_ohm * own,
        resistance_factors.rotor * rotor.resistance,
    )
    if rotor.outside is not None:
        resistance[stator:, stator:] += rotor.outside
    if fault is not None:
        resistance[stator_loops, stator_loops] += fault.resistance_ohm
    resistance += loop_drive @ np.diag(line_resistance_ohm) @ loop_drive.T
    return WindingCircuit(
        leakage=_diagonal(parameters.stator_leakage_H * own, rotor.leakage),
        constant=_diagonal(incidence.T @ coupling @ incidence, rotor.gap),
        cosine=_off_diagonal(on_stator @ rotor.axes),
        sine=_off_diagonal(on_stator @ across @ rotor.axes),
        resistance=resistance,
        drive=loop_drive,
    )


def _diagonal(stator: Matrix, rotor: Matrix) -> Matrix:
    """Return the matrix of all loops with these blocks on its diagonal."""
    first, second = len(stator), len(rotor)
    return np.block([[stator, np.zeros((first, second))], [np.zeros((second, first)), rotor]])


def _off_diagonal(mutual: Matrix) -> Matrix:
    """Return the matrix of all loops with this block between stator and rotor, and its transpose back."""
    first, second = mutual.shape
    return np.block([[np.zeros((first, first)), mutual], [mutual.T, np.zeros((second, second))]])
