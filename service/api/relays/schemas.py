"""Documents of the API about relays, their links and the gateways that visit them."""

from typing import Literal

from pydantic import Field

from service.api.alarms.schemas import Alarm
from service.api.document import Document, Listed, Seconds
from service.api.times import Time
from service.plant.differences import DifferenceKind
from service.plant.overrides import TriggerAction
from service.storage.states import ClockQuality, LinkState


class RelayClock(Document):
    """A relay's clock less the service's, and what the relay says of it; null where it is not known.

    It is read off the relay's stamp of a trigger, or of a measured value that has just changed, within
    `clock_uncertainty_s`, at `clock_measured_time`.
    """

    clock_offset_s: Seconds | None = Field(validation_alias="clock_offset_ns")
    clock_uncertainty_s: Seconds | None = Field(validation_alias="clock_uncertainty_ns")
    clock_quality: ClockQuality | None
    clock_measured_time: Time | None = Field(validation_alias="clock_measured_ns")


class Ied(RelayClock):
    """A relay; `last_success_time` is when it last answered. `clock_...`: its clock less the service's."""

    name: str
    site: str
    host: str
    port: int
    manufacturer: str
    type: str
    link_state: LinkState
    link_reason: str | None
    link_changed_time: Time | None = Field(validation_alias="link_changed_ns")
    last_success_time: Time | None = Field(validation_alias="last_success_ns")


class LinkFigures(Document):
    """What went over a relay's link since the relay is known.

    round_trip_s: duration of its latest answer. received_bytes: of files. report_gaps: how often reports were
    lost, which costs time and no recording: the relay's directory is what counts.
    """

    round_trip_s: float | None
    connections: int
    received_bytes: int
    reports: int
    report_gaps: int


class LinkChange(Document):
    """The state a link changed to, and why."""

    time: Time = Field(validation_alias="changed_ns")
    state: LinkState
    reason: str | None


class Quarantine(Document):
    """A relay set aside until `until_time`, or back since then and not trusted yet.

    times: how often in a row; 0 where it is one of several relays of which one crashed a gateway.
    """

    reason: str
    times: int
    since_time: Time = Field(validation_alias="since_ns")
    until_time: Time = Field(validation_alias="until_ns")


class Gateway(Document):
    """A process that visits relays: `relays` is how many it holds at present.

    problem: what does not work in it at present; null while all does.
    """

    id: str
    host: str
    process_id: int
    started_time: Time = Field(validation_alias="started_ns")
    relays: int
    problem: str | None


class Acquisition(Document):
    """What the service uses of a relay to have its recordings; null what it does not offer.

    asked: whether the relay itself was asked at `found_time`, or its SCL is taken at its word. trigger: the
    control that makes a record; trigger_action: set and reset, or a pulse that falls by itself.
    records_told_by: what tells of a new record. text_reports: those that the relay lists, and the service
    reads; empty until it has looked. overridden: what the motors file decides. remarks: what
    cannot be had of it, and what is used instead.
    """

    found_time: Time
    asked: bool
    trigger: str | None
    trigger_action: TriggerAction | None
    control_model: str | None
    record_made: str | None
    record_number: str | None
    records_told_by: Literal["buffered-report", "unbuffered-report", "polling"]
    report_control: str | None
    events_directory: str | None
    text_reports: Listed[str] = Field(default_factory=list)
    overridden: Listed[str]
    remarks: Listed[str]


class Difference(Document):
    """Relay and SCL differ; `expected` is null where nobody expected it, `found` where the relay lacks it."""

    kind: DifferenceKind
    expected: str | None
    found: str | None


class IgnoredFile(Document):
    """A file of the relay's events directory that is not taken; `name` as printable text."""

    name: str
    reason: str


class ReportLength(Document):
    """How long a relay's event reports are, by its latest record, and how much of it is before the trigger.

    cycles: of the motor's rated frequency. longest_cycles: what its family allows; null where that is not
    known. advice: what to set in the relay for longer records, and for series of them that are joined.
    """

    duration_s: float
    pre_trigger_s: float
    cycles: float
    longest_cycles: int | None
    advice: Listed[str]


class IedDetails(Ied):
    """A relay with the figures of its link, its latest link changes and the alarms that stand.

    gateway: id of the one that visits it, null while none does. acquisition: null before the first visit.
    quarantine: null where nothing is held against it. report_length: null before a record of it was read.
    differences: from its SCL. ignored_files: the first hundred of `ignored_files_in_all`.
    """

    gateway: str | None
    figures: LinkFigures
    changes: Listed[LinkChange]
    quarantine: Quarantine | None
    alarms: Listed[Alarm]
    acquisition: Acquisition | None
    report_length: ReportLength | None
    differences: Listed[Difference]
    ignored_files: Listed[IgnoredFile]
    ignored_files_in_all: int
