"""Following a motor: records and events go in one by one, and the state so far can be assessed and saved."""

from collections.abc import Sequence
from typing import Final

from core.condition.assessment import Assessment
from core.condition.bus.neighbours import Neighbour, StandingEstimate
from core.condition.events import ENDING, Event, EventKind
from core.condition.following.direction import Direction
from core.condition.following.reference import begun
from core.condition.following.saving import pack, unpack
from core.condition.kinds import State
from core.condition.observation import Observation
from core.condition.severity import level_in_all, of_one_fault, state_of
from core.machines.parameters import Motor
from core.signals.sequence import PhaseSequence

MOST_REFERENCES: Final = 4
"""Most references of a motor: two relays of a motor that turns both ways."""
SEVERITY: Final = (State.HEALTHY, State.WATCH, State.FAULT)


class Follower:
    """A motor over its records.

    The state is a function of the motor, of the observations and the events in their order of time: it has
    the same bits whether they come at once, one by one, or with the follower saved and restored in between.
    A record that comes late makes the caller restore an earlier state and fold from there.

    Standing errors are others where the motor turns the other way or another recorder measures it: each
    direction of rotation and each recorder has its own reference. What one of them tells is not taken back by
    the records of another.

    Parameters
    ----------
    motor : Motor
        The motor.
    """

    def __init__(self, motor: Motor) -> None:
        self._motor = motor
        self._directions: list[Direction] = []
        """In the order of their latest records."""
        self._ended_by: Event | None = None

    @property
    def motor(self) -> Motor:
        """The motor as it is now."""
        return self._motor

    @property
    def as_of_ns(self) -> int | None:
        """Time of the latest record, UTC [ns]; None before the first."""
        return self._directions[-1].as_of_ns if self._directions else None

    @property
    def ended_by(self) -> Event | None:
        """The latest event that ended the reference; None where there is a record since then."""
        return self._ended_by

    def fold(self, observation: Observation, neighbours: Sequence[Neighbour] = ()) -> None:
        """Take one record in.

        Parameters
        ----------
        observation : Observation
            The record; it is not earlier than the one before.
        neighbours : sequence of Neighbour, optional
            What other motors of the bus saw within a minute.

        Raises
        ------
        ObservationError
            If a number is missing, infinite or impossible, or the motor was not running. The state stays as
            it was.
        ValueError
            If the record is earlier than the one before. The state stays as it was.
        """
        before = self.as_of_ns
        if before is not None and observation.time_ns < before:
            raise ValueError(
                f"time_ns is {observation.time_ns}, before the latest record ({before}): restore an earlier"
                " state and fold from there"
            )
        known = next((one for one in self._directions if one.is_of(observation)), None)
        direction = self._begun(observation.sequence) if known is None else known
        direction.fold(self._motor, observation, neighbours)
        self._ended_by = None
        self._directions = [*(one for one in self._directions if one is not known), direction]
        if len(self._directions) > MOST_REFERENCES:
            self._drop_one()

    def apply(self, event: Event, motor: Motor | None = None) -> None:
        """Let something be known that happened between two records.

        Parameters
        ----------
        event : Event
            What happened.
        motor : Motor or None, optional
            The motor as it is from then on; None where its file stays as it was.
        """
        edited = self._motor if motor is None else motor
        if event.kind in ENDING:
            self._ended_by = event
        if event.kind is EventKind.REWOUND:
            self._directions.clear()
        for direction in self._directions:
            direction.apply(event, self._motor, edited)
        self._motor = edited

    def assessment(self, bus: Sequence[StandingEstimate] = ()) -> Assessment | None:
        """Return what the records so far tell.

        Parameters
        ----------
        bus : sequence of StandingEstimate, optional
            Standing asymmetries of the other motors of the bus.

        Returns
        -------
        Assessment or None
            None before the first record, and before the first one after an event that ends the reference.
        """
        if not self._directions or not self._directions[-1].is_known:
            return None
        *others, latest = self._directions
        told = [latest.assessment(self._motor, bus)]
        told += [
            one.assessment(self._motor, bus).told_later(latest.as_of_ns, one.name)
            for one in others
            if one.is_complete
        ]
        return told[0] if len(told) == 1 else max(told, key=self._severity)

    def _severity(self, assessment: Assessment) -> tuple[int, float]:
        """Return how bad an assessment is; equally bad ones do not take turns from record to record."""
        limit = self._motor.limits.fault_level
        state = state_of(assessment, limit)
        if state is State.HEALTHY:
            return SEVERITY.index(state), 0.0
        if state is State.FAULT:
            return SEVERITY.index(state), level_in_all(of_one_fault(assessment, limit))[0]
        change = assessment.change
        return SEVERITY.index(state), 0.0 if change is None else 1.0 / (1.0 + change.detected_ns)

    def _begun(self, sequence: PhaseSequence) -> Direction:
        """Return a new reference; what is known of the impedance in this direction is known to it."""
        for one in reversed(self._directions):
            if one.sequence is sequence:
                return Direction(self._motor, one.state.copy())
        return Direction(self._motor, begun(self._motor, sequence))

    def _drop_one(self) -> None:
        """Drop the reference that was least recently used, of those that have nothing to tell."""
        limit = self._motor.limits.fault_level
        for one in self._directions[:-1]:
            if not one.is_complete or state_of(one.assessment(self._motor, ()), limit) is State.HEALTHY:
                self._directions.remove(one)
                return
        del self._directions[0]

    def standing_estimate(self) -> StandingEstimate | None:
        """Return the standing asymmetry for the comparison on a bus.

        Returns
        -------
        StandingEstimate or None
            None before the first record, and before the first one after an event that ends the reference.
        """
        if not self._directions or not self._directions[-1].is_known:
            return None
        return self._directions[-1].standing_estimate(self._motor)

    def save(self) -> bytes:
        """Return the whole state.

        Returns
        -------
        bytes
            What `restore` reads.
        """
        return pack([one.state for one in self._directions], self._ended_by)

    @classmethod
    def restore(cls, motor: Motor, state: bytes) -> "Follower":
        """Return the follower that was saved.

        Parameters
        ----------
        motor : Motor
            The motor as it was when the state was saved.
        state : bytes
            What `save` returned.

        Returns
        -------
        Follower
            The same follower.

        Raises
        ------
        ValueError
            If it is no state of this version: fold the records again.
        """
        follower = cls(motor)
        states, follower._ended_by = unpack(state)
        follower._directions = [Direction(motor, one) for one in states]
        return follower
