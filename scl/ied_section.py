"""The IED section (IEC 61850-6 clause 9.3): access points, logical devices and logical nodes."""

from lxml import etree

from scl.control_blocks import ControlBlockReader
from scl.data_sets import DataSetReader
from scl.document import Document
from scl.ied_model import AccessPoint, Ied, LogicalDevice, LogicalNode
from scl.instance_values import InstanceValues
from scl.multicast_addresses import MulticastAddresses
from scl.templates import Templates

LONGEST_NAME = 64
DEFAULT_LOG = "GeneralLog"


class IedSection:
    """Reads one IED element.

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
        A name is missing, unusable or used twice.
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
        self._name = document.name(element, "name")
        self._type = element.get("type", "")
        # A data set names logical devices by inst, of any access point; its references need the domain.
        self._domains: dict[str, str] = {}
        for point in document.children(element, "AccessPoint"):
            for device in document.children(document.child(point, "Server"), "LDevice"):
                self._add_domain(device)
        self._data_sets = DataSetReader(document, self._domains)

    def read(self) -> Ied:
        """Read the IED.

        Returns
        -------
        Ied
            The IED with its resolved data model.

        Raises
        ------
        SclError
            The data model is unclear.
        """
        document, element = self._document, self._element
        services = document.child(element, "Services")
        ied = Ied(
            name=self._name,
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
        domain = document.name(device, "ldName") if device.get("ldName") else f"{self._name}{inst}"
        if inst in self._domains or domain in self._domains.values():
            raise document.error(device, "one LDevice of each inst and name in an IED", "a second one")
        if len(domain) > LONGEST_NAME:
            raise document.error(
                device, f"an IED name and inst of at most {LONGEST_NAME} characters together", domain
            )
        self._domains[inst] = domain

    def _access_point(self, element: etree._Element) -> AccessPoint:
        document = self._document
        server = document.child(element, "Server")
        return AccessPoint(
            name=element.get("name", ""),
            description=element.get("desc", ""),
            logical_devices=tuple(
                self._logical_device(device) for device in document.children(server, "LDevice")
            ),
        )

    def _logical_device(self, element: etree._Element) -> LogicalDevice:
        document = self._document
        inst = document.name(element, "inst")
        nodes: dict[str, LogicalNode] = {}
        for child in [*document.children(element, "LN0"), *document.children(element, "LN")]:
            node = self._logical_node(child, inst)
            if node.name in nodes:
                document.note(child, f"a second logical node {node.name}: the first one counts")
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
        parts = document.grouped(element)
        data_sets = self._data_sets.data_sets(parts["DataSet"], reference, device)
        blocks = ControlBlockReader(
            document, self._addresses, ied=self._name, device=device, node=reference, data_sets=data_sets
        )
        return LogicalNode(
            reference=reference,
            prefix=prefix,
            ln_class=ln_class,
            inst=inst,
            description=element.get("desc", ""),
            data_objects=self._instance_values.apply(
                element, self._templates.data_objects(element, ln_class, self._type)
            ),
            data_sets=tuple(data_sets.values()),
            report_controls=blocks.reports(parts["ReportControl"]),
            log_controls=blocks.logs(parts["LogControl"]),
            logs=tuple(document.usable_name(log, "name") or DEFAULT_LOG for log in parts["Log"]),
            goose_controls=blocks.goose(parts["GSEControl"]),
            sampled_value_controls=blocks.sampled_values(parts["SampledValueControl"]),
            setting_groups=blocks.setting_groups(parts["SettingControl"]),
        )


def _node_name(document: Document, element: etree._Element) -> tuple[str, str, str]:
    """Return prefix, class and instance number of an LN or LN0."""
    is_node_zero = etree.QName(element).localname == "LN0"
    return (
        document.name(element, "prefix", default=""),
        document.name(element, "lnClass", default="LLN0" if is_node_zero else None),
        document.name(element, "inst", default=""),
    )
