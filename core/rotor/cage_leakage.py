"""What the leakage of a broken cage adds to its asymmetry.

Around a broken bar two loops of the cage are one, which links more of the air gap's field. Beside an uneven
resistance the cage so has an uneven reactance, which grows with the slip:

    a measured = a (1 + c a measured lambda L_m),   lambda = s w_s / R_r

By the network of bars and rings, c is about 1.2, and up to 2.4 with up to three neighbouring bars broken: of
motors of 0.8 to 250 kW with 28 to 56 bars, rings of 0.1 to 0.5 of the resistance, at a quarter of the load to
1.2. Bars that are not insulated from the iron have less. docs/evidence/rotor.md has the table.
"""

USUAL, LEAST, MOST = 1.2, 0.0, 2.4
"""The factor c of usual cages, and its ends."""


def without_leakage(
    asymmetry: float, slip_over_resistance: float, magnetising_inductance_H: float, factor: float = USUAL
) -> float:
    """Return the asymmetry of the resistance alone.

    Parameters
    ----------
    asymmetry : float
        As measured; below zero it is left as it is.
    slip_over_resistance : float
        Ratio lambda [1/H].
    magnetising_inductance_H : float
        L_m [H].
    factor : float, default USUAL
        Factor c.

    Returns
    -------
    float
        Half the difference of the resistances of the cage's axes, over R_r.
    """
    return asymmetry / (1.0 + factor * max(asymmetry, 0.0) * slip_over_resistance * magnetising_inductance_H)
