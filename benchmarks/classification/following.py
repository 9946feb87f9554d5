"""A motor followed over its records and starts, and its answer, through what the service calls of core."""

from core.classification.classification import Classification
from core.classification.motor import MOST_LOADS, MOST_RECORDS, MotorEvidence, RecordAnswer, classify_motor
from core.classification.record import classify_record
from core.condition.following.follower import Follower
from core.condition.kinds import moves_impedance
from core.condition.measuring.observing import examine
from core.condition.verdict.verdict import verdict_of
from core.machines.parameters import Motor
from core.recordings import Recording, RecordingError
from core.rotor.trend import DatedFinding, rotor_condition
from core.starts.changes import compare_starts, reference_starts
from core.starts.compared import StartChanges
from core.starts.examined import ExaminedStart
from core.starts.examining import examine_start
from core.tracking.follower import Follower as ParameterFollower
from core.tracking.telling import tracked_parameters

LATEST_STARTS = 3


class FollowedMotor:
    """What is known of a motor until now."""

    def __init__(self, motor: Motor) -> None:
        self._motor = motor
        self._condition = Follower(motor)
        self._parameters = ParameterFollower(motor)
        self._findings: list[DatedFinding] = []
        self._answers: list[RecordAnswer] = []
        self._starts: list[ExaminedStart] = []

    def take_record(self, recording: Recording) -> None:
        """Take in a record of the running motor."""
        examined = examine(recording, self._motor)
        self._answers.append(RecordAnswer.from_dict(classify_record(examined, self._motor).as_dict()))
        self._findings.append(DatedFinding(recording.trigger_time_ns or 0, examined.rotor))
        if examined.observation is None:
            return
        self._condition.fold(examined.observation)
        said = verdict_of(self._condition.assessment(()), self._motor)
        if not moves_impedance(said.state, said.kind, said.candidates):
            self._parameters.follow(examined.observation)

    def take_start(self, recording: Recording) -> None:
        """Take in a start; one of which nothing can be measured tells nothing."""
        try:
            examined = examine_start(recording, self._motor)
        except RecordingError:
            return
        self._starts.append(examined)
        found = examined.parameters
        ratio = None if found is None else found.rotor_over_stator
        if ratio is not None and recording.trigger_time_ns is not None:
            self._parameters.follow_start(recording.trigger_time_ns, *ratio)

    def answer(self) -> Classification:
        """Weigh the causes by all that is known."""
        said = verdict_of(self._condition.assessment(()), self._motor)
        levels = [one.finding.load_level for one in self._findings if one.finding.load_level is not None]
        return classify_motor(
            MotorEvidence(
                state=said.state,
                kind=said.kind,
                candidates=said.candidates,
                phase=said.phase,
                rotor=rotor_condition(self._findings),
                records=self._answers[-MOST_RECORDS:],
                load_levels=levels[-MOST_LOADS:],
                starts=self._start_changes(),
                tracked=tracked_parameters(self._parameters),
            )
        )

    def _start_changes(self) -> StartChanges | None:
        reference = reference_starts(self._starts)
        later = [one for one in self._starts[-LATEST_STARTS:] if one not in reference]
        return compare_starts(later, reference) if later else None
