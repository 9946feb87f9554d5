"""The data model of an IED: logical devices and nodes, data objects and attributes (IEC 61850-7-2, -7-3).

References are written as in IEC 61850-8-1 clause 7: domain/LogicalNode.DataObject.attribute. Types are
resolved: a data object carries its attributes and their initial values, instance values over type defaults.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from enum import Flag, StrEnum

CONTROL_MODELS = (
    "status-only",
    "direct-with-normal-security",
    "sbo-with-normal-security",
    "direct-with-enhanced-security",
    "sbo-with-enhanced-security",
)


class FunctionalConstraint(StrEnum):
    """Functional constraints of IEC 61850-7-2 table 18 that data attributes can have."""

    ST = "ST"
    MX = "MX"
    SP = "SP"
    SV = "SV"
    CF = "CF"
    DC = "DC"
    SG = "SG"
    SE = "SE"
    SR = "SR"
    OR = "OR"
    BL = "BL"
    EX = "EX"
    CO = "CO"


class TriggerOptions(Flag):
    """What makes a report or log entry (IEC 61850-7-2, TriggerConditions)."""

    NONE = 0
    DATA_CHANGE = 1
    QUALITY_CHANGE = 2
    DATA_UPDATE = 4
    INTEGRITY = 8
    GENERAL_INTERROGATION = 16


class OptionalFields(Flag):
    """What a report carries besides the values (IEC 61850-7-2, PACKED LIST OptFlds)."""

    NONE = 0
    SEQUENCE_NUMBER = 1
    TIME_STAMP = 2
    REASON_CODE = 4
    DATA_SET = 8
    DATA_REFERENCE = 16
    BUFFER_OVERFLOW = 32
    ENTRY_ID = 64
    CONFIGURATION_REVISION = 128


@dataclass(frozen=True, slots=True)
class Enumeration:
    """An EnumType: names by ordinal."""

    id: str
    literals: tuple[tuple[int, str], ...]

    def ordinal(self, text: str) -> int | None:
        """Ordinal of a literal, or of an ordinal written as a number; None when it is neither."""
        for number, literal in self.literals:
            if literal == text:
                return number
        return int(text) if re.fullmatch(r"[+-]?[0-9]{1,10}", text) else None


@dataclass(frozen=True, slots=True)
class DataAttribute:
    """An attribute with its functional constraint; `attributes` are the components of a Struct.

    basic_type: the SCL's bType ("BOOLEAN", "FLOAT32", "Enum", "Struct" ...).
    value: initial value as written in the file; None where the file gives none.
    count: number of array elements, 0 for no array.
    """

    name: str
    fc: FunctionalConstraint
    basic_type: str
    trigger_options: TriggerOptions = TriggerOptions.NONE
    value: str | None = None
    enumeration: Enumeration | None = None
    attributes: tuple["DataAttribute", ...] = ()
    count: int = 0

    @property
    def ordinal(self) -> int | None:
        """Ordinal of an enumeration's initial value."""
        if self.enumeration is None or self.value is None:
            return None
        return self.enumeration.ordinal(self.value)


@dataclass(frozen=True, slots=True)
class DataObject:
    """A data object of a common data class; `objects` are its sub data objects (phsA of a WYE)."""

    name: str
    common_data_class: str
    objects: tuple["DataObject", ...] = ()
    attributes: tuple[DataAttribute, ...] = ()
    count: int = 0
    transient: bool = False

    def find(self, path: str) -> "DataObject | DataAttribute | None":
        """Sub object or attribute at a path below this object, such as "phsA.cVal.mag.f"."""
        node: DataObject | DataAttribute | None = self
        for name in path.split("."):
            if node is None:
                return None
            children: tuple[DataObject | DataAttribute, ...] = node.attributes
            if isinstance(node, DataObject):
                children += node.objects
            node = next((child for child in children if child.name == name), None)
        return node

    @property
    def control_model(self) -> str | None:
        """Initial ctlModel, one of CONTROL_MODELS; None where the file gives none."""
        model = self.find("ctlModel")
        ordinal = model.ordinal if isinstance(model, DataAttribute) else None
        return CONTROL_MODELS[ordinal] if ordinal is not None and ordinal in range(5) else None

    def constraints(self) -> frozenset[FunctionalConstraint]:
        """Functional constraints that occur anywhere in the object."""
        below = (child.constraints() for child in self.objects)
        return frozenset(attribute.fc for attribute in self.attributes).union(*below)


@dataclass(frozen=True, slots=True)
class DataSetMember:
    """An FCDA. reference: full reference of the object or attribute.

    logical_device: inst; path: below the logical node, without array index; index: array element or None.
    """

    reference: str
    fc: FunctionalConstraint
    logical_device: str
    logical_node: str
    path: str
    index: int | None = None

    def covers(self, reference: str) -> bool:
        """Whether a report of this member carries the referenced object, or part of it."""
        return f"{self.reference}.".startswith(f"{reference}.") or f"{reference}.".startswith(
            f"{self.reference}."
        )


@dataclass(frozen=True, slots=True)
class DataSet:
    """An ordered list of members; reference as in "A1_SEL710CFG/LLN0.DSet01"."""

    name: str
    reference: str
    members: tuple[DataSetMember, ...]

    def covers(self, reference: str) -> bool:
        """Whether a member carries the referenced object, or part of it."""
        return any(member.covers(reference) for member in self.members)


@dataclass(frozen=True, slots=True)
class ReportControl:
    """A report control: one SCL element, `instances` control blocks, each for one client at a time.

    references: of the control blocks as clients address them ("A1_SEL710CFG/LLN0.BR.BRep01").
    data_set: the data set's own name, or None.  buffer_time_ms, integrity_period_ms [ms].
    """

    name: str
    references: tuple[str, ...]
    buffered: bool
    data_set: DataSet | None
    report_id: str | None
    configuration_revision: int
    trigger_options: TriggerOptions
    optional_fields: OptionalFields
    buffer_time_ms: int
    integrity_period_ms: int

    @property
    def instances(self) -> tuple[str, ...]:
        """Names of the control blocks: the name itself, or with the numbers of an indexed one."""
        return tuple(reference.rpartition(".")[2] for reference in self.references)


@dataclass(frozen=True, slots=True)
class LogControl:
    name: str
    data_set: str | None
    log: str | None
    trigger_options: TriggerOptions
    integrity_period_ms: int
    enabled: bool
    reason_code: bool


@dataclass(frozen=True, slots=True)
class MulticastAddress:
    """mac: six bytes. Times in ms, None where the file gives none."""

    mac: bytes
    application_id: int
    vlan_id: int
    vlan_priority: int
    minimum_time_ms: int | None = None
    maximum_time_ms: int | None = None


@dataclass(frozen=True, slots=True)
class GooseControl:
    """A GOOSE control block; the multicast address is None where the communication section has none."""

    name: str
    application_id: str
    data_set: str | None
    configuration_revision: int
    fixed_offsets: bool
    address: MulticastAddress | None = None


@dataclass(frozen=True, slots=True)
class SampledValueControl:
    """sample_mode: what sample_rate counts: 0 samples a period, 1 samples a second, 2 seconds a sample."""

    name: str
    stream_id: str
    data_set: str | None
    configuration_revision: int
    sample_mode: int
    sample_rate: int
    multicast: bool
    address: MulticastAddress | None = None


@dataclass(frozen=True, slots=True)
class SettingGroups:
    number: int
    active: int


@dataclass(frozen=True, slots=True)
class LogicalNode:
    """A logical node; `reference` as in "A1_SEL710PRO/FLTRDRE1", `ln_class` as in "RDRE"."""

    reference: str
    prefix: str
    ln_class: str
    inst: str
    description: str
    data_objects: tuple[DataObject, ...]
    data_sets: tuple[DataSet, ...] = ()
    report_controls: tuple[ReportControl, ...] = ()
    log_controls: tuple[LogControl, ...] = ()
    logs: tuple[str, ...] = ()
    goose_controls: tuple[GooseControl, ...] = ()
    sampled_value_controls: tuple[SampledValueControl, ...] = ()
    setting_groups: SettingGroups | None = None

    @property
    def name(self) -> str:
        return f"{self.prefix}{self.ln_class}{self.inst}"

    def find(self, path: str) -> DataObject | DataAttribute | None:
        """Data object or attribute at a path below the node, such as "A.phsA.cVal.mag.f"."""
        name, _, rest = path.partition(".")
        found = next((child for child in self.data_objects if child.name == name), None)
        return found.find(rest) if found is not None and rest else found

    def holds(self, path: str, constraint: FunctionalConstraint) -> bool:
        """Whether there is data of a constraint at a path below the node."""
        return _has(self.find(path), constraint)


@dataclass(frozen=True, slots=True)
class PlacedObject:
    """A data object with the reference clients address it by."""

    reference: str
    data_object: DataObject


@dataclass(frozen=True, slots=True)
class LogicalDevice:
    """inst: its name in the IED; name: the MMS domain, the file's ldName (`named`) or IED name and inst."""

    inst: str
    name: str
    description: str
    logical_nodes: tuple[LogicalNode, ...]
    named: bool = False

    def logical_node(self, name: str) -> LogicalNode | None:
        return next((node for node in self.logical_nodes if node.name == name), None)


@dataclass(frozen=True, slots=True)
class AccessPoint:
    name: str
    description: str
    logical_devices: tuple[LogicalDevice, ...]


@dataclass(frozen=True, slots=True)
class Ied:
    """An intelligent electronic device: here a motor protection relay."""

    name: str
    manufacturer: str
    type: str
    description: str
    configuration_version: str
    access_points: tuple[AccessPoint, ...]
    reports_show_owner: bool = False

    @property
    def logical_devices(self) -> tuple[LogicalDevice, ...]:
        """Of every access point's server."""
        return tuple(device for point in self.access_points for device in point.logical_devices)

    def logical_nodes(self, ln_class: str | None = None) -> tuple[LogicalNode, ...]:
        """All logical nodes, or those of one class ("RDRE")."""
        return tuple(
            node
            for device in self.logical_devices
            for node in device.logical_nodes
            if ln_class in (None, node.ln_class)
        )

    def data_objects(
        self, *, ln_class: str | None = None, name: str | None = None, common_data_class: str | None = None
    ) -> tuple[PlacedObject, ...]:
        """Data objects by logical node class ("RDRE"), name ("RcdMade") and CDC ("SPC"), in file order."""
        return tuple(
            PlacedObject(f"{node.reference}.{data_object.name}", data_object)
            for node in self.logical_nodes(ln_class)
            for data_object in node.data_objects
            if name in (None, data_object.name) and common_data_class in (None, data_object.common_data_class)
        )

    def find(self, reference: str) -> DataObject | DataAttribute | None:
        """Object or attribute by full reference; a logical device's inst may stand for its domain."""
        domain, _, rest = reference.partition("/")
        node_name, _, path = rest.partition(".")
        for device in self.logical_devices:
            node = device.logical_node(node_name) if domain in (device.name, device.inst) else None
            if node is not None and path:
                return node.find(path)
        return None

    def resolve(self, member: DataSetMember) -> DataObject | DataAttribute | None:
        """What a data set member names; None when the data model has no such data of its constraint."""
        found = self.find(f"{member.logical_device}/{member.logical_node}.{member.path}")
        return found if _has(found, member.fc) else None

    def data_sets(self, *, covering: str | None = None) -> tuple[DataSet, ...]:
        """All data sets, or those with a member that covers a reference."""
        return tuple(
            data_set
            for node in self.logical_nodes()
            for data_set in node.data_sets
            if covering is None or data_set.covers(covering)
        )

    def report_controls(
        self, *, buffered: bool | None = None, covering: str | None = None
    ) -> tuple[ReportControl, ...]:
        """Report controls, buffered or not, whose data set covers a reference, in file order."""
        return tuple(self._matching_reports(buffered, covering))

    def _matching_reports(self, buffered: bool | None, covering: str | None) -> Iterator[ReportControl]:
        for node in self.logical_nodes():
            for report in node.report_controls:
                if buffered not in (None, report.buffered):
                    continue
                if covering is None or (report.data_set is not None and report.data_set.covers(covering)):
                    yield report


def _has(found: DataObject | DataAttribute | None, constraint: FunctionalConstraint) -> bool:
    """Whether what was found has data of a constraint; an editable setting is read as the active one too."""
    constraints = found.constraints() if isinstance(found, DataObject) else {found.fc} if found else set()
    editable = constraint is FunctionalConstraint.SG and FunctionalConstraint.SE in constraints
    return constraint in constraints or editable
