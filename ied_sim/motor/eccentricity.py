"""A rotor out of the middle of its bore: the air gap's mean permeance, which changes as the rotor turns.

A static eccentricity d_s stands still and a dynamic one d_d turns with the rotor, both as shares of the gap.
Together the rotor's axis is off by d, d^2 = d_s^2 + d_d^2 + 2 d_s d_d cos(theta_m), and the mean of 1 / gap
around the bore is 1 / sqrt(1 - d^2) of that without. All inductances of the air-gap field change with it once
a turn, which modulates the currents: lines at f +- f_r, as mixed eccentricity makes them.

What a permeance that is larger on one side does besides, fields of p +- 1 pole pairs, a winding of p pole
pairs does not link for p >= 2. Slots and the magnetic pull are left out.
Reference: Nandi, Toliyat and Li, doi:10.1109/TEC.2005.847955.
"""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Eccentricity:
    """How far the rotor is out of the middle, as shares of the air gap; together less than 1."""

    static: float = 0.0
    dynamic: float = 0.0


CENTRED = Eccentricity()
"""A rotor in the middle of its bore."""
