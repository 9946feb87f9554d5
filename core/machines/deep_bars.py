"""Rotors whose bars displace their current, and leakage that saturates: what only a start sees.

The parameters of a motor's file are those of a small slip and of running currents. Bars that are deep, or lie
in two cages, are two loops in parallel behind a common leakage, an outer one of much resistance and an inner
one of much leakage (Pedra and Corcoles, IEEE Transactions on Energy Conversion 19(2), 2004, for two cages):

    Z_r(s) = j w L_c + (R_o/s) || (R_i/s + j w L_i)

At a small slip both share the current by their resistances; at a great one the outer loop carries it. Any two
loops behind a common leakage look like these from outside, for L_o can be added to L_c.

Teeth tips saturate at several times the rated current, and the leakage of stator and rotor falls:

    L(I) = L (1 - k + k g(I / I_0)),   g(x) = (1 + x^n)^(-1/n)

At great currents the part k carries a constant flux. The sharpness n of the knee is about 5 for a flux that
is clipped, by its fundamental (Lipo and Consoli, IEEE Transactions on Industry Applications IA-20(1), 1984),
and about 1.6 for an arc tangent.
"""

from dataclasses import dataclass
from typing import Final, NamedTuple

USUAL_SHARPNESS: Final = 2.7


class TwoLoops(NamedTuple):
    """The loops of a rotor, referred to the stator.

    Parameters
    ----------
    outer_resistance_ohm, inner_resistance_ohm : float
        R_o and R_i [ohm].
    common_leakage_H, inner_leakage_H : float
        L_c, which the current of both has, and L_i of the inner one alone [H].
    """

    outer_resistance_ohm: float
    inner_resistance_ohm: float
    common_leakage_H: float
    inner_leakage_H: float

    def impedance(self, slip_frequency: float) -> complex:
        """Return s Z_r, the rotor's impedance at its own frequency.

        Parameters
        ----------
        slip_frequency : float
            Angular frequency of the rotor's current, s w [rad/s].

        Returns
        -------
        complex
            Resistance and leakage reactance [ohm].
        """
        inner = complex(self.inner_resistance_ohm, slip_frequency * self.inner_leakage_H)
        outer = self.outer_resistance_ohm
        return 1j * slip_frequency * self.common_leakage_H + outer * inner / (outer + inner)


class SeenRotor(NamedTuple):
    """A rotor at one frequency of its current, over what it is at a small slip.

    Parameters
    ----------
    resistance_ratio, leakage_share : float
        Of resistance and leakage.
    """

    resistance_ratio: float
    leakage_share: float


@dataclass(frozen=True, slots=True)
class DeepBars:
    """How much a rotor changes from a small slip to a great one.

    Parameters
    ----------
    resistance_ratio : float
        Resistance at a great slip over that at a small one, above 1.
    leakage_share : float
        Leakage at a great slip over that at a small one, below 1.
    """

    resistance_ratio: float
    leakage_share: float

    def loops(self, resistance_ohm: float, leakage_H: float) -> TwoLoops:
        """Return the two loops of a rotor.

        Parameters
        ----------
        resistance_ohm : float
            R_r' at a small slip [ohm].
        leakage_H : float
            L_lr' at a small slip [H].

        Returns
        -------
        TwoLoops
            The loops.
        """
        r, share = self.resistance_ratio, self.leakage_share
        outer = r * resistance_ohm
        inner = outer / (r - 1.0)
        # At a small slip the inner loop carries R_o / (R_o + R_i) of the current; L_i counts by its square.
        carried = outer / (outer + inner)
        return TwoLoops(
            outer,
            inner,
            share * leakage_H,
            (1.0 - share) * leakage_H / carried**2,
        )

    def seen_at(self, slip_frequency: float, resistance_ohm: float, leakage_H: float) -> SeenRotor:
        """Return what the rotor is at a frequency of its own current, over what it is at a small slip.

        Parameters
        ----------
        slip_frequency : float
            Angular frequency of the rotor's current, s w [rad/s].
        resistance_ohm, leakage_H : float
            R_r' and L_lr' at a small slip [ohm, H].

        Returns
        -------
        SeenRotor
            Resistance and leakage.
        """
        seen = self.loops(resistance_ohm, leakage_H).impedance(slip_frequency)
        return SeenRotor(seen.real / resistance_ohm, seen.imag / slip_frequency / leakage_H)


@dataclass(frozen=True, slots=True)
class LeakageSaturation:
    """Leakage that falls with the current.

    Parameters
    ----------
    share : float
        Part k of the leakage that teeth carry, and that is lost at great currents.
    knee_current_A : float
        Current I_0 of a winding about which they saturate, rms [A].
    knee_sharpness : float, optional
        Exponent n of the transition between both.
    """

    share: float
    knee_current_A: float
    knee_sharpness: float = USUAL_SHARPNESS

    def factor(self, current_A: float) -> float:
        """Return the leakage at a current over that of small ones.

        Parameters
        ----------
        current_A : float
            Current of a winding, rms [A].

        Returns
        -------
        float
            Factor, 1 far below the knee.
        """
        x = current_A / self.knee_current_A
        return 1.0 - self.share + self.share * unsaturated(x, self.knee_sharpness)


def unsaturated(x: float, sharpness: float) -> float:
    """Return what is left of a leakage whose teeth saturate.

    Parameters
    ----------
    x : float
        Current over that of the knee.
    sharpness : float
        n.

    Returns
    -------
    float
        g(x), 1 far below the knee.
    """
    left: float = (1.0 + x**sharpness) ** (-1.0 / sharpness)
    return left
