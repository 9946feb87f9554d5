"""The motor as a circuit of coupled windings in phase variables.

Every winding is a coil with a number of turns (a fraction of the phase's), an axis, a resistance and a
leakage of its own. A shorted phase is two coils in series: mu of the turns, bridged by the fault path, and
1 - mu of them, on one axis or, in a winding by slots, with the axis and the leakage of the coil that they are
part of (`stator`). The cage is three coils on axes that turn with the rotor. Nothing is transformed: coils
couple by the cosine of the angle between their axes,

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

from core.machines.parameters import MachineParameters, Motor
from ied_sim.motor.cage import USUAL_CAGE, Cage
from ied_sim.motor.fault import NEGLIGIBLE_LEVEL, TurnFault
from ied_sim.motor.rotor import RotorLoops, three_coils
from ied_sim.motor.slots import SlotWinding
from ied_sim.motor.stator import phase_loops, slot_loops
from ied_sim.motor.warming import COLD, ResistanceFactors

Matrix = NDArray[np.float64]


@dataclass(frozen=True)
class WindingCircuit:
    """Loop matrices of one motor: m loops, the stator's first, then the fault's if any, then the rotor's.

    Parameters
    ----------
    leakage : ndarray, shape (m, m)
        Inductance of the leakage that crosses the teeth's tips [H].
    deep_leakage : ndarray, shape (m, m)
        Inductance of the leakage that does not [H].
    constant, cosine, sine : ndarray, shape (m, m)
        A, B and D, the inductance of the air-gap field [H].
    resistance : ndarray, shape (m, m)
        R [ohm].
    drive : ndarray, shape (m, 3)
        E, voltage around each loop for the three terminal voltages.
    stator_current : ndarray, shape (2, m)
        The stator's current on the two axes of the field, of the amplitude of a phase's.
    rotor_current : ndarray, shape (2, m)
        The rotor's current on the two axes that turn with it, alike.
    """

    leakage: Matrix
    deep_leakage: Matrix
    constant: Matrix
    cosine: Matrix
    sine: Matrix
    resistance: Matrix
    drive: Matrix
    stator_current: Matrix
    rotor_current: Matrix

    @property
    def loops(self) -> int:
        """Number of loops."""
        return len(self.resistance)

    def inductance(self, angle_rad: float) -> Matrix:
        """Return L(theta) at the electrical rotor angle `angle_rad`, shape (m, m) [H]."""
        gap = self.constant + self.cosine * np.cos(angle_rad) + self.sine * np.sin(angle_rad)
        inductance: Matrix = self.leakage + self.deep_leakage + gap
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
    motor: Motor,
    fault: TurnFault | None = None,
    *,
    winding: SlotWinding | None = None,
    harmonic_cage: Cage = USUAL_CAGE,
    rotor: RotorLoops | None = None,
    resistance_factors: ResistanceFactors = COLD,
    line_resistance_ohm: tuple[float, float, float] = (0.0, 0.0, 0.0),
    line_inductance_H: float = 0.0,
    neutral: bool = False,
) -> WindingCircuit:
    """Build the loops of a motor, healthy or with a part of one phase bridged.

    With `fault` None or of no turns there is no fault loop at all, so a healthy motor is exactly that: how
    its coils lie in slots does not matter then.

    Parameters
    ----------
    motor : Motor
        The motor.
    fault : TurnFault, optional
        The bridged turns: of a coil where it names one, else on the phase's axis.
    winding : SlotWinding, optional
        The winding by its slots, which a fault in a coil needs.
    harmonic_cage : Cage, optional
        Bars that answer the field's other orders; see `coils_of`.
    rotor : RotorLoops, optional
        The rotor's loops; None for the three coils of a healthy one.
    resistance_factors : ResistanceFactors
        Stator and rotor resistance over those of the parameters, for warm windings.
    line_resistance_ohm : tuple of float
        Resistance in the lines to terminals a, b, c, as of bad joints. The line currents are E' q, so it adds
        E diag(r) E' to the loops' resistance.
    line_inductance_H : float, default 0.0
        Inductance in each line, as of a cable [H].
    neutral : bool, default False
        Whether the star point is on the neutral.

    Returns
    -------
    WindingCircuit
        The loops.

    Raises
    ------
    ValueError
        If a fault is in a coil that the winding has not.
    """
    if fault is not None and fault.turns == 0:
        fault = None
    parameters = motor.parameters
    if fault is not None and fault.coil is not None:
        if winding is None:
            raise ValueError("the fault is in a coil, and the motor's winding is not known by its slots")
        stator = slot_loops(motor, winding, fault, harmonic_cage, neutral=neutral)
    else:
        stator = phase_loops(parameters, motor.nameplate.connection, fault, neutral=neutral)
    if rotor is None:
        rotor = three_coils(parameters)
    L_s = parameters.stator_self_inductance_H
    m = len(stator.drive)
    # The rotor's axes lead by theta: a coil and a rotor loop couple by cos(axis - theta) on the first axis of
    # the rotor and by sin(axis - theta) on the second.
    on_stator = L_s * stator.axes.T
    across = np.array([[0.0, -1.0], [1.0, 0.0]])

    drive = np.vstack((stator.drive, np.zeros((rotor.axes.shape[1], 3))))
    resistance = _diagonal(
        resistance_factors.stator * stator.resistance + stator.path,
        resistance_factors.rotor * rotor.resistance,
    )
    if rotor.outside is not None:
        resistance[m:, m:] += rotor.outside
    resistance += drive @ np.diag(line_resistance_ohm) @ drive.T
    deep = np.zeros_like(rotor.leakage) if rotor.deep_leakage is None else rotor.deep_leakage
    return WindingCircuit(
        leakage=_diagonal(stator.leakage, rotor.leakage),
        deep_leakage=_diagonal(np.zeros((m, m)), deep) + line_inductance_H * drive @ drive.T,
        constant=_diagonal(on_stator @ stator.axes, rotor.gap),
        cosine=_off_diagonal(on_stator @ rotor.axes),
        sine=_off_diagonal(on_stator @ across @ rotor.axes),
        resistance=resistance,
        drive=drive,
        stator_current=2.0 / 3.0 * np.hstack((stator.axes, np.zeros_like(rotor.axes))),
        rotor_current=2.0 / 3.0 * np.hstack((np.zeros_like(stator.axes), rotor.axes)),
    )


def _diagonal(stator: Matrix, rotor: Matrix) -> Matrix:
    """Return the matrix of all loops with these blocks on its diagonal."""
    first, second = len(stator), len(rotor)
    return np.block([[stator, np.zeros((first, second))], [np.zeros((second, first)), rotor]])


def _off_diagonal(mutual: Matrix) -> Matrix:
    """Return the matrix of all loops with this block between stator and rotor, and its transpose back."""
    first, second = mutual.shape
    return np.block([[np.zeros((first, first)), mutual], [mutual.T, np.zeros((second, second))]])
