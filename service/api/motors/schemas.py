"""Documents of sites and motors. Fields that are null are not known (yet)."""

from typing import Annotated, Literal
from uuid import UUID

from pydantic import FailFast, Field

from core.condition.kinds import Kind, State
from core.diagnosis.verdict import Verdict
from core.machines.parameters import ParametersSource
from core.machines.stator_winding import WindingKind
from core.rotor.finding import RotorState
from service.api.conditions.schemas import Condition
from service.api.document import Document, Listed, Reason, RequestForSomebody
from service.api.recordings.schemas import Recording
from service.api.times import Time
from service.storage.states import LinkState


class Site(Document):
    name: str
    description: str


class PlantMotor(Document):
    """What lists and single motors share."""

    name: str
    description: str
    site: str
    ied: str
    schedule: str | None
    parameters_source: ParametersSource


class Winding(Document):
    """How a stator is wound, as the motors file has it.

    kind: how the coils lie. slots: of the stator. layers: coil sides in a slot. coil_pitch_slots: slots from
    side to side of a coil.
    """

    kind: WindingKind
    slots: int
    layers: int
    coil_pitch_slots: int | None


class Motor(PlantMotor):
    """A motor; `schedule`, a cron expression in UTC, says when it is recorded without anybody asking.

    parameters_source: where its parameters come from: given in the motors file, commissioned from a recorded
    start, from a data sheet, or typical of its rating. With typical ones the motor is on watch at most.
    winding: of its stator; null where the motors file does not tell it.
    """

    winding: Winding | None


class RecordedStarts(Document):
    """The starts of a motor from which its parameters can be estimated: how many, and the latest one's time.

    advice: the command that does it; null where the motor's parameters were estimated already.
    """

    number: int
    latest_time: Time = Field(validation_alias="latest_ns")
    advice: str | None


class Health(Document):
    """What is known of a motor now: its condition, the diagnosis of its latest recording, its relay's link.

    What is said of verdict, level, phase, load and reasons beside the condition repeats the diagnosis; null
    and empty before the first one. Recordings in which the motor stands, starts, stops or trips say nothing
    of it, and are told by last_recording alone. starts: those among them that its parameters follow from.
    stood_time: when the motor was last seen to stand still.
    """

    motor: str
    site: str
    ied: str
    condition: Condition
    parameters_source: ParametersSource
    verdict: Verdict | None
    mu_f: float | None
    mu_f_ci95: tuple[float, float] | None
    mu_f_scatter95: tuple[float, float] | None
    detection_limit: float | None
    phase: Literal["a", "b", "c"] | None
    load_level: float | None
    load_level_ci95: tuple[float, float] | None
    reasons: Listed[str]
    recording_id: str | None
    recorded_time: Time | None
    link_state: LinkState
    link_reason: str | None
    last_success_time: Time | None
    last_recording: Recording | None
    starts: RecordedStarts | None
    stood_time: Time | None


class ListedMotor(PlantMotor):
    """A motor in a list, with its health where that was asked for."""

    health: Health | None = None


class TrendPoint(Document):
    """One recording's figure; `value` is null where the recording does not tell it.

    ci95: 95 % interval from noise, sensors and parameters, where the figure has one. scatter95: of mu_f only,
    from the record's own scatter alone. detection_limit: what nine of ten such recordings show.
    verdict: of the recording alone, beside figures of the winding. state: of the stator from that recording
    on, with kind and phase, beside figures of the motor's condition; what the recording shows of the rotor,
    beside figures of that. reasons: what limits figures of rotor, air gap, load and supply.
    """

    time: Time = Field(validation_alias="time_ns")
    value: float | None
    ci95: tuple[float, float] | None
    scatter95: tuple[float, float] | None
    detection_limit: float | None
    verdict: Verdict | None
    recording_id: str
    state: State | RotorState | None = None
    kind: Kind | None = None
    phase: Literal["a", "b", "c"] | None = None
    reasons: Listed[str] | None = None


class BaselineRequest(RequestForSomebody):
    """The recordings that stand for a motor's healthy condition.

    reason: why they do; needed where a recording is in doubt.
    """

    recording_ids: Annotated[set[UUID], Field(min_length=3, max_length=100), FailFast()]
    reason: Reason | None = None


class BaselineDoubt(Document):
    """What spoke against a recording as one of a healthy motor when it was chosen."""

    recording_id: str
    doubt: str


class Baseline(Document):
    """The motor's healthy recordings; empty where it has no baseline.

    When they were chosen, why, where that was said, and which of them were in doubt. by: the account that
    chose them; on_behalf_of: whom it named.
    """

    recordings: Listed[Recording]
    chosen_time: Time | None = Field(validation_alias="chosen_ns")
    reason: str | None
    by: str | None = Field(validation_alias="account")
    on_behalf_of: str | None
    doubts: Listed[BaselineDoubt]
