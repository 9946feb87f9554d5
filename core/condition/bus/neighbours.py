"""Motors of one bus share their supply: what one of them tells of the others' voltage channels."""

from collections.abc import Sequence
from dataclasses import dataclass
from operator import is_

import numpy as np

from core.condition.observation import Observation
from core.diagnosis.channel_errors import SIXTH
from core.machines.base import Array
from core.machines.parameters import Connection, Motor
from core.signals.sequence import PhaseSequence


@dataclass(frozen=True, slots=True)
class Neighbour:
    """What another motor of the bus saw within a minute of a record.

    Parameters
    ----------
    motor : str
        Name of the other motor.
    negative_voltage_ratio : complex
        V2/V1 of its terminals.
    sequence : PhaseSequence
        Order of the supply's phases at its terminals.
    """

    motor: str
    negative_voltage_ratio: complex
    sequence: PhaseSequence


@dataclass(frozen=True, slots=True)
class StandingEstimate:
    """Standing asymmetry of one motor of a bus, for the comparison with the others.

    Parameters
    ----------
    motor : str
        Name of the motor.
    sequence : PhaseSequence
        Order of the supply's phases at its terminals.
    asymmetry : ndarray, shape (2,)
        Real and imaginary part of E at the terminals, estimated without a prior, less what its own voltage
        channels differ from the bus's mean.
    covariance : ndarray, shape (2, 2)
        Covariance of its estimation, and of what a sound winding adds.
    channels : ndarray, shape (2, 2)
        Covariance of what its voltage channels add to E at the terminals, before the first record.
    others : int
        Number of motors it has been compared with; 0 where its channels are not judged.
    transformers : int
        Number of voltage transformers that they and this motor have.
    """

    motor: str
    sequence: PhaseSequence
    asymmetry: Array
    covariance: Array
    channels: Array
    others: int
    transformers: int


def neighbour_of(motor: Motor, observation: Observation) -> Neighbour:
    """Return what a motor's record tells the other motors of its bus.

    Parameters
    ----------
    motor : Motor
        The motor that was recorded.
    observation : Observation
        Its record.

    Returns
    -------
    Neighbour
        V2/V1 of its terminals.
    """
    back = SIXTH**2 if motor.nameplate.connection is Connection.DELTA else 1.0
    ratio = observation.negative_voltage_V / observation.positive_voltage_V
    return Neighbour(motor.name, ratio * back, observation.sequence)


def common_asymmetry(own: StandingEstimate, others: Sequence[StandingEstimate]) -> tuple[Array, Array] | None:
    """Return the asymmetry that the bus's other motors share: the mean error of all their voltage channels.

    Parameters
    ----------
    own : StandingEstimate
        The motor that is judged; it is left out of the mean.
    others : sequence of StandingEstimate
        Motors of the bus, in any order.

    Returns
    -------
    tuple of ndarray or None, shapes (2,), (2, 2)
        Mean, weighted by precision and robustly, and its covariance; None where there is nothing to compare.
    """
    taken = sorted(
        (o for o in others if o.motor != own.motor and o.others and o.sequence is own.sequence),
        key=lambda o: o.motor,
    )
    if not taken or not own.others:
        return None
    prior = own.channels / own.transformers
    weights = [np.linalg.inv(o.covariance) for o in taken]
    trust = np.ones(len(taken))
    mean, covariance = np.zeros(2), prior
    for _ in range(8):
        information = np.linalg.inv(prior) + sum(t * w for t, w in zip(trust, weights, strict=True))
        covariance = np.linalg.inv(information)
        weighted = sum(t * w @ o.asymmetry for t, w, o in zip(trust, weights, taken, strict=True))
        mean = covariance @ weighted
        for i, (w, o) in enumerate(zip(weights, taken, strict=True)):
            distance = float(np.sqrt((o.asymmetry - mean) @ w @ (o.asymmetry - mean)))
            trust[i] = min(1.0, HUBER / max(distance, 1e-12))
    return mean, covariance


class CommonAsymmetry:
    """What the other motors of a bus share, computed anew only where it may have become another.

    A motor's records come one by one, and between two of them the others' estimates mostly stay as they are.
    """

    def __init__(self) -> None:
        self._own: tuple[object, ...] = ()
        self._others: tuple[StandingEstimate, ...] = ()
        self._found: tuple[Array, Array] | None = None

    def of(self, own: StandingEstimate, others: Sequence[StandingEstimate]) -> tuple[Array, Array] | None:
        """Return what `common_asymmetry` returns.

        Parameters
        ----------
        own : StandingEstimate
            The motor that is judged.
        others : sequence of StandingEstimate
            Motors of the bus.

        Returns
        -------
        tuple of ndarray or None, shapes (2,), (2, 2)
            Mean and covariance; None where there is nothing to compare.
        """
        of_own = (own.motor, own.sequence, own.others > 0, own.transformers, own.channels.tobytes())
        are_same = len(others) == len(self._others) and all(map(is_, others, self._others))
        if of_own != self._own or not are_same:
            self._own, self._others = of_own, tuple(others)
            self._found = common_asymmetry(own, others)
        return self._found


HUBER = 1.5
"""Standard deviations beyond which a motor's weight falls: a faulty neighbour must not bend the mean."""
