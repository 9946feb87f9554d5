"""Follow a motor's parameters along with a fold of its condition."""

from collections.abc import Mapping, Sequence
from typing import Any, Final

import numpy as np

from core.condition.events import Event, EventKind
from core.machines.parameters import Motor
from core.normal_distribution import NORMAL_95
from core.tracking.drift import FOLLOWED
from core.tracking.finding import ParameterName
from core.tracking.follower import Follower
from core.tracking.saving import document_of, follower_of
from core.tracking.telling import tracked_parameters
from service.storage.records import FollowedStart, RecordObservation, TrackedPoint

ANEW: Final = (EventKind.REWOUND, EventKind.REFERENCE_RESTARTED)
"""Events after which the first records are others. Maintenance is none: what it changes is to be told."""
COLUMNS: Final = {
    ParameterName.STATOR_RESISTANCE: "stator_resistance",
    ParameterName.LEAKAGE_INDUCTANCE: "leakage_inductance",
    ParameterName.MAGNETISING_INDUCTANCE: "magnetising_inductance",
    ParameterName.ROTOR_RESISTANCE: "rotor_resistance",
}


class Tracking:
    """The parameters of a motor over a fold: its records, starts and events in their order of time."""

    def __init__(self, follower: Follower, starts: Sequence[FollowedStart]) -> None:
        self._follower = follower
        self._starts = list(starts)
        self.points: list[TrackedPoint] = []

    @classmethod
    def begun(cls, motor: Motor, starts: Sequence[FollowedStart]) -> "Tracking":
        """Begin with a motor's first record."""
        return cls(Follower(motor), starts)

    @classmethod
    def restored(
        cls, motor: Motor, document: Mapping[str, Any], starts: Sequence[FollowedStart]
    ) -> "Tracking":
        """Go on from a checkpoint."""
        return cls(follower_of(motor, document), starts)

    def follow(self, one: RecordObservation) -> None:
        """Take in a record, and the starts before it."""
        self.follow_starts(one.observation.time_ns)
        if self._follower.follow(one.observation):
            self.points.append(_point(one, self._follower))

    def follow_starts(self, until_ns: int | None = None) -> None:
        """Take in the starts up to a time, or all."""
        while self._starts and (until_ns is None or self._starts[0].time_ns <= until_ns):
            start = self._starts.pop(0)
            self._follower.follow_start(start.time_ns, start.rotor_over_stator, start.deviation)

    def apply(self, event: Event, edited: Motor | None) -> None:
        """Take in an event. edited: the motor as the file has it from then on, where that was edited."""
        if event.kind in ANEW:
            self._follower = Follower(self._follower.motor)
        elif event.kind is EventKind.PARAMETERS_EDITED and edited is not None:
            self._follower = Follower(edited)
        elif event.kind is EventKind.RECORDER_CHANGED:
            self._follower.meet_other_sensors()

    def document(self) -> Mapping[str, object]:
        """Return what a checkpoint keeps."""
        return document_of(self._follower)

    def found(self) -> Mapping[str, object]:
        """Return what is said of the parameters now."""
        return tracked_parameters(self._follower).as_dict()


def _point(one: RecordObservation, follower: Follower) -> TrackedPoint:
    figures: dict[str, float] = {}
    if follower.has_reference:
        change, covariance = follower.changes
        margins = (NORMAL_95 * np.sqrt(np.diag(covariance))).tolist()
        for name, value, margin in zip(FOLLOWED, change.tolist(), margins, strict=True):
            figures[f"{COLUMNS[name]}_change"] = value
            figures[f"{COLUMNS[name]}_margin"] = margin
    return TrackedPoint(recording_id=one.recording_id, time_ns=one.observation.time_ns, **figures)
