"""Following a motor: records and events go in one by one, and the state so far can be assessed and saved."""

from collections.abc import Sequence

from core.condition.assessment import Assessment
from core.condition.bus.neighbours import Neighbour, StandingEstimate
from core.condition.events import Event, EventKind
from core.condition.following.direction import Direction
from core.condition.following.saving import pack, unpack
from core.condition.observation import Observation
from core.machines.parameters import Motor
from core.signals.sequence import PhaseSequence


class Follower:
    """A motor over its records.

    The state is a function of the motor, of the observations and the events in their order of time: it has
    the same bits whether they come at once, one by one, or with the follower saved and restored in between.
    A record that comes late makes the caller restore an earlier state and fold from there.

    Standing errors of a motor that turns the other way are others: each direction has its own reference.

    Parameters
    ----------
    motor : Motor
        The motor.
    """

    def __init__(self, motor: Motor) -> None:
        self._motor = motor
        self._directions: dict[PhaseSequence, Direction] = {}
        self._latest: PhaseSequence | None = None

    @property
    def motor(self) -> Motor:
        """The motor as it is now."""
        return self._motor

    @property
    def as_of_ns(self) -> int | None:
        """Time of the latest record, UTC [ns]; None before the first."""
        return None if self._latest is None else self._directions[self._latest].as_of_ns

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
        direction = self._directions.get(observation.sequence)
        if direction is None:
            direction = Direction(self._motor, observation.sequence)
        direction.fold(self._motor, observation, neighbours)
        self._directions[observation.sequence] = direction
        self._latest = observation.sequence

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
        if event.kind is EventKind.REWOUND:
            self._directions.clear()
            self._latest = None
        for direction in self._directions.values():
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
        if self._latest is None or not self._directions[self._latest].records:
            return None
        latest = self._directions[self._latest].assessment(self._motor, bus)
        # A fault seen while the motor turned the other way stays one.
        for sequence, direction in self._directions.items():
            seen = bool(latest.change or latest.standing_fault)
            if sequence is not self._latest and direction.records and not seen:
                other = direction.assessment(self._motor, bus)
                if other.change or other.standing_fault:
                    return other.seen_at(latest.as_of_ns)
        return latest

    def standing_estimate(self) -> StandingEstimate | None:
        """Return the standing asymmetry for the comparison on a bus.

        Returns
        -------
        StandingEstimate or None
            None before the first record, and before the first one after an event that ends the reference.
        """
        if self._latest is None or not self._directions[self._latest].records:
            return None
        return self._directions[self._latest].standing_estimate(self._motor)

    def save(self) -> bytes:
        """Return the whole state.

        Returns
        -------
        bytes
            What `restore` reads.
        """
        return pack(self._latest, self._directions)

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
        follower._latest, follower._directions = unpack(motor, state)
        return follower
