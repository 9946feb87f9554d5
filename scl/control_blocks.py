"""Control blocks of a logical node: reports, logs, GOOSE, sampled values, setting groups (IEC 61850-6).

A block that no client could address (without a usable name) is left out with a finding.
"""

from collections.abc import Iterator, Mapping

from lxml import etree

from scl.control_block_model import (
    DataSet,
    GooseControl,
    LogControl,
    OptionalFields,
    ReportControl,
    SampledValueControl,
    SettingGroups,
)
from scl.document import Document
from scl.multicast_addresses import MulticastAddresses
from scl.trigger_options import trigger_options

MOST_INSTANCES = 99
SAMPLE_MODES = ("SmpPerPeriod", "SmpPerSec", "SecPerSmp")


class ControlBlockReader:
    """Reads the control blocks of one logical node.

    Parameters
    ----------
    document : Document
        The document.
    addresses : MulticastAddresses
        Multicast addresses of its communication section.
    ied : str
        Name of the IED.
    device : str
        The inst of the logical device.
    node : str
        Reference of the logical node.
    data_sets : mapping of str to DataSet
        Data sets of the logical node by name.
    """

    def __init__(
        self,
        document: Document,
        addresses: MulticastAddresses,
        *,
        ied: str,
        device: str,
        node: str,
        data_sets: Mapping[str, DataSet],
    ) -> None:
        self._document = document
        self._addresses = addresses
        self._ied = ied
        self._device = device
        self._node = node
        self._data_sets = data_sets

    def _named(
        self, elements: Iterator[etree._Element] | list[etree._Element]
    ) -> Iterator[tuple[str, etree._Element]]:
        """Iterate over control blocks of one kind with their names, each name once."""
        seen: set[str] = set()
        for element in elements:
            name = self._document.usable_name(element, "name")
            if name is None:
                continue
            if name in seen:
                self._document.leave_out(element, "a second control block of this name, the first one counts")
                continue
            seen.add(name)
            yield name, element

    def reports(self, elements: list[etree._Element]) -> tuple[ReportControl, ...]:
        """Read report controls.

        Parameters
        ----------
        elements : list of lxml.etree._Element
            ReportControl elements.

        Returns
        -------
        tuple of ReportControl
            The report controls that clients can address.
        """
        return tuple(self._report(name, element) for name, element in self._named(elements))

    def logs(self, elements: list[etree._Element]) -> tuple[LogControl, ...]:
        """Read log controls.

        Parameters
        ----------
        elements : list of lxml.etree._Element
            LogControl elements.

        Returns
        -------
        tuple of LogControl
            The log controls that clients can address.
        """
        return tuple(self._log(name, element) for name, element in self._named(elements))

    def goose(self, elements: list[etree._Element]) -> tuple[GooseControl, ...]:
        """Read GOOSE controls. GSSE, the forerunner of GOOSE, carries no data set and is left out.

        Parameters
        ----------
        elements : list of lxml.etree._Element
            GSEControl elements.

        Returns
        -------
        tuple of GooseControl
            The GOOSE controls that clients can address.
        """
        kept = []
        for element in elements:
            if element.get("type") == "GSSE":
                self._document.leave_out(element, "GSSE, the forerunner of GOOSE, carries no data set")
            else:
                kept.append(element)
        return tuple(self._goose(name, element) for name, element in self._named(kept))

    def sampled_values(self, elements: list[etree._Element]) -> tuple[SampledValueControl, ...]:
        """Read sampled value controls.

        Parameters
        ----------
        elements : list of lxml.etree._Element
            SampledValueControl elements.

        Returns
        -------
        tuple of SampledValueControl
            The sampled value controls that clients can address.
        """
        return tuple(self._sampled_values(name, element) for name, element in self._named(elements))

    def setting_groups(self, elements: list[etree._Element]) -> SettingGroups | None:
        """Read the setting groups.

        Parameters
        ----------
        elements : list of lxml.etree._Element
            SettingControl elements, at most one by the schema.

        Returns
        -------
        SettingGroups or None
            The setting groups; None without an element.
        """
        if not elements:
            return None
        number = self._document.integer(elements[0], "numOfSGs", 1, maximum=255)
        return SettingGroups(number, self._document.integer(elements[0], "actSG", 1, maximum=255))

    def _report(self, name: str, element: etree._Element) -> ReportControl:
        document = self._document
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
            references=tuple(f"{self._node}.{kind}.{name}{number}" for number in numbers),
            buffered=buffered,
            data_set=self._data_set_of(element),
            report_id=element.get("rptID") or None,
            configuration_revision=document.integer(element, "confRev", 0),
            trigger_options=trigger_options(
                document, document.child(element, "TrgOps"), general_interrogation=True
            ),
            optional_fields=_optional_fields(document, document.child(element, "OptFields")),
            buffer_time_ms=document.integer(element, "bufTime", 0),
            integrity_period_ms=document.integer(element, "intgPd", 0),
        )

    def _data_set_of(self, element: etree._Element) -> DataSet | None:
        name = element.get("datSet")
        if name and name not in self._data_sets:
            self._document.note(element, f"no DataSet {name!r} in this logical node: taken as none")
        return self._data_sets.get(name) if name else None

    def _data_set_name(self, element: etree._Element) -> str | None:
        data_set = self._data_set_of(element)
        return None if data_set is None else data_set.name

    def _log(self, name: str, element: etree._Element) -> LogControl:
        document = self._document
        return LogControl(
            name=name,
            data_set=self._data_set_name(element),
            log=document.usable_name(element, "logName") if element.get("logName") else None,
            trigger_options=trigger_options(
                document, document.child(element, "TrgOps"), general_interrogation=True
            ),
            integrity_period_ms=document.integer(element, "intgPd", 0),
            enabled=document.boolean(element, "logEna", default=True),
            reason_code=document.boolean(element, "reasonCode", default=True),
        )

    def _goose(self, name: str, element: etree._Element) -> GooseControl:
        return GooseControl(
            name=name,
            application_id=element.get("appID", ""),
            data_set=self._data_set_name(element),
            configuration_revision=self._document.integer(element, "confRev", 0),
            fixed_offsets=self._document.boolean(element, "fixedOffs"),
            address=self._addresses.get(("GSE", self._ied, self._device, name)),
        )

    def _sampled_values(self, name: str, element: etree._Element) -> SampledValueControl:
        mode = element.get("smpMod", SAMPLE_MODES[0])
        return SampledValueControl(
            name=name,
            stream_id=element.get("smvID", ""),
            data_set=self._data_set_name(element),
            configuration_revision=self._document.integer(element, "confRev", 0),
            sample_mode=SAMPLE_MODES.index(mode) if mode in SAMPLE_MODES else 0,
            sample_rate=self._document.integer(element, "smpRate", 0, maximum=2**16 - 1),
            multicast=self._document.boolean(element, "multicast", default=True),
            address=self._addresses.get(("SMV", self._ied, self._device, name)),
        )


def _optional_fields(document: Document, element: etree._Element | None) -> OptionalFields:
    fields = 0
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
            fields |= field.value
    return OptionalFields(fields)
