"""A motor's records in one direction of rotation: its standing errors, and what changes."""

from collections.abc import Sequence
from dataclasses import replace

from core.condition.assessment import Assessment, Declared, Level, ParameterError, Reference
from core.condition.bus.differences import same_transformer
from core.condition.bus.neighbours import Neighbour, StandingEstimate
from core.condition.changes.alarm import Alarm
from core.condition.changes.detectability import detectable
from core.condition.events import Event, EventKind
from core.condition.filter.state import BUS, START
from core.condition.following.direction_state import DirectionState
from core.condition.following.expectations import Expectations, expectations_of
from core.condition.following.explanation import Explanation
from core.condition.following.folding import fold_record
from core.condition.following.open_alarm import follow_up, maintain
from core.condition.following.reference import edit_impedance, restart_reference
from core.condition.following.standing import LOOKED_AT, STANDING_SCORE, USUAL_SCORE, held, score_of, surest
from core.condition.following.standing_errors import SUSPECTED, StandingErrors, standing_errors_of
from core.condition.following.standing_on_bus import StandingOnBus
from core.condition.following.start import fold_start
from core.condition.measuring.measurement import Measurement, measure
from core.condition.measuring.parameter_fit import add_record, counts, parameter_errors
from core.condition.observation import Observation
from core.condition.severity import level_in_all, level_of, of_one_fault, stands_out
from core.diagnosis.turns_place import axis_of, phases_of
from core.machines.parameters import Motor
from core.machines.winding_frame import terminal_winding
from core.signals.sequence import PhaseSequence

UNCONFIRMED = 30.0
"""Chi-square of 2 above which a record has to be confirmed by another: one in three million."""
NANOSECONDS = 1e-9


class Direction:
    """A motor's records in one direction of rotation, measured by one recorder.

    Parameters
    ----------
    motor : Motor
        The motor.
    state : DirectionState
        What is kept of it; every record changes it.
    """

    def __init__(self, motor: Motor, state: DirectionState) -> None:
        self.state = state
        self._on_bus = StandingOnBus(state.sequence)
        self._expected_of = (motor, state.header.voltage_channels)
        self._expectations = expectations_of(*self._expected_of, state.sequence, state.header.scale_ohm)
        self._explanation = Explanation(state, self._expectations)
        self._parameter_errors: tuple[ParameterError, ...] | None = None

    @property
    def sequence(self) -> PhaseSequence:
        """Order of the supply's phases at the terminals."""
        return self.state.sequence

    @property
    def name(self) -> str:
        """What measures the records, and the direction of rotation."""
        return f"{self.state.header.recorder} ({self.sequence})"

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
        return observation.sequence is self.sequence and not self.state.header.measured_by(observation)

    @property
    def is_complete(self) -> bool:
        """Whether changes are looked for, or one is told from before the reference."""
        return bool(self.state.figures["records"] > START or self.state.header.kept is not None)

    @property
    def records(self) -> int:
        """Number of records that the reference rests on; none right after an event that ends it."""
        return int(self.state.figures["records"])

    @property
    def is_known(self) -> bool:
        """Whether anything can be said: there are records, or a change from before them."""
        return bool(self.state.figures["records"] > 0.0) or self.state.header.kept is not None

    @property
    def as_of_ns(self) -> int:
        """Time of the latest record, UTC [ns]."""
        return self.state.header.as_of_ns

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
        state, header = self.state, self.state.header
        elapsed_s = max(observation.time_ns - header.as_of_ns, 0) * NANOSECONDS if header.recorder else 0.0
        record = measure(observation, motor, header.scale_ohm, elapsed_s)
        if neighbours:
            same = same_transformer(self._expectations.usual_difference, state.sides["r"][BUS])
            moved = header.bus.fold(record.v2, self.sequence, neighbours, same)
            if moved is not None:
                record = record._replace(bus=moved, has_bus=True)
        if header.measured_by(observation):
            known = bool(header.recorder)
            header.recorder, header.voltage_channels = observation.recorder, observation.voltage_channels
            restart_reference(state, self._expect(motor).prior, keep_impedance=known)
        header.as_of_ns = observation.time_ns
        if header.alarm is None and counts(state.figures["records"]):
            add_record(state.parameter_fits[0], record)
            self._parameter_errors = None
        if state.figures["records"] < START:
            if not header.start:
                header.since_ns = observation.time_ns
            header.start.append(record)
            fold_start(state.filters, state.sides, state.circles, header.start)
            if len(header.start) == START:
                header.start.clear()
            return
        alarm, expectations = header.alarm, self._expect(motor)
        fold_record(
            state.filters, state.bank, state.sides, state.circles, state.recent, expectations.hypotheses,
            expectations.jumps, record, observation.time_ns, alarm is not None,
        )  # fmt: skip
        self._explanation = Explanation(state, expectations)
        if alarm is None and state.figures["statistic"] >= state.figures["threshold"]:
            alarm = header.alarm = Alarm(observation.time_ns)
            header.standing = header.standing or self._errors()
            if self._score(header.standing) < USUAL_SCORE:
                header.called = None  # it was the beginning of this change
        if alarm is not None:
            self._follow_up(alarm, motor, record)
        elif state.figures["records"] % LOOKED_AT == 0.0:
            self._look_at_standing()

    def _follow_up(self, alarm: Alarm, motor: Motor, record: Measurement) -> None:
        state, expectations = self.state, self._expectations
        follow_up(alarm, state, self._explanation, expectations, motor, record)
        if state.header.alarm is not alarm:
            self._explanation = Explanation(state, expectations)

    def apply(self, event: Event, motor: Motor, edited: Motor) -> None:
        """Let something be known that happened between two records.

        Parameters
        ----------
        event : Event
            What happened.
        motor, edited : Motor
            The motor before and after it.
        """
        state = self.state
        declared = self._shown(motor) if event.kind is EventKind.REFERENCE_RESTARTED else None
        if event.kind is EventKind.PARAMETERS_EDITED or edited != motor:
            self._edit(motor, edited)
        self._parameter_errors = None
        prior = self._expectations.prior
        if event.kind is EventKind.RECORDER_CHANGED:
            restart_reference(state, prior, keep_impedance=True)
        elif event.kind is EventKind.MAINTENANCE:
            maintain(state, prior)
        elif event.kind is EventKind.REFERENCE_RESTARTED:
            restart_reference(state, prior, keep_impedance=True)
            state.header.accepted, state.header.declared = True, declared
        self._explanation = Explanation(state, self._expectations)

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
        header, figures = self.state.header, self.state.figures
        standing = self._on_bus.told(
            motor, self._expectations, header.standing or self._errors(), header.called, bus
        )
        records, alarm = int(figures["records"]), header.alarm
        connection = motor.nameplate.connection
        winding = terminal_winding(standing.winding, self.sequence, connection)
        change, levels = (
            (header.gone or self._explanation.kept(motor), ())
            if alarm is None
            else self._explanation.told(alarm, motor)
        )
        return Assessment(
            as_of_ns=header.as_of_ns,
            reference=Reference(
                records=records,
                complete=self.is_complete,
                since_ns=header.since_ns,
                detectable=self._detectable(),
                standing=Level(
                    standing.level,
                    standing.deviation,
                    winding,
                    standing.interval,
                    phases_of(standing.windings, motor, self.sequence),
                    axis_of(standing.axes_rad, standing.axis_shares, motor, self.sequence),
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
            parameter_errors=self._errors_of_parameters(motor),
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
        errors = self.state.header.standing or self._errors()
        return self._on_bus.estimate(motor, self._expectations.prior, errors)

    def _errors_of_parameters(self, motor: Motor) -> tuple[ParameterError, ...]:
        """Return the parameters that the records contradict; computed anew after a record that counts."""
        if self._parameter_errors is None:
            self._parameter_errors = parameter_errors(self.state.parameter_fits[0], motor)
        return self._parameter_errors

    def _expect(self, motor: Motor) -> Expectations:
        """Return what is expected of the motor, which is computed anew only where its file is another."""
        of = (motor, self.state.header.voltage_channels)
        if of != self._expected_of:
            self._expected_of = of
            self._expectations = expectations_of(*of, self.sequence, self.state.header.scale_ohm)
        return self._expectations

    def _edit(self, motor: Motor, edited: Motor) -> None:
        """Let the motor's file be another: its errors stay, and are held against what that file leaves."""
        header = self.state.header
        edit_impedance(self.state, motor, edited)
        before = self._expect(motor).voltage
        more = self._expect(edited).voltage - before
        if header.standing is not None:
            header.standing = header.standing.of_another_class(more)
        if header.called is not None:
            errors = header.called.errors.of_another_class(more)
            score = self._score(errors)
            called = replace(header.called, errors=errors, score=score)
            header.called = called if score >= STANDING_SCORE else None

    def _errors(self) -> StandingErrors:
        state = self.state
        return standing_errors_of(
            state.filters, state.bank, state.sides, state.header.bus, self._expectations
        )

    def _score(self, errors: StandingErrors) -> float:
        return score_of(self._expectations.rough, errors)

    def _look_at_standing(self) -> None:
        """Call a standing fault, and keep the errors that tell it surest: shorted turns do not heal.

        A second change beside it, before it is detected, and a supply that stays constant both have the
        filter take up some of it. While a change is suspected nothing is called, nor after one that is lived
        with: it may be of that change.
        """
        header = self.state.header
        if self.state.figures["statistic"] > SUSPECTED or header.standing is not None:
            return
        errors = self._errors()
        score = self._score(errors)
        header.held_score = held(score, header.held_score)
        header.called = surest(self._expectations.rough, errors, score, header.called)

    def _shown(self, motor: Motor) -> Declared | None:
        """Return the shorted turns that the records show; None where there are none."""
        if not self.is_known:
            return self.state.header.declared
        limit = motor.limits.fault_level
        found = of_one_fault(self.assessment(motor, ()), limit)
        level, interval = level_in_all(found)
        changed = level_of(found.change)
        if found.standing_fault or (changed is None and stands_out(found, limit)):
            return Declared(level, interval, found.reference.standing.phase)
        return None if changed is None else Declared(level, interval, changed.phase)

    def _detectable(self) -> float | None:
        state = self.state
        if state.figures["records"] <= START or state.header.alarm is not None:
            return None
        return detectable(state.filters, self._expectations.hypotheses)
