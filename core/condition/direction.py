"""A motor's records in one direction of rotation: its standing errors, and what changes."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, cast

import numpy as np

from core.condition.assessment import Assessment, Level, Reference
from core.condition.bus import Neighbour, StandingEstimate, common_asymmetry
from core.condition.differences import BusDifferences, Pair
from core.condition.events import Event, EventKind
from core.condition.kalman import TEMPERATURE, WANDER_EC, learn_noise, predict, update
from core.condition.measurement import Measurement, measure, negative_impedance
from core.condition.observation import Observation, VoltageChannels
from core.condition.prior import IMPEDANCE, prior_of
from core.condition.signatures import terminal_turn
from core.condition.standing import STANDING_SCORE, standing_of, without_prior
from core.condition.start import NOISE_STEPS, in_order, starting_noise
from core.condition.state import FILTER, START, FilterState
from core.machines.base import Array
from core.machines.parameters import Motor
from core.machines.winding_frame import terminal_winding
from core.signals.sequence import PhaseSequence

UNCONFIRMED = 30.0
"""Chi-square of 2 above which a record has to be confirmed by another: one in three million."""
NANOSECONDS = 1e-9


@dataclass(slots=True)
class Header:
    """What a state tells in words and whole numbers.

    Parameters
    ----------
    recorder : str
        What measured the latest record.
    voltage_channels : VoltageChannels
        Which voltages it measured.
    as_of_ns, since_ns : int
        Time of the latest record, and of the first since the reference began, UTC [ns].
    accepted : bool
        Whether a person has declared the standing asymmetry healthy.
    bus : BusDifferences
        Differences from the bus's other motors.
    start : list of Measurement
        The first records of a reference, until there are eight.
    """

    recorder: str = ""
    voltage_channels: VoltageChannels = VoltageChannels.PHASE
    as_of_ns: int = 0
    since_ns: int = 0
    accepted: bool = False
    bus: BusDifferences = field(default_factory=BusDifferences)
    start: list[Measurement] = field(default_factory=list)


class Direction:
    """A motor's records in one direction of rotation.

    Parameters
    ----------
    motor : Motor
        The motor.
    sequence : PhaseSequence
        Order of the supply's phases at the terminals.
    """

    def __init__(self, motor: Motor, sequence: PhaseSequence) -> None:
        self._sequence = sequence
        self._header = Header()
        self._filter = np.zeros(1, FILTER).view(np.recarray)
        self._state = cast(FilterState, self._filter[0])
        self._prior = prior_of(motor)
        self._restart(keep_impedance=False)

    @property
    def as_of_ns(self) -> int:
        """Time of the latest record, UTC [ns]."""
        return self._header.as_of_ns

    def fold(self, motor: Motor, observation: Observation, neighbours: Sequence[Neighbour]) -> None:
        """Take one record in.

        Parameters
        ----------
        motor : Motor
            The motor as it is.
        observation : Observation
            The record.
        neighbours : sequence of Neighbour
            What other motors of the bus saw.

        Raises
        ------
        ValueError
            If a number is missing or infinite, or the motor was not running.
        """
        header = self._header
        elapsed_s = max(observation.time_ns - header.as_of_ns, 0) * NANOSECONDS if header.recorder else 0.0
        record = measure(observation, motor, self._prior.scale_ohm, elapsed_s)
        moved, _ = header.bus.fold(record.v2, self._sequence, neighbours)
        if moved is not None:
            record = record._replace(bus=moved, has_bus=True)
        measures = (observation.recorder, observation.voltage_channels)
        if header.recorder and measures != (header.recorder, header.voltage_channels):
            self._restart(keep_impedance=True)
        header.recorder, header.voltage_channels = measures
        header.as_of_ns = observation.time_ns
        state = self._state
        if state.records < START:
            if not header.start:
                header.since_ns = observation.time_ns
            self._begin(record)
        else:
            predict(state, record.elapsed_s)
            update(state, record.y, record.j1, record.j2)
            learn_noise(state)
            state.records += 1.0

    def apply(self, event: Event, motor: Motor, edited: Motor) -> None:
        """Let something be known that happened between two records.

        Parameters
        ----------
        event : Event
            What happened.
        motor, edited : Motor
            The motor before and after it.
        """
        if event.kind is EventKind.PARAMETERS_EDITED:
            f = motor.nameplate.rated_frequency_Hz
            shift = negative_impedance(motor.parameters, f) - negative_impedance(edited.parameters, f)
            self._state.x[4] += shift.real / self._prior.scale_ohm
            self._state.x[5] += shift.imag / self._prior.scale_ohm
        elif event.kind in (EventKind.RECORDER_CHANGED, EventKind.MAINTENANCE):
            self._restart(keep_impedance=True)
        elif event.kind is EventKind.REFERENCE_RESTARTED:
            self._restart(keep_impedance=True)
            self._header.accepted = True

    def assessment(self, motor: Motor, bus: Sequence[StandingEstimate]) -> Assessment:
        """Return what the records so far tell.

        Parameters
        ----------
        motor : Motor
            The motor as it is.
        bus : sequence of StandingEstimate
            Standing asymmetries of the other motors of the bus.

        Returns
        -------
        Assessment
            What is seen.
        """
        state, header = self._state, self._header
        own = self.standing_estimate(motor)
        common = common_asymmetry(own, bus)
        if common is None:
            estimate, covariance = without_prior(state.x[:2], state.P[:2, :2], self._prior_of_E())
            standing = standing_of(motor, estimate, covariance)
        else:
            turn = terminal_turn(motor)
            standing = standing_of(
                motor, _turned(own.asymmetry - common[0], turn), own.covariance + common[1]
            )
        records = int(state.records)
        winding = terminal_winding(standing.winding, self._sequence, motor.nameplate.connection)
        return Assessment(
            as_of_ns=header.as_of_ns,
            reference=Reference(
                records=records,
                complete=records > START,
                since_ns=header.since_ns,
                detectable=None,
                standing=Level(standing.level, standing.deviation, winding, standing.path_ratio),
                standing_score=standing.score,
                from_bus=common is not None,
            ),
            change=None,
            standing_fault=standing.score >= STANDING_SCORE and not header.accepted,
            statistic=0.0,
            threshold=16.0,
            unconfirmed=records > START and bool(state.surprise > UNCONFIRMED),
        )

    def standing_estimate(self, motor: Motor) -> StandingEstimate:
        """Return the standing asymmetry for the comparison on a bus.

        Parameters
        ----------
        motor : Motor
            The motor as it is.

        Returns
        -------
        StandingEstimate
            Asymmetry at the terminals.
        """
        state = self._state
        prior = self._prior_of_E()
        estimate, covariance = without_prior(state.x[:2], state.P[:2, :2], prior)
        own = np.eye(2) * self._prior.own_voltage**2
        difference, others = self._header.bus.mean()
        asymmetry = _turned(estimate, 1.0 / terminal_turn(motor)) - np.array(
            [difference.real, difference.imag]
        )
        return StandingEstimate(
            motor=motor.name,
            sequence=self._sequence,
            asymmetry=asymmetry,
            covariance=covariance - prior + own,
            channel_variance=self._prior.voltage**2 - self._prior.own_voltage**2,
            others=others,
        )

    def packed(self) -> tuple[dict[str, Any], bytes]:
        """Return the state as a header of text and numbers as they lie in memory.

        Returns
        -------
        header : dict of str to object
            Words and whole numbers.
        body : bytes
            Numbers.
        """
        header = self._header
        words = {
            "recorder": header.recorder,
            "voltage_channels": str(header.voltage_channels),
            "as_of_ns": header.as_of_ns,
            "since_ns": header.since_ns,
            "accepted": header.accepted,
            "scale_ohm": self._prior.scale_ohm,
            "moved": [header.bus.moved.real, header.bus.moved.imag],
            "pairs": {n: [p.mean.real, p.mean.imag, p.records] for n, p in header.bus.pairs.items()},
            "start": [_as_list(record) for record in header.start],
        }
        return words, self._filter.tobytes()

    @classmethod
    def unpacked(
        cls, motor: Motor, sequence: PhaseSequence, words: Mapping[str, Any], body: bytes
    ) -> "Direction":
        """Return the state that was packed.

        Parameters
        ----------
        motor : Motor
            The motor.
        sequence : PhaseSequence
            Order of the supply's phases at the terminals.
        words : mapping
            Header of `packed`.
        body : bytes
            Body of `packed`.

        Returns
        -------
        Direction
            The same state.

        Raises
        ------
        ValueError
            If the body is of another length.
        """
        direction = cls(motor, sequence)
        if len(body) != FILTER.itemsize:
            raise ValueError("the saved state has another layout: fold the records again")
        direction._filter[0] = np.frombuffer(body, FILTER)[0]
        direction._header = Header(
            recorder=words["recorder"],
            voltage_channels=VoltageChannels(words["voltage_channels"]),
            as_of_ns=words["as_of_ns"],
            since_ns=words["since_ns"],
            accepted=words["accepted"],
            bus=BusDifferences(
                {n: Pair(complex(re, im), count) for n, (re, im, count) in words["pairs"].items()},
                complex(*words["moved"]),
            ),
            start=[_from_list(values) for values in words["start"]],
        )
        return direction

    def _restart(self, keep_impedance: bool) -> None:
        """Let the reference be learnt anew."""
        state, prior = self._state, self._prior
        errors = np.array([prior.voltage] * 2 + [prior.current] * 2 + [IMPEDANCE] * 2 + [TEMPERATURE]) ** 2
        x, P = np.zeros(7), np.diag(errors)
        if keep_impedance:
            x[4:] = state.x[4:]
            P[4:, 4:] = state.P[4:, 4:]
        state.x[:], state.P[:] = x, P
        state.x0[:], state.P0[:] = x, P
        state.current_deviation = prior.current
        state.records = 0.0
        self._header.start.clear()
        self._header.accepted = False

    def _begin(self, record: Measurement) -> None:
        """Fold the first records in their order of ordinariness, with the noise that makes them likeliest."""
        start = self._header.start
        start.append(record)
        records = in_order(start)
        noise = starting_noise(records)
        tried = [(self._fold_start(records, noise * step), -k) for k, step in enumerate(NOISE_STEPS)]
        self._fold_start(records, noise * NOISE_STEPS[-max(tried)[1]])
        if len(start) == START:
            start.clear()

    def _fold_start(self, records: Sequence[Measurement], s2: float) -> float:
        state = self._state
        state.x[:], state.P[:] = state.x0, state.P0
        state.records, state.s2 = 0.0, s2
        total = 0.0
        for record in records:
            predict(state, record.elapsed_s)
            update(state, record.y, record.j1, record.j2)
            state.records += 1.0
            total += state.log_likelihood
        return total

    def _prior_of_E(self) -> Array:
        wandered = WANDER_EC**2 * self._state.records
        return np.eye(2) * (self._prior.voltage**2 + wandered)


def _turned(vector: Array, factor: complex) -> Array:
    """Multiply a complex number given by its parts."""
    value = complex(vector[0], vector[1]) * factor
    return np.array([value.real, value.imag])


def _as_list(record: Measurement) -> list[float | bool]:
    values: list[float | bool] = []
    for value in record:
        values.extend((value.real, value.imag) if isinstance(value, complex) else (value,))
    return values


def _from_list(values: Sequence[float]) -> Measurement:
    elapsed_s, *parts = values
    complexes = [complex(parts[2 * k], parts[2 * k + 1]) for k in range(8)]
    scatter, has_v0, has_bus = parts[16:]
    y, j1, j2, v2, v0, i0, i2, bus = complexes
    return Measurement(elapsed_s, y, j1, j2, v2, v0, i0, i2, bus, scatter, bool(has_v0), bool(has_bus))
