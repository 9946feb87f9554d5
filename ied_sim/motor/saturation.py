"""Iron that saturates: the main inductance follows the flux of the air gap.

The magnetising current rises over the flux u, over its rated one, as

    i / i_rated = (1 - a) u + a u^n,   hence   L_m(u) / L_m = 1 / (1 - a + a u^(n - 1))

so that the parameters are those of the rated flux. The harmonics of a saturated field are left out.
"""

from dataclasses import dataclass
from math import sqrt

from core.machines.parameters import Motor

EXPONENT = 9.0
"""The n of usual sheet steel about its knee."""


@dataclass(frozen=True, slots=True)
class MainSaturation:
    """Saturation of the main inductance.

    Parameters
    ----------
    share : float
        Share a of the rated magnetising current that the iron needs; zero for iron that does not saturate.
    exponent : float
        The n of the curve.
    """

    share: float = 0.0
    exponent: float = EXPONENT


LINEAR_IRON = MainSaturation()


def flux_per_current(motor: Motor) -> float:
    """Return the flux of the air gap over that of no load at rated voltage, per magnetising current [1/A]."""
    nameplate, parameters = motor.nameplate, motor.parameters
    linked = sqrt(2) * nameplate.winding_voltage_V / nameplate.rated_angular_frequency
    return (parameters.magnetising_inductance_H + parameters.stator_leakage_H) / linked
