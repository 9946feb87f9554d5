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
    """What a report carries besides the values (IEC 61850-7-2, OptFlds)."""

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
    """An EnumType: names by ordinal.

    Parameters
    ----------
    id : str
        The type's id.
    literals : tuple of tuple of int and str
        Ordinals and names.
    """

    id: str
    literals: tuple[tuple[int, str], ...]

    def ordinal(self, text: str) -> int | None:
        """Find the ordinal of a literal, or of an ordinal written as a number.

        Parameters
        ----------
        text : str
            The literal or number.

        Returns
        -------
        int or None
            The ordinal; None if the text is neither.
        """
        for number, literal in self.literals:
            if literal == text:
                return number
        return int(text) if re.fullmatch(r"[+-]?[0-9]{1,10}", text) else None


@dataclass(frozen=True, slots=True)
class DataAttribute:
    """A data attribute with its functional constraint.

    Parameters
    ----------
    name : str
        Name of the attribute.
    fc : FunctionalConstraint
        Its functional constraint.
    basic_type : str
        The SCL's bType ("BOOLEAN", "FLOAT32", "Enum", "Struct" and so on).
    trigger_options : TriggerOptions
        Changes that make a report.
    value : str or None
        Initial value as written in the file; None where the file gives none.
    enumeration : Enumeration or None
        Type of an Enum.
    attributes : tuple of DataAttribute
        Components of a Struct.
    count : int
        Number of array elements, 0 for no array.
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
        """Ordinal of an enumeration's initial value; None where there is none."""
        if self.enumeration is None or self.value is None:
            return None
        return self.enumeration.ordinal(self.value)


@dataclass(frozen=True, slots=True)
class DataObject:
    """A data object of a common data class.

    Parameters
    ----------
    name : str
        Name of the object.
    common_data_class : str
        Its CDC, such as "SPC".
    objects : tuple of DataObject
        Sub data objects, such as phsA of a WYE.
    attributes : tuple of DataAttribute
        Its attributes.
    count : int
        Number of array elements, 0 for no array.
    transient : bool
        Whether the object is transient: it falls back by itself.
    """

    name: str
    common_data_class: str
    objects: tuple["DataObject", ...] = ()
    attributes: tuple[DataAttribute, ...] = ()
    count: int = 0
    transient: bool = False

    def find(self, path: str) -> "DataObject | DataAttribute | None":
        """Find a sub object or attribute below this object.

        Parameters
        ----------
        path : str
            Path such as "phsA.cVal.mag.f".

        Returns
        -------
        DataObject or DataAttribute or None
            What was found; None where there is nothing.
        """
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
        """Collect the functional constraints that occur anywhere in the object.

        Returns
        -------
        frozenset of FunctionalConstraint
            The constraints.
        """
        below = (child.constraints() for child in self.objects)
        return frozenset(attribute.fc for attribute in self.attributes).union(*below)


@dataclass(frozen=True, slots=True)
class DataSetMember:
    """A member of a data set (FCDA).

    Parameters
    ----------
    reference : str
        Full reference of the object or attribute.
    fc : FunctionalConstraint
        Its functional constraint.
    logical_device : str
        The inst of its logical device.
    logical_node : str
        Name of its logical node.
    path : str
        Path below the logical node, without array index.
    index : int or None
        Array element; None for none.
    """

    reference: str
    fc: FunctionalConstraint
    logical_device: str
    logical_node: str
    path: str
    index: int | None = None

    def covers(self, reference: str) -> bool:
        """Tell whether a report of this member carries a referenced object, or part of it.

        Parameters
        ----------
        reference : str
            Full reference of the object or attribute.

        Returns
        -------
        bool
            True if it does.
        """
        return f"{self.reference}.".startswith(f"{reference}.") or f"{reference}.".startswith(
            f"{self.reference}."
        )


@dataclass(frozen=True, slots=True)
class DataSet:
    """An ordered list of members.

    Parameters
    ----------
    name : str
        Name of the data set.
    reference : str
        Reference such as "A1_SEL710CFG/LLN0.DSet01".
    members : tuple of DataSetMember
        The members in order.
    """

    name: str
    reference: str
    members: tuple[DataSetMember, ...]

    def covers(self, reference: str) -> bool:
        """Tell whether a member carries a referenced object, or part of it.

        Parameters
        ----------
        reference : str
            Full reference of the object or attribute.

        Returns
        -------
        bool
            True if one does.
        """
        return any(member.covers(reference) for member in self.members)


@dataclass(frozen=True, slots=True)
class ReportControl:
    """A report control: one SCL element for one or more control blocks, each for one client at a time.

    Parameters
    ----------
    name : str
        Name of the report control.
    references : tuple of str
        References of the control blocks as clients address them ("A1_SEL710CFG/LLN0.BR.BRep01").
    buffered : bool
        Whether the blocks buffer reports while no client has them.
    data_set : DataSet or None
        The data set that is reported.
    report_id : str or None
        RptID.
    configuration_revision : int
        ConfRev.
    trigger_options : TriggerOptions
        What makes a report.
    optional_fields : OptionalFields
        What a report carries besides the values.
    buffer_time_ms : int
        Time in which changes are collected into one report [ms].
    integrity_period_ms : int
        Period of reports of all members [ms]; 0 for none.

    References
    ----------
    IEC 61850-7-2 clause 17; IEC 61850-6 clause 9.3.8.
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
    """A log control block.

    Parameters
    ----------
    name : str
        Name of the block.
    data_set : str or None
        Name of the data set that is logged.
    log : str or None
        Name of the log.
    trigger_options : TriggerOptions
        What makes an entry.
    integrity_period_ms : int
        Period of entries of all members [ms]; 0 for none.
    enabled : bool
        Whether logging is on at first.
    reason_code : bool
        Whether entries carry the reason.
    """

    name: str
    data_set: str | None
    log: str | None
    trigger_options: TriggerOptions
    integrity_period_ms: int
    enabled: bool
    reason_code: bool


@dataclass(frozen=True, slots=True)
class MulticastAddress:
    """Multicast address of a GOOSE or sampled value control block.

    Parameters
    ----------
    mac : bytes
        Six octets of the MAC address.
    application_id : int
        APPID.
    vlan_id : int
        Virtual LAN.
    vlan_priority : int
        Priority in the virtual LAN, 0 to 7.
    minimum_time_ms : int or None
        Shortest time between retransmissions [ms]; None where the file gives none.
    maximum_time_ms : int or None
        Longest time between retransmissions [ms]; None where the file gives none.
    """

    mac: bytes
    application_id: int
    vlan_id: int
    vlan_priority: int
    minimum_time_ms: int | None = None
    maximum_time_ms: int | None = None


@dataclass(frozen=True, slots=True)
class GooseControl:
    """A GOOSE control block.

    Parameters
    ----------
    name : str
        Name of the block.
    application_id : str
        Identification of the application, appID.
    data_set : str or None
        Name of the data set that is sent.
    configuration_revision : int
        ConfRev.
    fixed_offsets : bool
        Whether the encoding has fixed offsets.
    address : MulticastAddress or None
        Where it is sent; None where the communication section has no address.
    """

    name: str
    application_id: str
    data_set: str | None
    configuration_revision: int
    fixed_offsets: bool
    address: MulticastAddress | None = None


@dataclass(frozen=True, slots=True)
class SampledValueControl:
    """A sampled value control block.

    Parameters
    ----------
    name : str
        Name of the block.
    stream_id : str
        Identification of the stream, smvID.
    data_set : str or None
        Name of the data set that is sent.
    configuration_revision : int
        ConfRev.
    sample_mode : int
        What the sample rate counts: 0 samples a period, 1 samples a second, 2 seconds a sample.
    sample_rate : int
        Sample rate in the unit of the mode.
    multicast : bool
        Whether the stream is multicast.
    address : MulticastAddress or None
        Where it is sent; None where the communication section has no address.
    """

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
    """Setting groups of a logical device.

    Parameters
    ----------
    number : int
        Number of groups.
    active : int
        The active group, from 1.
    """

    number: int
    active: int


@dataclass(frozen=True, slots=True)
class LogicalNode:
    """A logical node with its data and control blocks.

    Parameters
    ----------
    reference : str
        Reference such as "A1_SEL710PRO/FLTRDRE1".
    prefix : str
        Prefix of the name.
    ln_class : str
        Class, such as "RDRE".
    inst : str
        Instance number.
    description : str
        Description for people.
    data_objects : tuple of DataObject
        Its data objects.
    data_sets : tuple of DataSet
        Its data sets.
    report_controls : tuple of ReportControl
        Its report controls.
    log_controls : tuple of LogControl
        Its log controls.
    logs : tuple of str
        Names of its logs.
    goose_controls : tuple of GooseControl
        Its GOOSE controls.
    sampled_value_controls : tuple of SampledValueControl
        Its sampled value controls.
    setting_groups : SettingGroups or None
        The setting groups, of LLN0 only.
    """

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
        """Name of the node: prefix, class and instance number."""
        return f"{self.prefix}{self.ln_class}{self.inst}"

    def find(self, path: str) -> DataObject | DataAttribute | None:
        """Find a data object or attribute below the node.

        Parameters
        ----------
        path : str
            Path such as "A.phsA.cVal.mag.f".

        Returns
        -------
        DataObject or DataAttribute or None
            What was found; None where there is nothing.
        """
        name, _, rest = path.partition(".")
        found = next((child for child in self.data_objects if child.name == name), None)
        return found.find(rest) if found is not None and rest else found

    def holds(self, path: str, constraint: FunctionalConstraint) -> bool:
        """Tell whether there is data of a constraint at a path below the node.

        Parameters
        ----------
        path : str
            Path such as "A.phsA".
        constraint : FunctionalConstraint
            Functional constraint of the data.

        Returns
        -------
        bool
            True if there is.
        """
        return _has(self.find(path), constraint)


@dataclass(frozen=True, slots=True)
class PlacedObject:
    """A data object with the reference that clients address it by.

    Parameters
    ----------
    reference : str
        Reference of the object.
    data_object : DataObject
        The object.
    """

    reference: str
    data_object: DataObject


@dataclass(frozen=True, slots=True)
class LogicalDevice:
    """A logical device of an IED.

    Parameters
    ----------
    inst : str
        Its name in the IED.
    name : str
        The MMS domain: the file's ldName, or the IED's name and the inst.
    description : str
        Description for people.
    logical_nodes : tuple of LogicalNode
        Its logical nodes, LLN0 first.
    named : bool
        Whether the file gives an ldName.
    """

    inst: str
    name: str
    description: str
    logical_nodes: tuple[LogicalNode, ...]
    named: bool = False

    def logical_node(self, name: str) -> LogicalNode | None:
        """Find a logical node by its name.

        Parameters
        ----------
        name : str
            Name such as "FLTRDRE1".

        Returns
        -------
        LogicalNode or None
            The node; None where there is none of this name.
        """
        return next((node for node in self.logical_nodes if node.name == name), None)


@dataclass(frozen=True, slots=True)
class AccessPoint:
    """An access point of an IED with the logical devices of its server.

    Parameters
    ----------
    name : str
        Name of the access point.
    description : str
        Description for people.
    logical_devices : tuple of LogicalDevice
        Logical devices of its server; empty without one.
    """

    name: str
    description: str
    logical_devices: tuple[LogicalDevice, ...]


@dataclass(frozen=True, slots=True)
class Ied:
    """An intelligent electronic device; here a motor protection relay.

    Parameters
    ----------
    name : str
        Name of the IED.
    manufacturer : str
        Its manufacturer.
    type : str
        Its type.
    description : str
        Description for people.
    configuration_version : str
        Version of its configuration.
    access_points : tuple of AccessPoint
        Its access points.
    reports_show_owner : bool
        Whether report control blocks tell which client has them.
    """

    name: str
    manufacturer: str
    type: str
    description: str
    configuration_version: str
    access_points: tuple[AccessPoint, ...]
    reports_show_owner: bool = False

    @property
    def logical_devices(self) -> tuple[LogicalDevice, ...]:
        """Logical devices of the servers of all access points."""
        return tuple(device for point in self.access_points for device in point.logical_devices)

    def logical_nodes(self, ln_class: str | None = None) -> tuple[LogicalNode, ...]:
        """List the logical nodes.

        Parameters
        ----------
        ln_class : str, optional
            Class of the nodes, such as "RDRE". All by default.

        Returns
        -------
        tuple of LogicalNode
            The nodes in file order.
        """
        return tuple(
            node
            for device in self.logical_devices
            for node in device.logical_nodes
            if ln_class in (None, node.ln_class)
        )

    def data_objects(
        self, *, ln_class: str | None = None, name: str | None = None, common_data_class: str | None = None
    ) -> tuple[PlacedObject, ...]:
        """List data objects.

        Parameters
        ----------
        ln_class : str, optional
            Class of their logical node, such as "RDRE".
        name : str, optional
            Their name, such as "RcdMade".
        common_data_class : str, optional
            Their CDC, such as "SPC".

        Returns
        -------
        tuple of PlacedObject
            Matching objects with their references, in file order.
        """
        return tuple(
            PlacedObject(f"{node.reference}.{data_object.name}", data_object)
            for node in self.logical_nodes(ln_class)
            for data_object in node.data_objects
            if name in (None, data_object.name) and common_data_class in (None, data_object.common_data_class)
        )

    def find(self, reference: str) -> DataObject | DataAttribute | None:
        """Find a data object or attribute by its full reference.

        Parameters
        ----------
        reference : str
            Full reference; the inst of a logical device may stand for its domain.

        Returns
        -------
        DataObject or DataAttribute or None
            What was found; None where there is nothing.
        """
        domain, _, rest = reference.partition("/")
        node_name, _, path = rest.partition(".")
        for device in self.logical_devices:
            node = device.logical_node(node_name) if domain in (device.name, device.inst) else None
            if node is not None and path:
                return node.find(path)
        return None

    def resolve(self, member: DataSetMember) -> DataObject | DataAttribute | None:
        """Find what a data set member names.

        Parameters
        ----------
        member : DataSetMember
            The member.

        Returns
        -------
        DataObject or DataAttribute or None
            What was found; None when the data model has no such data of the member's constraint.
        """
        found = self.find(f"{member.logical_device}/{member.logical_node}.{member.path}")
        return found if _has(found, member.fc) else None

    def data_sets(self, *, covering: str | None = None) -> tuple[DataSet, ...]:
        """List data sets.

        Parameters
        ----------
        covering : str, optional
            Full reference that a member must cover. All data sets by default.

        Returns
        -------
        tuple of DataSet
            The data sets in file order.
        """
        return tuple(
            data_set
            for node in self.logical_nodes()
            for data_set in node.data_sets
            if covering is None or data_set.covers(covering)
        )

    def report_controls(
        self, *, buffered: bool | None = None, covering: str | None = None
    ) -> tuple[ReportControl, ...]:
        """List report controls.

        Parameters
        ----------
        buffered : bool, optional
            Whether they are buffered. Both kinds by default.
        covering : str, optional
            Full reference that their data set must cover.

        Returns
        -------
        tuple of ReportControl
            Matching report controls in file order.
        """
        return tuple(self._matching_reports(buffered, covering))

    def _matching_reports(self, buffered: bool | None, covering: str | None) -> Iterator[ReportControl]:
        for node in self.logical_nodes():
            for report in node.report_controls:
                if buffered not in (None, report.buffered):
                    continue
                if covering is None or (report.data_set is not None and report.data_set.covers(covering)):
                    yield report


def _has(found: DataObject | DataAttribute | None, constraint: FunctionalConstraint) -> bool:
    """Tell whether what was found has data of a constraint; an editable setting also counts as active."""
    constraints = found.constraints() if isinstance(found, DataObject) else {found.fc} if found else set()
    editable = constraint is FunctionalConstraint.SG and FunctionalConstraint.SE in constraints
    return constraint in constraints or editable
