"""An IED with its logical devices and logical nodes (IEC 61850-7-2)."""

from collections.abc import Iterator
from dataclasses import dataclass

from scl.control_block_model import (
    DataSet,
    DataSetMember,
    GooseControl,
    LogControl,
    ReportControl,
    SampledValueControl,
    SettingGroups,
)
from scl.data_model import DataAttribute, DataObject, FunctionalConstraint


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

    def offers(self, member: DataSetMember) -> bool:
        """Tell whether the node has what a data set member names.

        Parameters
        ----------
        member : DataSetMember
            A member with data of this node.

        Returns
        -------
        bool
            False where the node has no such data of the constraint, or no such element of an array.
        """
        array = self.array_in(member.path)
        return self.holds(member.path, member.fc) and (array is None or _is_in_array(member, *array))

    def array_in(self, path: str) -> tuple[int, int] | None:
        """Find the first array on a path below the node.

        Parameters
        ----------
        path : str
            Path such as "HA.phsAHar.cVal".

        Returns
        -------
        tuple of int and int or None
            Number of names down to the array, and of its elements; None where there is no array.
        """
        names = path.split(".")
        found = self.find(names[0])
        for depth, name in enumerate(names[1:], 2):
            if isinstance(found, DataObject):
                found = found.find(name)
            elif found is not None:
                found = next((each for each in found.attributes if each.name == name), None)
            if found is not None and found.count:
                return depth, found.count
        return None


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
            What was found; None when the data model has no such data of the member's constraint, or no such
            element of an array.
        """
        node = self.node_of(member)
        return None if node is None or not node.offers(member) else node.find(member.path)

    def node_of(self, member: DataSetMember) -> LogicalNode | None:
        """Find the logical node of a data set member.

        Parameters
        ----------
        member : DataSetMember
            The member.

        Returns
        -------
        LogicalNode or None
            The node; None where the IED has none of its name.
        """
        for device in self.logical_devices:
            if device.inst == member.logical_device:
                return device.logical_node(member.logical_node)
        return None

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


def _is_in_array(member: DataSetMember, depth: int, count: int) -> bool:
    """Tell whether a member names an array, or with its index an element of it or a part of one."""
    if member.index is None:
        return depth == len(member.path.split("."))
    return member.index < count


def _has(found: DataObject | DataAttribute | None, constraint: FunctionalConstraint) -> bool:
    """Tell whether what was found has data of a constraint; an editable setting also counts as active."""
    constraints = found.constraints() if isinstance(found, DataObject) else {found.fc} if found else set()
    editable = constraint is FunctionalConstraint.SG and FunctionalConstraint.SE in constraints
    return constraint in constraints or editable
