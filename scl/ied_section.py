"""The IED section (IEC 61850-6 clause 9.3): access points, logical devices and logical nodes."""

from lxml import etree

from scl.control_blocks import ControlBlockReader
from scl.data_model import DataObject
from scl.data_sets import DataSetReader
from scl.document import Document
from scl.errors import SclError
from scl.ied_model import AccessPoint, Ied, LogicalDevice
from scl.instance_values import InstanceValues
from scl.logical_node import LogicalNode
from scl.multicast_addresses import MulticastAddresses
from scl.templates import NodeType, Templates

LONGEST_NAME = 64
MOST_ATTRIBUTES = 1_000_000
"""Of an IED, with the elements of its arrays."""
LONGEST_REFERENCE = 128
DEFAULT_LOG = "GeneralLog"


class IedSection:
    """Reads one IED element. Logical devices and nodes that cannot be used are left out with a finding.

    Parameters
    ----------
    document : Document
        The document.
    element : lxml.etree._Element
        The IED element.
    templates : Templates
        Data types of the document.
    instance_values : InstanceValues
        Sets the values of instances over the defaults of the types.
    addresses : MulticastAddresses
        Multicast addresses of the communication section.

    Raises
    ------
    SclError
        The IED has no usable name.
    """

    def __init__(
        self,
        document: Document,
        element: etree._Element,
        templates: Templates,
        instance_values: InstanceValues,
        addresses: MulticastAddresses,
    ) -> None:
        self._document = document
        self._element = element
        self._templates = templates
        self._instance_values = instance_values
        self._addresses = addresses
        self.name = document.name(element, "name")
        self._type = element.get("type", "")
        # A data set names logical devices by inst, of any access point; its references need the domain.
        self._domains: dict[str, str] = {}
        self._devices: dict[etree._Element, str] = {}
        self._attributes = 0
        for point in document.children(element, "AccessPoint"):
            for device in document.children(document.child(point, "Server"), "LDevice"):
                try:
                    self._add_domain(device)
                except SclError as error:
                    document.leave_out(device, error)
        self._data_sets = DataSetReader(document, self._domains)

    def read(self) -> Ied:
        """Read the IED.

        Returns
        -------
        Ied
            The IED with its resolved data model.
        """
        document, element = self._document, self._element
        services = document.child(element, "Services")
        ied = Ied(
            name=self.name,
            manufacturer=element.get("manufacturer", ""),
            type=element.get("type", ""),
            description=element.get("desc", ""),
            configuration_version=element.get("configVersion", ""),
            access_points=tuple(
                self._access_point(point) for point in document.children(element, "AccessPoint")
            ),
            reports_show_owner=document.boolean(document.child(services, "ReportSettings"), "owner"),
        )
        self._data_sets.check(ied)
        return ied

    def _add_domain(self, device: etree._Element) -> None:
        document = self._document
        inst = document.name(device, "inst")
        domain = document.name(device, "ldName") if device.get("ldName") else f"{self.name}{inst}"
        if inst in self._domains or domain in self._domains.values():
            raise document.error(device, "one LDevice of each inst and name in an IED", "a second one")
        if len(domain) > LONGEST_NAME:
            raise document.error(
                device, f"an IED name and inst of at most {LONGEST_NAME} characters together", domain
            )
        self._domains[inst] = domain
        self._devices[device] = inst

    def _access_point(self, element: etree._Element) -> AccessPoint:
        document = self._document
        server = document.child(element, "Server")
        return AccessPoint(
            name=element.get("name", ""),
            description=element.get("desc", ""),
            logical_devices=tuple(
                self._logical_device(device, self._devices[device])
                for device in document.children(server, "LDevice")
                if device in self._devices
            ),
        )

    def _logical_device(self, element: etree._Element, inst: str) -> LogicalDevice:
        document = self._document
        nodes: dict[str, LogicalNode] = {}
        for child in [*document.children(element, "LN0"), *document.children(element, "LN")]:
            try:
                node = self._logical_node(child, inst)
            except SclError as error:
                document.leave_out(child, error)
                continue
            if node.name in nodes:
                document.leave_out(child, f"a second logical node {node.name}, the first one counts")
            else:
                nodes[node.name] = node
        return LogicalDevice(
            inst=inst,
            name=self._domains[inst],
            description=element.get("desc", ""),
            logical_nodes=tuple(nodes.values()),
            named=bool(element.get("ldName")),
        )

    def _logical_node(self, element: etree._Element, device: str) -> LogicalNode:
        document = self._document
        prefix, ln_class, inst = _node_name(document, element)
        reference = f"{self._domains[device]}/{prefix}{ln_class}{inst}"
        if len(prefix + ln_class + inst) > LONGEST_NAME:
            raise document.error(element, f"a name of at most {LONGEST_NAME} characters", reference)
        node_type = self._node_type(element, ln_class)
        parts = document.grouped(element)
        data_sets = self._data_sets.data_sets(parts["DataSet"], reference, device)
        blocks = ControlBlockReader(
            document, self._addresses, ied=self.name, device=device, node=reference, data_sets=data_sets
        )
        return LogicalNode(
            reference=reference,
            prefix=prefix,
            ln_class=ln_class,
            inst=inst,
            description=element.get("desc", ""),
            data_objects=self._instance_values.apply(
                element,
                self._nameable(element, self._domains[device], f"{prefix}{ln_class}{inst}", node_type),
            ),
            data_sets=tuple(data_sets.values()),
            report_controls=blocks.reports(parts["ReportControl"]),
            log_controls=blocks.logs(parts["LogControl"]),
            logs=tuple(document.usable_name(log, "name") or DEFAULT_LOG for log in parts["Log"]),
            goose_controls=blocks.goose(parts["GSEControl"]),
            sampled_value_controls=blocks.sampled_values(parts["SampledValueControl"]),
            setting_groups=blocks.setting_groups(parts["SettingControl"]),
        )

    def _node_type(self, element: etree._Element, ln_class: str) -> NodeType:
        """Return the node's type. A node without one still has its data sets and control blocks."""
        try:
            node_type = self._templates.node_type(element, ln_class, self._type)
            self._count(element, node_type)
        except SclError as error:
            self._document.leave_out(element, error, "its data objects are left out")
            return NodeType()
        return node_type

    def _count(self, element: etree._Element, node_type: NodeType) -> None:
        if self._attributes + node_type.attributes > MOST_ATTRIBUTES:
            expected = f"at most {MOST_ATTRIBUTES} attributes in an IED"
            raise self._document.error(
                element, expected, f"{node_type.attributes} more than there is room for"
            )
        self._attributes += node_type.attributes

    def _nameable(
        self, element: etree._Element, domain: str, node: str, node_type: NodeType
    ) -> tuple[DataObject, ...]:
        """Return the data objects whose attributes all have names that clients can use."""
        before_path, before_listed = len(f"{domain}/{node}."), len(f"{node}$ST$")
        if before_path + node_type.characters <= LONGEST_NAME:
            return node_type.data_objects
        kept = []
        for data_object, (path, listed) in zip(node_type.data_objects, node_type.extents, strict=True):
            name, reference = before_listed + listed, before_path + path
            if name <= LONGEST_NAME and reference <= LONGEST_REFERENCE:
                kept.append(data_object)
                continue
            self._document.leave_out(
                element,
                f"its longest MMS name has {name} characters and its longest reference {reference}, "
                f"with at most {LONGEST_NAME} and {LONGEST_REFERENCE} allowed",
                f"{data_object.name} is left out",
            )
        return tuple(kept)


def _node_name(document: Document, element: etree._Element) -> tuple[str, str, str]:
    """Return prefix, class and instance number of an LN or LN0."""
    is_node_zero = etree.QName(element).localname == "LN0"
    return (
        document.name(element, "prefix", default=""),
        document.name(element, "lnClass", default="LLN0" if is_node_zero else None),
        document.name(element, "inst", default=""),
    )
