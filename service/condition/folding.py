"""Fold what is new of a motor into its condition: its observations and events in their order of time."""

from collections.abc import Iterator, Sequence
from dataclasses import asdict, replace

import structlog

from core.condition.bus import Neighbour, StandingEstimate
from core.condition.bus_records import BusRecords
from core.condition.condition import Condition, condition_of
from core.condition.follower import Follower
from core.machines.parameters import Motor
from service.condition.checkpoints import is_kept
from service.condition.motor_data import MotorHistory, motor_of
from service.condition.standing import standing_document, standing_estimate
from service.storage.records import (
    Checkpoint,
    ConditionChange,
    ConditionEntry,
    ConditionEvent,
    ConditionFigures,
    ConditionPoint,
    FoldInput,
    FoldResult,
    RecordObservation,
)

log = structlog.get_logger(__name__)


class UnreadableCheckpointError(ValueError):
    """A checkpoint of another version: all is to be folded from the first record on."""


def fold(due: FoldInput, motor: Motor) -> FoldResult:
    """Fold what is due of a motor. motor: as the motors file has it now. Raises UnreadableCheckpointError."""
    folding = _Folding(due, motor)
    folding.run()
    return folding.result()


class _Folding:
    """One fold under way: the follower, and what is said on the way."""

    def __init__(self, due: FoldInput, motor: Motor) -> None:
        self._due = due
        self._motor = motor
        self._history = MotorHistory(motor, due.motor_versions)
        self._bus = _Bus(due, motor)
        self._records = 0 if due.checkpoint is None else due.checkpoint.records
        self._follower = self._begun()
        self._said: ConditionFigures | None = due.latest_change
        self._points: list[ConditionPoint] = []
        self._changes: list[ConditionChange] = []
        self._checkpoints: list[Checkpoint] = []

    def run(self) -> None:
        observations = self._due.observations
        last = self._records + len(observations)
        events = list(self._due.events)
        times = [one.observation.time_ns for one in observations]
        for at, one in enumerate(observations):
            while events and events[0].time_ns <= times[at]:
                self._apply(events.pop(0))
            self._fold(one)
            if at + 1 < len(times) and times[at] < times[at + 1] and is_kept(self._records, last):
                self._checkpoints.append(Checkpoint(times[at], self._records, self._follower.save()))
        for event in events:
            self._apply(event)
        ends = [*times[-1:], *(event.time_ns for event in self._due.events[-1:])]
        if ends:
            self._checkpoints.append(Checkpoint(max(ends), self._records, self._follower.save()))

    def result(self) -> FoldResult:
        ended = self._due.next_ns is None
        estimate = self._follower.standing_estimate() if ended else None
        return FoldResult(
            points=self._points,
            changes=self._changes,
            checkpoints=self._checkpoints,
            kept_checkpoints=[
                time_ns for time_ns, records in self._due.earlier.items() if is_kept(records, self._records)
            ],
            condition=self._entry() if ended else None,
            standing=None if estimate is None else standing_document(estimate),
        )

    def _begun(self) -> Follower:
        checkpoint = self._due.checkpoint
        if checkpoint is None:
            return Follower(self._history.at(_first_ns(self._due)))
        try:
            return Follower.restore(self._history.at(checkpoint.time_ns), checkpoint.state)
        except ValueError as error:
            raise UnreadableCheckpointError(str(error)) from error

    def _fold(self, one: RecordObservation) -> None:
        self._records += 1
        observation = one.observation
        try:
            self._follower.fold(observation, self._bus.neighbours(observation.time_ns))
        except ValueError as error:
            log.warning("record left out of the condition", recording=one.recording_id, error=str(error))
            return
        figures = self._figures(observation.time_ns)
        self._points.append(
            ConditionPoint(recording_id=one.recording_id, time_ns=observation.time_ns, **asdict(figures))
        )
        if _differ(self._said, figures):
            self._note(figures, observation.time_ns, recording_id=one.recording_id)

    def _apply(self, event: ConditionEvent) -> None:
        self._follower.apply(event.event, self._history.edited_at(event.time_ns))
        self._note(self._figures(event.time_ns), event.time_ns, event_id=event.id)

    def _note(
        self,
        figures: ConditionFigures,
        time_ns: int,
        *,
        recording_id: str | None = None,
        event_id: str | None = None,
    ) -> None:
        self._said = figures
        self._changes.append(
            ConditionChange(
                motor=self._due.motor,
                time_ns=time_ns,
                recording_id=recording_id,
                event_id=event_id,
                **asdict(figures),
            )
        )

    def _figures(self, now_ns: int) -> ConditionFigures:
        """Return what is said now. A forecast, which takes long, is made at the end only."""
        assessment = self._follower.assessment(self._bus.standings)
        brief = None if assessment is None else replace(assessment, levels=())
        return _figures_of(condition_of(self._motor, brief, now_ns))

    def _entry(self) -> ConditionEntry:
        """Return the motor's condition, as it was said of it with its latest record."""
        assessment = self._follower.assessment(self._bus.standings)
        now_ns = 0 if assessment is None else assessment.as_of_ns
        condition = condition_of(self._motor, assessment, now_ns)
        return ConditionEntry(
            motor=self._due.motor,
            version=self._due.version + 1,
            since_ns=condition.since_ns,
            as_of_ns=condition.as_of_ns,
            document=condition.as_dict(),
            **asdict(_figures_of(condition)),
        )


class _Bus:
    """The other motors of the motor's bus. standings: their standing asymmetries."""

    def __init__(self, due: FoldInput, motor: Motor) -> None:
        motors = {
            one.motor: replace(motor_of(motor, one.document), name=one.motor)
            for one in due.bus
            if one.document is not None
        }
        self.standings: Sequence[StandingEstimate] = [
            standing_estimate(one.motor, one.standing) for one in due.bus if one.standing is not None
        ]
        self._records = BusRecords(
            (motors[one.motor], one.observation) for one in due.neighbours if one.motor in motors
        )

    def neighbours(self, time_ns: int) -> list[Neighbour]:
        """Return what each other motor saw within a minute."""
        return self._records.neighbours(time_ns)


def _first_ns(due: FoldInput) -> int:
    """Return the time of what is folded first."""
    times: Iterator[int] = iter(
        sorted(
            [
                *(one.observation.time_ns for one in due.observations[:1]),
                *(event.time_ns for event in due.events[:1]),
            ]
        )
    )
    return next(times, 0)


def _figures_of(condition: Condition) -> ConditionFigures:
    low, high = condition.mu_f_ci95 or (None, None)
    change_low, change_high = condition.change_ci95 or (None, None)
    return ConditionFigures(
        state=condition.state,
        kind=condition.kind,
        phase=condition.phase,
        mu_f=condition.mu_f,
        mu_f_ci95_low=low,
        mu_f_ci95_high=high,
        change=condition.change,
        change_ci95_low=change_low,
        change_ci95_high=change_high,
    )


def _differ(before: ConditionFigures | None, now: ConditionFigures) -> bool:
    return before is None or (before.state, before.kind, before.phase) != (now.state, now.kind, now.phase)
