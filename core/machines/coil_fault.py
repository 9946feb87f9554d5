"""Shorted turns inside one coil, as the terminals see them at one slip: the one place of the signature.

A share mu of a phase's turns lies in one coil, on the coil's own axis n_c, delta from the axis n of the
phase. A path of resistance r_f bridges them; its current is i_f = j / mu. Of the turns' leakage a share kappa
is their own; the rest they have in common with the phase, because they share its slots:

    lambda = kappa + (1 - kappa) mu,   p = r_f / (mu R_s)
    r_f i_f = mu R_s (i_x - i_f) + d(psi_x2)/dt,   psi_x2 = mu (L_ls (i_x - lambda i_f) + k n_c . psi_m)

Two numbers of the four are seen from the terminals, the equivalent level m = mu / (1 + p) and the leakage
psi = lambda / (1 + p): the turns are a shunt (R_s + j psi X_ls) / m. With z = R_s + j X_ls, A1 and A2 the air
gap at the slips s and 2 - s, Z1 = z + A1, Z2 = z + A2, e+ and e- = exp(+-j delta) / k_d:

    P = z + A1 e-    Q = z + A2 e+    P' = (z + A1 e+) / 3    Q' = (z + A2 e-) / 3
    j  = (P V1 / Z1 + Q V2 / Z2) / ((R_s + j psi X_ls) / m + (A1 + A2) / (3 k_d^2) - P P' / Z1 - Q Q' / Z2)
    I1 = (V1 + P' j) / Z1    I2 = (V2 + Q' j) / Z2

seen from the faulted winding x (V1 a^-x, V2 a^x). The zero sequence of the shunt's current flows round a
delta and takes z / 3 from the sum below the line. Inside one coil psi = c N m, N the coils of a phase, c
about 1.

The thesis's additional winding (core.machines.shorted_winding) shares nothing of z with the phase: P, Q, P',
Q' lack it, and its leakage is whole, R_s / m + j X_ls. psi = 1, delta = 0 and k_d = 1 are the split winding
of Tallam, Habetler and Harley (core.machines.split_winding).
"""

from cmath import exp as cexp
from math import pi
from typing import NamedTuple

from core.machines.compiled import compiled_as_written as compiled

THIRD_TURN = 2.0 * pi / 3.0


class AirGap(NamedTuple):
    """Impedances of a healthy machine at one slip.

    Parameters
    ----------
    stator : complex
        z = R_s + j X_ls [ohm].
    forward, backward : complex
        A1 and A2: j X_m parallel to R_r/s + j X_lr, at s and at 2 - s [ohm].
    """

    stator: complex
    forward: complex
    backward: complex


class SequencePair(NamedTuple):
    """A positive and a negative sequence, in any unit.

    Parameters
    ----------
    positive, negative : complex
        Phasors of winding 0.
    """

    positive: complex
    negative: complex


@compiled
def air_gap(
    z: complex, X_m: float, R_r: float, X_lr: float, slip: float, resistance_ratio: float = 1.0,
    leakage_share: float = 1.0,
) -> AirGap:  # fmt: skip
    """Return the impedances of a healthy machine at one slip.

    Parameters
    ----------
    z : complex
        R_s + j X_ls [ohm].
    X_m : float
        Magnetising reactance [ohm].
    R_r, X_lr : float
        Rotor's resistance and leakage reactance, referred to the stator [ohm].
    slip : float
        Slip against the positive sequence; zero is no load.
    resistance_ratio, leakage_share : float, default 1.0
        Rotor's resistance and leakage as the negative sequence sees them, over those at a small slip.

    Returns
    -------
    AirGap
        The impedances.
    """
    # j X_m (R_r + j s X_lr) / (R_r + j s (X_m + X_lr)): finite at no load too.
    back = 2.0 - slip
    forward = 1j * X_m * complex(R_r, slip * X_lr) / complex(R_r, slip * (X_m + X_lr))
    R_b, X_b = resistance_ratio * R_r, leakage_share * X_lr
    backward = 1j * X_m * complex(R_b, back * X_b) / complex(R_b, back * (X_m + X_b))
    return AirGap(z, forward, backward)


@compiled
def shunt_current(
    gap: AirGap, voltage: SequencePair, branch: complex, ahead: complex, behind: complex, circulating: float,
    shared: float = 1.0,
) -> complex:  # fmt: skip
    """Return the current j of shorted turns in winding 0.

    Parameters
    ----------
    gap : AirGap
        Impedances of the machine.
    voltage : SequencePair
        Voltages as seen from the faulted winding.
    branch : complex
        (R_s + j psi X_ls) / m [ohm].
    ahead, behind : complex
        e+ and e-: exp(j delta) / k_d and its conjugate.
    circulating : float
        Share of z that the zero sequence sees: 0 in star, 1/3 in delta.
    shared : float, default 1.0
        Share of z that the turns have in common with the phase; 0 where they are a winding of their own.

    Returns
    -------
    complex
        j, in the unit of the voltages over ohm.
    """
    z, A1, A2 = gap
    Y1, Y2 = 1.0 / (z + A1), 1.0 / (z + A2)
    c = shared * z
    P, Q = c + A1 * behind, c + A2 * ahead
    own = branch + (A1 + A2) * (ahead * behind) / 3.0 - circulating * c
    own -= P * (c + A1 * ahead) * Y1 / 3.0 + Q * (c + A2 * behind) * Y2 / 3.0
    return (P * Y1 * voltage.positive + Q * Y2 * voltage.negative) / own


@compiled
def faulty_currents(
    gap: AirGap, voltage: SequencePair, branch: complex, ahead: complex, behind: complex, circulating: float,
    winding: int, shared: float = 1.0,
) -> SequencePair:  # fmt: skip
    """Return the currents of a machine with shorted turns in one coil.

    Parameters
    ----------
    gap : AirGap
        Impedances of the machine.
    voltage : SequencePair
        Voltages of the windings.
    branch : complex
        (R_s + j psi X_ls) / m [ohm].
    ahead, behind : complex
        e+ and e-: exp(j delta) / k_d and its conjugate.
    circulating : float
        Share of z that the zero sequence sees: 0 in star, 1/3 in delta.
    winding : int
        Winding with the fault: 0, 1 or 2.
    shared : float, default 1.0
        Share of z that the turns have in common with the phase; 0 where they are a winding of their own.

    Returns
    -------
    SequencePair
        Currents of the windings, in the unit of the voltages over ohm.
    """
    z, A1, A2 = gap
    turn = cexp(1j * THIRD_TURN * winding)
    back = turn.conjugate()
    seen = SequencePair(voltage.positive * back, voltage.negative * turn)
    j = shunt_current(gap, seen, branch, ahead, behind, circulating, shared)
    return SequencePair(
        (voltage.positive + (shared * z + A1 * ahead) * j * turn / 3.0) / (z + A1),
        (voltage.negative + (shared * z + A2 * behind) * j * back / 3.0) / (z + A2),
    )
