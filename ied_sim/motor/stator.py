"""The stator's loops: phases whose turns lie on one axis, or coils in slots; healthy or with bridged turns.

Phase windings in star or delta, parallel branches and a fault path are stated as loop currents (Kron). Loops
know the air-gap field of the motor's own number of poles by how they stand on its two axes; all other
inductance is their leakage.

Turns shorted inside a coil lie in its slots and link all of its flux. So with W the shares of the coils'
turns through which the loop currents flow (the path takes its current away from the share f of its coil),
each inductance is W' L W of the coils. Resistances are those of the wire: the two parts of the coil have f
and 1 - f of its resistance.

What the field's other orders leave is an inductance and a resistance of the steady state at synchronous speed
(quasi-static): rotor circuits of these orders settle within a few milliseconds.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from core.machines.parameters import Connection, MachineParameters, Motor
from ied_sim.motor.cage import USUAL_CAGE, Cage
from ied_sim.motor.coils import Coils, coils_of
from ied_sim.motor.fault import TurnFault
from ied_sim.motor.rotor import FLOATING_POINT, PHASE_AXES
from ied_sim.motor.slots import SlotWinding

Matrix = NDArray[np.float64]

# Terminal voltages of the delta's windings: a to b, b to c, c to a.
_LINE_TO_LINE = np.array([[1.0, -1.0, 0.0], [0.0, 1.0, -1.0], [-1.0, 0.0, 1.0]])


@dataclass(frozen=True)
class StatorLoops:
    """Matrices of the stator's m loops.

    Parameters
    ----------
    leakage : ndarray, shape (m, m)
        Inductance without the field of the motor's own number of poles [H].
    resistance : ndarray, shape (m, m)
        Resistance of the windings, at the temperature of the parameters [ohm].
    path : ndarray, shape (m, m)
        Resistance of the fault path, which does not warm up with them [ohm].
    axes : ndarray, shape (2, m)
        Turns of each loop on the two axes of the field; (1, 0) is phase a.
    drive : ndarray, shape (m, 3)
        Voltage around each loop for the three terminal voltages.
    """

    leakage: Matrix
    resistance: Matrix
    path: Matrix
    axes: Matrix
    drive: Matrix


@dataclass(frozen=True)
class CoilLoops:
    """Loops of a stator of coils: m currents, those of the phases first, then of branches, then of the path.

    Parameters
    ----------
    current : ndarray, shape (n, m)
        Current of each coil, of its part that is not shorted.
    turns : ndarray, shape (n, m)
        Share of each coil's turns through which each loop current flows.
    resistance : ndarray, shape (m, m)
        Resistance of the copper [ohm].
    path : ndarray, shape (m, m)
        Resistance of the fault path [ohm].
    drive : ndarray, shape (m, 3)
        Voltage around each loop for the three terminal voltages.
    """

    current: Matrix
    turns: Matrix
    resistance: Matrix
    path: Matrix
    drive: Matrix


def phase_loops(
    parameters: MachineParameters, connection: Connection, fault: TurnFault | None, *, neutral: bool = False
) -> StatorLoops:
    """Return the loops of phases whose turns all lie on the phase's axis and leak each for itself.

    Parameters
    ----------
    parameters : MachineParameters
        Parameters of the motor.
    connection : Connection
        Star or delta.
    fault : TurnFault, optional
        The bridged turns; None for a healthy motor.
    neutral : bool, default False
        Whether the star point is on the neutral.

    Returns
    -------
    StatorLoops
        Two loops of a star, three of a delta or of a star on the neutral, and the fault's last.
    """
    phases, drive = _connected(connection, neutral=neutral)
    turns, axes, rows = [], [], []
    for phase in range(3):
        shares = [1.0] if fault is None or fault.phase != phase else [1 - fault.turns, fault.turns]
        for share in shares:
            turns.append(share)
            axes.append(PHASE_AXES[phase])
            rows.append(phases[phase])
    stator_loops = phases.shape[1]
    loops = stator_loops + (0 if fault is None else 1)
    incidence = np.zeros((len(turns), loops))
    incidence[:, :stator_loops] = rows
    path = np.zeros((loops, loops))
    if fault is not None:
        # The fault path takes its current away from the bridged turns, the second coil of its phase.
        incidence[fault.phase + 1, stator_loops] = -1.0
        path[stator_loops, stator_loops] = fault.resistance_ohm
    N, axis = np.array(turns), np.array(axes)
    own = incidence.T @ np.diag(N) @ incidence
    return StatorLoops(
        leakage=parameters.stator_leakage_H * own,
        resistance=parameters.stator_resistance_ohm * own,
        path=path,
        axes=np.vstack((np.cos(axis), np.sin(axis))) @ (N[:, None] * incidence),
        drive=np.vstack((drive, np.zeros((loops - stator_loops, 3)))),
    )


def slot_loops(
    motor: Motor,
    winding: SlotWinding,
    fault: TurnFault,
    cage: Cage = USUAL_CAGE,
    *,
    neutral: bool = False,
) -> StatorLoops:
    """Return the loops of a winding in slots, a part of one coil of which is bridged.

    Parameters
    ----------
    motor : Motor
        The motor; its parameters are the totals of the healthy winding.
    winding : SlotWinding
        Its winding.
    fault : TurnFault
        The bridged turns, with their coil.
    cage : Cage, optional
        Bars that answer the field's other orders; see `coils_of`.
    neutral : bool, default False
        Whether the star point is on the neutral.

    Returns
    -------
    StatorLoops
        Two loops of a star or three of a delta or of a star on the neutral, three for each branch but one,
        and the fault's last.

    Raises
    ------
    ValueError
        If there is no such winding or coil.
    """
    coils = coils_of(motor, winding, cage)
    loops = coil_loops(coils, motor.nameplate.connection, fault, neutral=neutral)
    inductance, loss = coils.quasi_static(loops.turns)
    linked = coils.fields[0] @ loops.turns
    return StatorLoops(
        leakage=coils.leakage_inductance(loops.turns) + inductance,
        resistance=loops.resistance + loss,
        path=loops.path,
        axes=np.vstack((linked.real, linked.imag)),
        drive=loops.drive,
    )


def coil_loops(
    coils: Coils, connection: Connection, fault: TurnFault | None, *, neutral: bool = False
) -> CoilLoops:
    """Return the loop currents of a stator of coils.

    Parameters
    ----------
    coils : Coils
        The coils.
    connection : Connection
        Star or delta.
    fault : TurnFault, optional
        The bridged turns, with their coil; None for a healthy motor, which has no loops of branches.
    neutral : bool, default False
        Whether the star point is on the neutral.

    Returns
    -------
    CoilLoops
        The loops.

    Raises
    ------
    ValueError
        If the fault names no coil, or bridges more turns than that has.
    """
    phases, drive = _connected(connection, neutral=neutral)
    current = phases[coils.of_phase] / coils.branches
    if fault is not None:
        for phase in range(3):
            mine = coils.of_phase == phase
            for branch in range(coils.branches - 1):
                first, last = coils.branch == branch, coils.branch == coils.branches - 1
                around = np.where(mine & first, 1.0, np.where(mine & last, -1.0, 0.0))
                current = np.column_stack((current, around))
        current = np.column_stack((current, np.zeros(len(current))))
    loops = current.shape[1]
    resistance, path, turns = coils.resistance_ohm * current.T @ current, np.zeros((loops, loops)), current
    if fault is not None:
        shorted, share = _shorted_part(coils, fault)
        turns = current.copy()
        turns[shorted, -1] = -share
        bridged = -share * coils.resistance_ohm * current[shorted]
        resistance[-1, :] = resistance[:, -1] = bridged
        resistance[-1, -1] = share * coils.resistance_ohm
        path[-1, -1] = fault.resistance_ohm
    return CoilLoops(current, turns, resistance, path, np.vstack((drive, np.zeros((loops - len(drive), 3)))))


def _shorted_part(coils: Coils, fault: TurnFault) -> tuple[int, float]:
    """Return the index of the coil with a fault, and the share of its turns that is bridged."""
    N = len(coils.of_phase) // 3
    if fault.coil is None or not 1 <= fault.coil <= N:
        raise ValueError(f"the winding has coils 1 to {N} in a phase, and the fault is in {fault.coil}")
    share = fault.turns * N
    if share > 1 + 1e-9:
        raise ValueError(f"the fault bridges {fault.turns:g} of the phase's turns, and a coil has 1/{N}")
    return coils.coil(fault.phase, fault.coil), share


def _connected(connection: Connection, *, neutral: bool) -> tuple[Matrix, Matrix]:
    """Return the currents of the phases by the loop currents, and the voltages around these loops."""
    if connection is Connection.STAR and neutral:
        return np.eye(3), np.eye(3)
    if connection is Connection.STAR:
        return FLOATING_POINT, FLOATING_POINT.T
    return np.eye(3), _LINE_TO_LINE
