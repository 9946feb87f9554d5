"""A motor followed over its records and starts, and its answer, through what the service calls of core."""

from collections import defaultdict

from core.classification.classification import Classification
from core.classification.motor import MOST_LOADS, MOST_RECORDS, MotorEvidence, classify_motor
from core.classification.record_answer import RecordAnswer
from core.condition.following.follower import Follower
from core.condition.kinds import moves_impedance
from core.condition.verdict.verdict import verdict_of
from core.findings.examining import examine
from core.machines.parameters import Motor
from core.recordings import Recording, RecordingError
from core.rotor.finding import LOAD_OSCILLATION, RotorFinding, RotorState
from core.rotor.trend import BASELINE_RECORDS, LATEST_RECORDS, JudgedRecord, baseline_dB, rotor_condition
from core.starts.changes import compare_starts, reference_starts
from core.starts.compared import StartChanges
from core.starts.examined import ExaminedStart
from core.starts.examining import examine_start
from core.tracking.follower import Follower as ParameterFollower
from core.tracking.saving import document_of, follower_of
from core.tracking.telling import tracked_parameters

LATEST_STARTS = 3


class FollowedMotor:
    """What is known of a motor until now."""

    def __init__(self, motor: Motor) -> None:
        self._motor = motor
        self._condition = Follower(motor)
        self._parameters = ParameterFollower(motor)
        self._cage: list[JudgedRecord] = []
        self._first_severities_dB: defaultdict[int, list[float]] = defaultdict(list)
        self._load_levels: list[float] = []
        self._answers: list[RecordAnswer] = []
        self._starts: list[ExaminedStart] = []

    def copy(self) -> "FollowedMotor":
        """Return the same, to go on in another way; followers are saved and restored, as the service does."""
        same = FollowedMotor(self._motor)
        same._condition = Follower.restore(self._motor, self._condition.save())
        same._parameters = follower_of(self._motor, document_of(self._parameters))
        same._cage, same._load_levels = [*self._cage], [*self._load_levels]
        same._first_severities_dB.update({k: [*first] for k, first in self._first_severities_dB.items()})
        same._answers, same._starts = [*self._answers], [*self._starts]
        return same

    def take_record(self, recording: Recording) -> None:
        """Take in a record of the running motor."""
        examined = examine(recording, self._motor)
        self._answers.append(RecordAnswer.from_dict(examined.classification.as_dict()))
        self._take_cage(examined.rotor)
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
        return classify_motor(
            MotorEvidence(
                state=said.state,
                kind=said.kind,
                candidates=said.candidates,
                phase=said.phase,
                rotor=rotor_condition(self._cage[-LATEST_RECORDS:], since_ns=None, bins=()),
                records=self._answers[-MOST_RECORDS:],
                load_levels=self._load_levels[-MOST_LOADS:],
                starts=self._start_changes(),
                tracked=tracked_parameters(self._parameters),
            )
        )

    def _take_cage(self, found: RotorFinding) -> None:
        if found.load_level is not None:
            self._load_levels.append(found.load_level)
        severity_dB, interval, load_bin = found.severity_dB, found.severity_dB_ci95, found.load_bin
        if found.state is RotorState.UNSUPPORTED or severity_dB is None or interval is None:
            return
        if load_bin is None:
            return
        first = self._first_severities_dB[load_bin]
        baseline = baseline_dB(first)
        if len(first) < BASELINE_RECORDS:
            first.append(severity_dB)
        swings = any(reason.startswith(LOAD_OSCILLATION) for reason in found.reasons)
        self._cage.append(JudgedRecord(found.state, severity_dB, interval, baseline, load_swings=swings))

    def _start_changes(self) -> StartChanges | None:
        reference = reference_starts(self._starts)
        later = [one for one in self._starts[-LATEST_STARTS:] if one not in reference]
        return compare_starts(later, reference) if later else None
