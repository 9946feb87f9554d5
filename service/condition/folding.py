"""Fold what is new of a motor into its condition: its observations and events in their order of time."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import structlog

from core.condition.bus.bus_records import BusRecords
from core.condition.bus.neighbours import Neighbour, StandingEstimate
from core.condition.errors import ObservationError
from core.condition.following.follower import Follower
from core.condition.kinds import moves_impedance
from core.condition.rules import RULES
from core.condition.verdict.condition import Condition
from core.condition.verdict.judging import condition_of
from core.condition.verdict.verdict import Verdict, verdict_of
from core.machines.parameters import Motor
from service.condition.checkpoints import is_kept
from service.condition.errors import RecordFoldError
from service.condition.motor_data import MotorHistory, motor_of
from service.condition.standing import standing_document, standing_estimate
from service.condition.tracking import Tracking
from service.storage.records import (
    Checkpoint,
    ConditionChange,
    ConditionEntry,
    ConditionEvent,
    ConditionPoint,
    FoldInput,
    FoldResult,
    RecordObservation,
)

log = structlog.get_logger(__name__)

Said = dict[str, Any]
"""The fields of ConditionFigures."""

TOLD_APART = ("state", "kind", "phase", "candidates")
"""Where one of these is another than before, the history has it."""


class UnreadableCheckpointError(ValueError):
    """A checkpoint of another version: all is to be folded from the first record on."""


def fold(due: FoldInput, motor: Motor) -> FoldResult:
    """Fold what is due of a motor. motor: as the motors file has it now.

    Raises UnreadableCheckpointError, RecordFoldError.
    """
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
        self._tracking = self._tracking_begun()
        before = due.latest_change
        self._said: Said | None = (
            None if before is None else {name: getattr(before, name) for name in TOLD_APART}
        )
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
            try:
                self._fold(one)
            except Exception as error:
                raise RecordFoldError(one.recording_id, f"{type(error).__name__}: {error}") from error
            if at + 1 < len(times) and times[at] < times[at + 1] and is_kept(self._records, last):
                self._keep(times[at])
        for event in events:
            self._apply(event)
        ends = [*times[-1:], *(event.time_ns for event in self._due.events[-1:])]
        if ends:
            self._keep(max(ends))
        self._tracking.follow_starts()

    def _keep(self, time_ns: int) -> None:
        """Keep a checkpoint: all up to and with this time is folded."""
        self._tracking.follow_starts(time_ns)
        state, tracking = self._follower.save(), self._tracking.document()
        self._checkpoints.append(Checkpoint(time_ns, self._records, state, tracking))

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
            rules=RULES,
            tracked=self._tracking.points,
            parameters=self._tracking.found() if ended else None,
        )

    def _begun(self) -> Follower:
        checkpoint = self._due.checkpoint
        if checkpoint is None:
            return Follower(self._history.at(_first_ns(self._due)))
        try:
            return Follower.restore(self._history.at(checkpoint.time_ns), checkpoint.state)
        except ValueError as error:
            raise UnreadableCheckpointError(str(error)) from error

    def _tracking_begun(self) -> Tracking:
        checkpoint, starts = self._due.checkpoint, self._due.starts
        if checkpoint is None:
            return Tracking.begun(self._history.at(_first_ns(self._due)), starts)
        return Tracking.restored(self._history.at(checkpoint.time_ns), checkpoint.tracking, starts)

    def _fold(self, one: RecordObservation) -> None:
        self._records += 1
        observation = one.observation
        try:
            self._follower.fold(observation, self._bus.neighbours(observation.time_ns))
        except ObservationError as error:
            log.warning("record left out of the condition", recording=one.recording_id, error=str(error))
            return
        said = self._say()
        if not moves_impedance(said["state"], said["kind"], said["candidates"]):
            self._tracking.follow(one)
        self._points.append(
            ConditionPoint(recording_id=one.recording_id, time_ns=observation.time_ns, **said)
        )
        if self._said is None or _differs(self._said, said):
            self._note(said, observation.time_ns, recording_id=one.recording_id)

    def _apply(self, event: ConditionEvent) -> None:
        edited = self._history.edited_at(event.time_ns)
        self._follower.apply(event.event, edited)
        self._tracking.apply(event.event, edited)
        self._note(self._say(), event.time_ns, event_id=event.id)

    def _note(
        self, said: Said, time_ns: int, *, recording_id: str | None = None, event_id: str | None = None
    ) -> None:
        self._said = said
        self._changes.append(
            ConditionChange(
                motor=self._due.motor, time_ns=time_ns, recording_id=recording_id, event_id=event_id, **said
            )
        )

    def _say(self) -> Said:
        """Return what is said now. A forecast, which takes long, is made at the end only."""
        assessment = self._follower.assessment(self._bus.standings)
        return _said(verdict_of(assessment, self._motor))

    def _entry(self) -> ConditionEntry:
        """Return the motor's condition, as it was said of it with its latest record."""
        assessment = self._follower.assessment(self._bus.standings)
        now_ns = 0 if assessment is None else assessment.as_of_ns
        condition = condition_of(self._motor, assessment, now_ns, ended_by=self._follower.ended_by)
        return ConditionEntry(
            motor=self._due.motor,
            version=self._due.version + 1,
            since_ns=condition.since_ns,
            as_of_ns=condition.as_of_ns,
            document=condition.as_dict(),
            **_said(condition),
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


def _differs(before: Said, said: Said) -> bool:
    """Return whether something else is said. The order of the candidates may turn from record to record."""
    return any(
        set(before[name]) != set(said[name]) if name == "candidates" else before[name] != said[name]
        for name in TOLD_APART
    )


def _first_ns(due: FoldInput) -> int:
    """Return the time of what is folded first."""
    return min(
        (
            *(one.observation.time_ns for one in due.observations[:1]),
            *(event.time_ns for event in due.events[:1]),
        ),
        default=0,
    )


def _said(condition: Condition | Verdict) -> Said:
    low, high = condition.mu_f_ci95 or (None, None)
    change_low, change_high = condition.change_ci95 or (None, None)
    return {
        "state": condition.state,
        "kind": condition.kind,
        "candidates": condition.candidates,
        "phase": condition.phase,
        "mu_f": condition.mu_f,
        "mu_f_ci95_low": low,
        "mu_f_ci95_high": high,
        "change": condition.change,
        "change_ci95_low": change_low,
        "change_ci95_high": change_high,
    }
