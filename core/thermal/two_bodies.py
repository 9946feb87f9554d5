"""A thermal model of two bodies: the stator winding, and the iron with the frame that the fan cools.

C_w dw/dt = P_w - G (w - f),  C_f df/dt = P_f + G (w - f) - H f,

w, f: rises of winding and frame above the ambient temperature [K]. P_w, P_f: their losses; those of the
winding go with the square of the current. It is solved exactly over steps of constant current. A motor of
unknown build is described by what ratings and catalogues tell: the rise of its class, and two time constants.

References
----------
.. [1] IEC 60034-1, 8 (temperature rise), IEC 60034-11 (thermal protection).
.. [2] Zocholl, Schweitzer, Aliaga-Zegarra, "Thermal protection of induction motors enhanced by interactive
   electrical and thermal models", IEEE Trans. Power App. Syst. PAS-103 (1984) 1749-1755.
"""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from core.thermal.course import CurrentStep

NEGATIVE_SEQUENCE = 5.0
"""Heating by negative-sequence current, over that by positive-sequence current: that of its higher rotor
resistance, as relays weigh it (SEL-701, appendix E)."""


@dataclass(frozen=True, slots=True)
class TwoBodies:
    """What describes a motor to the model.

    The defaults are usual ones of totally enclosed motors with a rise of class B; they are no motor's own.

    Parameters
    ----------
    rated_rise_K : float, default 80.0
        Rise of the winding at rated current, in the end [K].
    frame_share : float, default 0.6
        Rise of the frame over that of the winding then.
    winding_loss_share : float, default 0.45
        Losses of the stator winding over all losses at rated current.
    constant_loss_share : float, default 0.5
        Losses of the frame that do not go with the current (iron, friction), over all of the frame's.
    winding_time_constant_s : float, default 400.0
        Time constant of the winding against the frame [s].
    frame_time_constant_s : float, default 2400.0
        Time constant of the frame against the air, by itself, while the fan turns [s].
    standstill_factor : float, default 2.5
        Growth of the frame's time constant, and fall of its cooling, while the motor stands.
    """

    rated_rise_K: float = 80.0
    frame_share: float = 0.6
    winding_loss_share: float = 0.45
    constant_loss_share: float = 0.5
    winding_time_constant_s: float = 400.0
    frame_time_constant_s: float = 2400.0
    standstill_factor: float = 2.5


@dataclass(frozen=True, slots=True)
class Rises:
    """Rises above the ambient temperature.

    Parameters
    ----------
    winding_K, frame_K : float
        Of winding and frame [K].
    """

    winding_K: float = 0.0
    frame_K: float = 0.0


def after(rises: Rises, steps: Iterable[CurrentStep], motor: TwoBodies) -> Rises:
    """Return the rises after currents have flowed.

    Parameters
    ----------
    rises : Rises
        Rises before.
    steps : iterable of CurrentStep
        The currents, in their order, over the rated one.
    motor : TwoBodies
        The motor.

    Returns
    -------
    Rises
        Rises behind the last of them.
    """
    state = np.array([rises.winding_K, rises.frame_K])
    modes = {standing: _modes(motor, standing=standing) for standing in (False, True)}
    for step in steps:
        rates, vectors, back = modes[step.is_standing]
        end = _end(motor, step)
        state = end + vectors @ (np.exp(rates * step.duration_s) * (back @ (state - end)))
    return Rises(float(state[0]), float(state[1]))


def _conductances(motor: TwoBodies, *, standing: bool) -> tuple[float, float]:
    """Return G and H, over the losses at rated current [1/K]."""
    frame_K = motor.frame_share * motor.rated_rise_K
    inner = motor.winding_loss_share / (motor.rated_rise_K - frame_K)
    outer = 1.0 / frame_K
    return inner, outer / motor.standstill_factor if standing else outer


def _modes(
    motor: TwoBodies, *, standing: bool
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Return rates of decay, the vectors that decay with them, and the way back from the rises to these."""
    inner, running = _conductances(motor, standing=False)
    outer = _conductances(motor, standing=standing)[1]
    winding, frame = inner * motor.winding_time_constant_s, running * motor.frame_time_constant_s
    rates, vectors = np.linalg.eig(
        np.array([[-inner / winding, inner / winding], [inner / frame, -(inner + outer) / frame]])
    )
    return rates, vectors, np.linalg.inv(vectors)


def _end(motor: TwoBodies, step: CurrentStep) -> NDArray[np.float64]:
    """Return the rises that these currents lead to in the end."""
    if step.is_standing:
        return np.zeros(2)
    heating = step.positive**2 + NEGATIVE_SEQUENCE * step.negative**2
    in_winding = motor.winding_loss_share * heating
    constant = motor.constant_loss_share
    in_frame = (1.0 - motor.winding_loss_share) * (constant + (1.0 - constant) * heating)
    inner, outer = _conductances(motor, standing=False)
    frame_K = (in_winding + in_frame) / outer
    return np.array([frame_K + in_winding / inner, frame_K])
