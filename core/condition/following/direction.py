"""A motor's records in one direction of rotation: its standing errors, and what changes."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import sqrt
from typing import Any, cast

import numpy as np

from core.condition.assessment import Assessment, Change, Declared, Level, Reference
from core.condition.bus.differences import COMMON_RECORDS
from core.condition.bus.neighbours import CommonAsymmetry, Neighbour, StandingEstimate
from core.condition.changes.alarm import Alarm, Weighing, confirm, taken_up, weigh
from core.condition.changes.before_change import before_change
from core.condition.changes.change import change_of, continued
from core.condition.changes.detectability import detectable
from core.condition.changes.hypotheses import Hypotheses, hypotheses_of
from core.condition.changes.turns_level import TurnsLevel, turns_level
from core.condition.changes.vanishing import Vanishing
from core.condition.complex_parts import rotated, symmetric, turned
from core.condition.events import Event, EventKind
from core.condition.filter.impedance import impedance_alone, move_impedance
from core.condition.filter.kalman import TEMPERATURE
from core.condition.filter.prior import IMPEDANCE, prior_of
from core.condition.filter.state import (
    BUS,
    CANDIDATE,
    CANDIDATES,
    FILTER,
    RECENT,
    RECENT_RECORD,
    SIDE,
    SIDES,
    START,
    FilterState,
)
from core.condition.following.folding import fold_record, restart
from core.condition.following.header import Header
from core.condition.following.standing import (
    LOOKED_AT,
    STANDING_SCORE,
    SUSPECTED,
    USUAL_SCORE,
    Standing,
    StandingErrors,
    held,
    of_records,
    score_of,
    standing_of,
    surest,
)
from core.condition.following.start import fold_start
from core.condition.kinds import Kind
from core.condition.measuring.measurement import Measurement, measure, negative_impedance
from core.condition.measuring.signatures import terminal_turn
from core.condition.observation import Observation
from core.condition.severity import is_shorted_turns, level_in_all, level_of, of_one_fault, stands_out
from core.machines.parameters import Motor
from core.machines.winding_frame import terminal_winding
from core.signals.sequence import PhaseSequence

UNCONFIRMED = 30.0
"""Chi-square of 2 above which a record has to be confirmed by another: one in three million."""
SAME, MOST_SAME = 0.05, 0.2
"""Shares of what channels of their class differ by, below which two motors have one voltage transformer: at
least, and at most where the differences are noisy."""
CLEARED = 3.0
"""Log of the detector's statistic below which a change has gone again."""
NANOSECONDS = 1e-9


class Direction:
    """A motor's records in one direction of rotation, measured by one recorder.

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
        self._filter: Any = np.zeros(1, FILTER)
        # The same memory: attributes are easier to read, a number is read faster by its name.
        self._state = cast(FilterState, self._filter.view(np.recarray)[0])
        self._figures: Any = self._filter[0]
        self._bank: Any = np.zeros(CANDIDATES, CANDIDATE)
        self._sides: Any = np.zeros(SIDES, SIDE)
        self._recent: Any = np.zeros(RECENT, RECENT_RECORD)
        rated = negative_impedance(motor.parameters, motor.nameplate.rated_frequency_Hz)
        self._header.scale_ohm = abs(rated)
        self._nominal = rated / abs(rated)
        self._common = CommonAsymmetry()
        self._weighed: Weighing | None = None
        self._turns_level: TurnsLevel | None = None
        self._see(motor)
        self._restart(keep_impedance=False)

    @property
    def sequence(self) -> PhaseSequence:
        """Order of the supply's phases at the terminals."""
        return self._sequence

    @property
    def name(self) -> str:
        """What measures the records, and the direction of rotation."""
        return f"{self._header.recorder} ({self._sequence})"

    def is_of(self, observation: Observation) -> bool:
        """Return whether a record belongs to this reference.

        Parameters
        ----------
        observation : Observation
            The record.

        Returns
        -------
        bool
            Whether its recorder, its voltages and its direction are the same.
        """
        return observation.sequence is self._sequence and not self._header.measured_by(observation)

    @property
    def is_complete(self) -> bool:
        """Whether changes are looked for, or one is told from before the reference."""
        return bool(self._figures["records"] > START or self._header.kept is not None)

    @property
    def records(self) -> int:
        """Number of records that the reference rests on; none right after an event that ends it."""
        return int(self._figures["records"])

    @property
    def is_known(self) -> bool:
        """Whether anything can be said: there are records, or a change from before them."""
        return bool(self._figures["records"] > 0.0) or self._header.kept is not None

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
        ObservationError
            If a number is missing, infinite or impossible, or the motor was not running.
        """
        header = self._header
        elapsed_s = max(observation.time_ns - header.as_of_ns, 0) * NANOSECONDS if header.recorder else 0.0
        record = measure(observation, motor, self._header.scale_ohm, elapsed_s)
        self._forget_weights()
        if neighbours:
            moved = header.bus.fold(record.v2, self._sequence, neighbours, self._same_transformer())
            if moved is not None:
                record = record._replace(bus=moved, has_bus=True)
        if header.measured_by(observation):
            known = bool(header.recorder)
            header.recorder, header.voltage_channels = observation.recorder, observation.voltage_channels
            self._see(motor)
            self._restart(keep_impedance=known)
        header.as_of_ns = observation.time_ns
        if self._figures["records"] < START:
            if not header.start:
                header.since_ns = observation.time_ns
            header.start.append(record)
            fold_start(self._filter, self._sides, header.start)
            if len(header.start) == START:
                header.start.clear()
            return
        alarm = header.alarm
        hypotheses = self._see(motor)
        fold_record(
            self._filter, self._bank, self._sides, self._recent, hypotheses, self._recorder,
            record, observation.time_ns, alarm is not None,
        )  # fmt: skip
        if alarm is None and self._figures["statistic"] >= self._figures["threshold"]:
            alarm = header.alarm = Alarm(observation.time_ns)
            header.standing = header.standing or self._errors()
            if score_of(motor, header.standing) < USUAL_SCORE:
                header.called = None  # it was the beginning of this change
        if alarm is not None:
            self._follow_up(alarm, motor, record)
        elif self._figures["records"] % LOOKED_AT == 0.0:
            self._look_at_standing(motor)

    def apply(self, event: Event, motor: Motor, edited: Motor) -> None:
        """Let something be known that happened between two records.

        Parameters
        ----------
        event : Event
            What happened.
        motor, edited : Motor
            The motor before and after it.
        """
        self._forget_weights()
        if event.kind is EventKind.PARAMETERS_EDITED:
            self._move_impedance(motor, edited)
        elif event.kind is EventKind.RECORDER_CHANGED:
            self._restart(keep_impedance=True)
        elif event.kind is EventKind.MAINTENANCE:
            self._maintain()
        elif event.kind is EventKind.REFERENCE_RESTARTED:
            declared = self._shown(motor)
            self._restart(keep_impedance=True)
            self._header.accepted, self._header.declared = True, declared

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
        header, figures = self._header, self._figures
        standing = self._told_standing(motor, bus)
        records, alarm = int(figures["records"]), header.alarm
        connection = motor.nameplate.connection
        winding = terminal_winding(standing.winding, self._sequence, connection)
        change, levels = (header.gone or header.kept, ()) if alarm is None else self._told(alarm, motor)
        return Assessment(
            as_of_ns=header.as_of_ns,
            reference=Reference(
                records=records,
                complete=self.is_complete,
                since_ns=header.since_ns,
                detectable=self._detectable(records),
                standing=Level(
                    standing.level, standing.deviation, winding, standing.path_ratio, standing.interval
                ),
                standing_score=standing.score,
                from_bus=standing.from_bus,
                accepted=header.accepted,
                declared=header.declared,
            ),
            change=change,
            standing_fault=standing.score >= STANDING_SCORE and not header.accepted,
            statistic=float(figures["statistic"]),
            threshold=float(figures["threshold"]),
            levels=levels,
            unconfirmed=records > START and bool(figures["surprise"] > UNCONFIRMED),
            called_above=0.0 if header.called is None else header.called.above,
            held_score=0.0 if standing.from_bus else held(standing.score, header.held_score),
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
        return self._estimate(motor, self._header.standing or self._errors())

    def _estimate(self, motor: Motor, errors: StandingErrors) -> StandingEstimate:
        turn = 1.0 / terminal_turn(motor)
        difference = np.array([errors.difference_real, errors.difference_imaginary])
        noise = symmetric(errors.spread) - symmetric(errors.prior)
        return StandingEstimate(
            motor=motor.name,
            sequence=self._sequence,
            asymmetry=turned(np.array([errors.real, errors.imaginary]), turn) - difference,
            covariance=rotated(noise + self._prior.own, turn),
            channels=rotated(self._prior.channels, turn),
            others=errors.others,
            transformers=errors.transformers,
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
        arrays = (self._filter, self._sides, self._bank, self._recent)
        return self._header.as_dict(), b"".join(array.tobytes() for array in arrays)

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
        arrays = (direction._filter, direction._sides, direction._bank, direction._recent)
        if len(body) != sum(array.nbytes for array in arrays):
            raise ValueError("the saved state has another layout: fold the records again")
        start = 0
        for array in arrays:
            array[:] = np.frombuffer(body, array.dtype, count=array.size, offset=start)
            start += array.nbytes
        direction._header = Header.from_dict(words)
        direction._nominal = complex(direction._state.nominal)
        direction._see(motor)
        return direction

    def _see(self, motor: Motor) -> Hypotheses:
        """Return what changes of the motor look like."""
        seen = (motor, self._header.voltage_channels)
        if getattr(self, "_seen", None) != seen:
            self._seen = seen
            self._prior = prior_of(*seen)
            self._hypotheses = hypotheses_of(*seen, self._header.scale_ohm)
            self._voltage = self._prior.voltage
            self._usual_channel = float(np.sqrt(2.0 * np.trace(self._prior.channels)))
            voltage = float(np.sqrt(np.trace(self._voltage)))
            self._recorder = np.array([voltage] * 2 + [np.sqrt(2.0) * self._prior.current] * 2)
        return self._hypotheses

    def _weighing(self) -> Weighing:
        """Return the weights after the latest record, which are computed once."""
        if self._weighed is None:
            self._weighed = weigh(self._filter, self._bank, self._hypotheses, self._recorder)
        return self._weighed

    def _level(self, alarm: Alarm) -> TurnsLevel:
        """Return the level after the latest record, which is computed once."""
        if self._turns_level is None:
            self._turns_level = turns_level(
                self._filter,
                self._bank,
                self._recent,
                self._hypotheses,
                self._weighing(),
                final=alarm.is_final,
            )  # fmt: skip
        return self._turns_level

    def _forget_weights(self) -> None:
        """Let weights and level be computed anew: the state or the motor is another."""
        self._weighed = None
        self._turns_level = None

    def _follow_up(self, alarm: Alarm, motor: Motor, record: Measurement) -> None:
        alarm.records += 1
        if alarm.vanishing is not None:
            alarm.vanishing.look(self._state, record.y, record.j1, self._header.as_of_ns)
            if alarm.vanishing.is_certain:
                self._vanish(alarm.vanishing)
                return
        if alarm.is_to_be_weighed:
            confirm(alarm, self._weighing())
        if alarm.may_be_called:
            change = self._change(alarm, motor)[0]
            if is_shorted_turns(change):
                alarm.surely_above = max(alarm.surely_above, change.level.ci95[0])
            self._keep_what_is_shown(alarm, change)
        if self._figures["statistic"] < CLEARED:
            self._close_alarm()
        elif alarm.is_to_be_lived_with:
            self._live_with(alarm, motor)

    def _live_with(self, alarm: Alarm, motor: Motor) -> None:
        """Learn a reference with the change, so that another one is seen; the change stays told."""
        header = self._header
        kept, gone = self._change(alarm, motor)[0], header.gone
        standing, called = header.standing, header.called
        # The impedance has taken up some of the change.
        taken, spread = taken_up(self._weighing(), self._bank, self._hypotheses)
        self._state.x -= taken
        self._state.P += spread
        self._restart(keep_impedance=Kind.PARAMETERS not in alarm.named)
        header.kept, header.gone, header.standing, header.called = kept, gone, standing, called

    def _keep_what_is_shown(self, alarm: Alarm, change: Change) -> None:
        """Keep what shorted turns show, so that it is seen when they show it no more."""
        if alarm.vanishing is not None and alarm.vanishing.is_open:
            return
        shown = is_shorted_turns(change) and change.level.ci95[0] > 0.0
        level = self._level(alarm)
        alarm.vanishing = (
            Vanishing.of(change, level.shown, level.reference, self._header.as_of_ns) if shown else None
        )

    def _vanish(self, vanishing: Vanishing) -> None:
        """Go back to the reference of before shorted turns that have vanished; that they were there is told.

        Shorted turns do not heal: they were repaired, or a contact comes and goes.
        """
        self._header.gone = replace(vanishing.change, until_ns=vanishing.last_ns)
        self._take_back()

    def _shown(self, motor: Motor) -> Declared | None:
        """Return the shorted turns that the records show; None where there are none."""
        if not self.is_known:
            return self._header.declared
        limit = motor.limits.fault_level
        found = of_one_fault(self.assessment(motor, ()), limit)
        level, interval = level_in_all(found)
        changed = level_of(found.change)
        if found.standing_fault or (changed is None and stands_out(found, limit)):
            return Declared(level, interval, found.reference.standing.phase)
        return None if changed is None else Declared(level, interval, changed.phase)

    def _maintain(self) -> None:
        """Close a change; one that may be shorted turns is looked for again: few works mend a winding.

        Against the reference of before it the next records show within a few whether it is still there. Any
        other change may have been mended where it was learnt, so that the channels are learnt anew.
        """
        alarm = self._header.alarm
        if alarm is None or Kind.SHORTED_TURNS not in alarm.named:
            self._restart(keep_impedance=True)
            return
        self._take_back()

    def _take_back(self) -> None:
        """Go back to the reference as it was before the change."""
        state = self._state
        state.x[:], state.P[:] = before_change(state, self._bank)
        state.recent, state.block = 0.0, 1.0
        self._close_alarm()

    def _close_alarm(self) -> None:
        """Look for changes of the same reference again."""
        header = self._header
        header.alarm = None
        header.standing = None if header.kept is None else header.standing
        self._state.candidates = 0.0

    def _change(self, alarm: Alarm, motor: Motor) -> tuple[Change, tuple[tuple[int, float], ...]]:
        level = self._level(alarm)
        change = change_of(
            alarm, self._weighing(), level, self._hypotheses, self._filter, self._bank,
            motor.nameplate.connection, self._sequence, self._header.voltage_channels,
        )  # fmt: skip
        return continued(change, self._header.kept), level.levels

    def _told(self, alarm: Alarm, motor: Motor) -> tuple[Change, tuple[tuple[int, float], ...]]:
        """Return the change and its levels; shorted turns are told until they have vanished for certain."""
        change, levels = self._change(alarm, motor)
        vanishing = alarm.vanishing
        if vanishing is None or not vanishing.is_open:
            return change, levels
        return vanishing.change, tuple(one for one in levels if one[0] <= vanishing.last_ns)

    def _errors(self) -> StandingErrors:
        (real, imaginary), spread, prior = of_records(self._filter, self._bank, self._sides, self._voltage)
        bus = self._header.bus.mean(self._same_transformer())
        return StandingErrors(
            real, imaginary, list(spread), list(prior),
            bus.difference.real, bus.difference.imag, bus.others, bus.transformers,
        )  # fmt: skip

    def _same_transformer(self) -> float:
        """Return the difference of two motors' V2/V1 below which it is that of one transformer's noise."""
        noise = 3.0 * sqrt(self._sides["r"][BUS] / COMMON_RECORDS)
        return min(max(SAME * self._usual_channel, noise), MOST_SAME * self._usual_channel)

    def _look_at_standing(self, motor: Motor) -> None:
        """Call a standing fault, and keep the errors that tell it surest: shorted turns do not heal.

        A second change beside it, before it is detected, and a supply that stays constant both have the
        filter take up some of it. While a change is suspected nothing is called, nor after one that is lived
        with: it may be of that change.
        """
        header = self._header
        if self._figures["statistic"] > SUSPECTED or header.standing is not None:
            return
        errors = self._errors()
        score = score_of(motor, errors)
        header.held_score = held(score, header.held_score)
        header.called = surest(motor, errors, score, header.called)

    def _told_standing(self, motor: Motor, bus: Sequence[StandingEstimate]) -> Standing:
        """Return what stands, and of a standing fault that was called what told it surest.

        It is called no more where all of the interval now lies below the motor's limit.
        """
        header = self._header
        now = self._standing(motor, bus, header.standing or self._errors())
        if header.called is None or now.interval[1] <= motor.limits.fault_level:
            return now
        called = self._standing(motor, bus, header.called.errors)
        return max(now, called, key=lambda standing: standing.score)

    def _standing(self, motor: Motor, bus: Sequence[StandingEstimate], errors: StandingErrors) -> Standing:
        own = self._estimate(motor, errors) if bus else None
        common = self._common.of(own, bus) if own else None
        if own is None or common is None:
            asymmetry = np.array([errors.real, errors.imaginary])
            return standing_of(motor, asymmetry, symmetric(errors.spread), from_bus=False)
        asymmetry = turned(own.asymmetry - common[0], terminal_turn(motor))
        covariance = rotated(own.covariance + common[1], terminal_turn(motor))
        return standing_of(motor, asymmetry, covariance, from_bus=True)

    def _detectable(self, records: int) -> float | None:
        if records <= START or self._header.alarm is not None:
            return None
        return detectable(self._filter, self._hypotheses)

    def _move_impedance(self, motor: Motor, edited: Motor) -> None:
        """Keep Z2 and the standing errors as they are known, whatever the motor's file says of Z2."""
        f, z = motor.nameplate.rated_frequency_Hz, self._header.scale_ohm
        before = negative_impedance(motor.parameters, f) / z
        after = negative_impedance(edited.parameters, f) / z
        start = self._header.start
        move_impedance(self._state, before, after)
        self._nominal = after
        start[:] = [record._replace(y=record.y + (before - after) * record.j2) for record in start]

    def _restart(self, *, keep_impedance: bool) -> None:
        """Let the reference be learnt anew."""
        state, prior, header = self._state, self._prior, self._header
        errors = np.array([0.0] * 2 + [prior.current] * 2 + [IMPEDANCE] * 2 + [TEMPERATURE])
        x, P = np.zeros(7), np.diag(errors**2)
        P[:2, :2] = prior.voltage
        if keep_impedance:
            x[4:], P[4:, 4:] = impedance_alone(state)
        state.x0[:], state.P0[:] = x, P
        state.current_deviation = prior.current
        state.nominal = self._nominal
        restart(self._filter, self._sides)
        header.start.clear()
        header.accepted, header.declared = False, None
        header.alarm = header.standing = header.kept = header.gone = header.called = None
        header.held_score = 0.0
        header.bus.restart()
