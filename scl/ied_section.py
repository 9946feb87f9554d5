"""The IED section (IEC 61850-6 clause 9.3): access points, logical devices and nodes, control blocks."""

from lxml import etree

from scl.data_model import (
    AccessPoint,
    DataSet,
    GooseControl,
    Ied,
    LogControl,
    LogicalDevice,
    LogicalNode,
    OptionalFields,
    ReportControl,
    SettingGroups,
)
from scl.data_sets import DataSetReader
from scl.document import Document, node_name
from scl.goose_addresses import GooseAddresses
from scl.instance_values import InstanceValues
from scl.templates import Templates, trigger_options

MOST_INSTANCES = 99
LONGEST_NAME = 64


class IedSection:
    """Reads one IED element."""

    def __init__(
        self,
        document: Document,
        element: etree._Element,
        templates: Templates,
        instance_values: InstanceValues,
        goose_addresses: GooseAddresses,
    ) -> None:
        self._document = document
        self._element = element
        self._templates = templates
        self._instance_values = instance_values
        self._goose_addresses = goose_addresses
        self._name = document.name(element, "name")
        # data sets name logical devices by inst, of any access point; their references need the domain
        self._domains: dict[str, str] = {}
        for point in document.children(element, "AccessPoint"):
            for device in document.children(document.child(point, "Server"), "LDevice"):
                self._add_domain(device)
        self._data_sets = DataSetReader(document, self._domains)

    def read(self) -> Ied:
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
            name=document.label(element, "name"),
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
        if "LLN0" not in nodes:
            document.note(element, "no LN0")
        return LogicalDevice(
            inst=inst,
            name=self._domains[inst],
            description=element.get("desc", ""),
            logical_nodes=tuple(nodes.values()),
            named=bool(element.get("ldName")),
        )

    def _logical_node(self, element: etree._Element, device: str) -> LogicalNode:
        document = self._document
        prefix, ln_class, inst = node_name(document, element, "inst")
        reference = f"{self._domains[device]}/{prefix}{ln_class}{inst}"
        if len(prefix + ln_class + inst) > LONGEST_NAME:
            raise document.error(element, f"a name of at most {LONGEST_NAME} characters", reference)
        data_sets = self._data_sets.data_sets(element, reference, device)
        settings = document.child(element, "SettingControl")
        return LogicalNode(
            reference=reference,
            prefix=prefix,
            ln_class=ln_class,
            inst=inst,
            description=element.get("desc", ""),
            data_objects=self._instance_values.laid_over(element, self._templates.data_objects(element)),
            data_sets=tuple(data_sets.values()),
            report_controls=tuple(
                self._report_control(child, reference, data_sets)
                for child in document.children(element, "ReportControl")
            ),
            log_controls=tuple(
                self._log_control(child, data_sets) for child in document.children(element, "LogControl")
            ),
            logs=tuple(
                document.name(child, "name", default="GeneralLog")
                for child in document.children(element, "Log")
            ),
            goose_controls=tuple(
                self._goose_control(child, device, data_sets)
                for child in document.children(element, "GSEControl")
                if child.get("type", "GOOSE") == "GOOSE"
            ),
            setting_groups=None if settings is None else self._setting_groups(settings),
        )

    def _report_control(
        self, element: etree._Element, node: str, data_sets: dict[str, DataSet]
    ) -> ReportControl:
        document = self._document
        name = document.name(element, "name")
        buffered = document.boolean(element, "buffered")
        enabled = document.child(element, "RptEnabled")
        maximum = 1 if enabled is None else document.integer(enabled, "max", 1, maximum=MOST_INSTANCES)
        numbers = (
            [f"{number:02d}" for number in range(1, maximum + 1)]
            if document.boolean(element, "indexed", default=True)
            else [""]
        )
        kind = "BR" if buffered else "RP"
        return ReportControl(
            name=name,
            references=tuple(f"{node}.{kind}.{name}{number}" for number in numbers),
            buffered=buffered,
            data_set=self._data_set_of(element, data_sets),
            report_id=element.get("rptID") or None,
            configuration_revision=document.integer(element, "confRev", 0),
            trigger_options=trigger_options(
                document, document.child(element, "TrgOps"), general_interrogation=True
            ),
            optional_fields=_optional_fields(document, document.child(element, "OptFields")),
            buffer_time_ms=document.integer(element, "bufTime", 0),
            integrity_period_ms=document.integer(element, "intgPd", 0),
        )

    def _data_set_of(self, element: etree._Element, data_sets: dict[str, DataSet]) -> DataSet | None:
        name = element.get("datSet")
        if name and name not in data_sets:
            self._document.note(element, f"no DataSet {name!r} in this logical node: taken as none")
        return data_sets.get(name) if name else None

    def _log_control(self, element: etree._Element, data_sets: dict[str, DataSet]) -> LogControl:
        document = self._document
        data_set = self._data_set_of(element, data_sets)
        return LogControl(
            name=document.name(element, "name"),
            data_set=None if data_set is None else data_set.name,
            log=element.get("logName") and document.name(element, "logName"),
            trigger_options=trigger_options(
                document, document.child(element, "TrgOps"), general_interrogation=True
            ),
            integrity_period_ms=document.integer(element, "intgPd", 0),
            enabled=document.boolean(element, "logEna", default=True),
            reason_code=document.boolean(element, "reasonCode", default=True),
        )

    def _goose_control(
        self, element: etree._Element, device: str, data_sets: dict[str, DataSet]
    ) -> GooseControl:
        document = self._document
        name = document.name(element, "name")
        data_set = self._data_set_of(element, data_sets)
        return GooseControl(
            name=name,
            application_id=document.required(element, "appID"),
            data_set=None if data_set is None else data_set.name,
            configuration_revision=document.integer(element, "confRev", 0),
            fixed_offsets=document.boolean(element, "fixedOffs"),
            address=self._goose_addresses.get((self._name, device, name)),
        )

    def _setting_groups(self, element: etree._Element) -> SettingGroups:
        number = self._document.integer(element, "numOfSGs", 1, maximum=255)
        return SettingGroups(number, self._document.integer(element, "actSG", 1, maximum=255))


def _optional_fields(document: Document, element: etree._Element | None) -> OptionalFields:
    fields = OptionalFields.NONE
    for attribute, field in (
        ("seqNum", OptionalFields.SEQUENCE_NUMBER),
        ("timeStamp", OptionalFields.TIME_STAMP),
        ("reasonCode", OptionalFields.REASON_CODE),
        ("dataSet", OptionalFields.DATA_SET),
        ("dataRef", OptionalFields.DATA_REFERENCE),
        ("bufOvfl", OptionalFields.BUFFER_OVERFLOW),
        ("entryID", OptionalFields.ENTRY_ID),
        ("configRef", OptionalFields.CONFIGURATION_REVISION),
    ):
        if document.boolean(element, attribute, default=attribute == "bufOvfl"):
            fields |= field
    return fields
