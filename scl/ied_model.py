"""An IED with its logical devices (IEC 61850-7-2)."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

from scl.control_block_model import DataSet, DataSetMember, ReportControl
from scl.data_model import DataAttribute, DataObject
from scl.logical_node import LogicalNode


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


@dataclass(frozen=True)
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

    @cached_property
    def logical_devices(self) -> tuple[LogicalDevice, ...]:
        """Logical devices of the servers of all access points."""
        return tuple(device for point in self.access_points for device in point.logical_devices)

    @cached_property
    def _first_of_inst(self) -> Mapping[str, LogicalDevice]:
        """Logical devices by their inst; the first of two in different access points."""
        return {device.inst: device for device in reversed(self.logical_devices)}

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
        device = self._first_of_inst.get(member.logical_device)
        return None if device is None else device.logical_node(member.logical_node)

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
