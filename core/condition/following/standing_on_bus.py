"""What stands, judged with the other motors of the bus where there are any."""

from collections.abc import Sequence

import numpy as np

from core.condition.bus.neighbours import CommonAsymmetry, StandingEstimate
from core.condition.complex_parts import rotated, symmetric, turned
from core.condition.filter.prior import Prior
from core.condition.following.expectations import Expectations
from core.condition.following.standing import Called, Standing, standing_of
from core.condition.following.standing_errors import StandingErrors
from core.diagnosis.channel_errors import terminal_turn
from core.machines.parameters import Motor
from core.signals.sequence import PhaseSequence


class StandingOnBus:
    """A motor's standing errors, compared with those of the other motors of its bus.

    Parameters
    ----------
    sequence : PhaseSequence
        Order of the supply's phases at the terminals.
    """

    def __init__(self, sequence: PhaseSequence) -> None:
        self._sequence = sequence
        self._common = CommonAsymmetry()

    def estimate(self, motor: Motor, prior: Prior, errors: StandingErrors) -> StandingEstimate:
        """Return the standing asymmetry for the comparison.

        Parameters
        ----------
        motor : Motor
            The motor as it is.
        prior : Prior
            Spread of the standing errors before the first record.
        errors : StandingErrors
            The standing errors.

        Returns
        -------
        StandingEstimate
            Asymmetry at the terminals.
        """
        turn = 1.0 / terminal_turn(motor)
        difference = np.array([errors.difference_real, errors.difference_imaginary])
        noise = symmetric(errors.spread) - symmetric(errors.prior)
        return StandingEstimate(
            motor=motor.name,
            sequence=self._sequence,
            asymmetry=turned(np.array([errors.real, errors.imaginary]), turn) - difference,
            covariance=rotated(noise + prior.own, turn),
            channels=rotated(prior.channels, turn),
            others=errors.others,
            transformers=errors.transformers,
        )

    def told(
        self, motor: Motor, expected: Expectations, errors: StandingErrors, called: Called | None,
        bus: Sequence[StandingEstimate],
    ) -> Standing:  # fmt: skip
        """Return what stands, and of a standing fault that was called what told it surest.

        It is called no more where all of the interval now lies below the motor's limit.

        Parameters
        ----------
        motor : Motor
            The motor as it is.
        expected : Expectations
            What the motor's file tells of its records.
        errors : StandingErrors
            The standing errors now.
        called : Called or None
            The standing fault that was called.
        bus : sequence of StandingEstimate
            Standing asymmetries of the other motors.

        Returns
        -------
        Standing
            The likeliest shorted turns.
        """
        now = self._judged(motor, expected, errors, bus)
        if called is None or now.interval[1] <= motor.limits.fault_level:
            return now
        surest = self._judged(motor, expected, called.errors, bus)
        return max(now, surest, key=lambda standing: standing.score)

    def _judged(
        self, motor: Motor, expected: Expectations, errors: StandingErrors, bus: Sequence[StandingEstimate]
    ) -> Standing:
        own = self.estimate(motor, expected.prior, errors) if bus else None
        common = self._common.of(own, bus) if own else None
        if own is None or common is None:
            asymmetry = np.array([errors.real, errors.imaginary])
            return standing_of(expected.rough, asymmetry, symmetric(errors.spread), from_bus=False)
        asymmetry = turned(own.asymmetry - common[0], terminal_turn(motor))
        covariance = rotated(own.covariance + common[1], terminal_turn(motor))
        return standing_of(expected.rough, asymmetry, covariance, from_bus=True)
