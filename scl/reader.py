"""Reader of SCL files of editions 1, 2 and 2.1 (IEC 61850-6), which makes plain frozen dataclasses of them.

Private elements and foreign namespaces are passed over. What is odd but clear becomes a finding with its
line. What cannot be used is left out, as little as possible, with a finding too: a data set member, a data
object, a node, an IED. Only a file that is no safe SCL at all is an SclError.
"""

from collections.abc import Iterable
from pathlib import Path

from lxml import etree

from scl.address_parameters import address_parameters, note_unusable
from scl.configuration import ConnectedAccessPoint, Header, Scl, SubNetwork
from scl.conformance import check_conformance
from scl.document import Document
from scl.errors import SclError
from scl.ied_model import Ied
from scl.ied_section import IedSection
from scl.instance_values import InstanceValues
from scl.multicast_addresses import multicast_addresses
from scl.substation_model import Bay, Equipment, Substation
from scl.templates import Templates
from scl.xml_file import LARGEST_FILE_BYTES


def read(path: Path | str, *, largest_bytes: int = LARGEST_FILE_BYTES) -> Scl:
    """Read an ICD, CID, IID or SCD.

    Parameters
    ----------
    path : pathlib.Path or str
        The file.
    largest_bytes : int
        Size above which the file is refused [byte].

    Returns
    -------
    Scl
        The configuration.

    Raises
    ------
    SclError
        The file is missing, too large, no safe XML, or no SCL.

    References
    ----------
    IEC 61850-6, editions 1, 2 and 2.1.
    """
    document = Document(Path(path), largest_bytes=largest_bytes)
    check_conformance(document)
    templates, instance_values = Templates(document), InstanceValues(document)
    addresses = multicast_addresses(document)
    ieds: dict[str, Ied] = {}
    for element in document.children(document.root, "IED"):
        try:
            section = IedSection(document, element, templates, instance_values, addresses)
        except SclError as error:
            document.leave_out(element, error)
            continue
        if section.name in ieds:
            document.leave_out(element, "a second IED of this name, the first one counts")
        else:
            ieds[section.name] = section.read()
    communication = _communication(document, ieds)
    substations = _substations(document, ieds)
    header = _header(document)
    return Scl(
        path=document.path,
        header=header,
        ieds=tuple(ieds.values()),
        communication=communication,
        substations=substations,
        warnings=tuple(sorted(document.findings + document.omissions, key=lambda finding: finding.line)),
    )


def _header(document: Document) -> Header:
    root = document.root
    header = document.child(root, "Header")
    if header is None:
        header = etree.Element("Header")
    if root.get("version") is None:
        edition = "1"
    else:
        edition = "2.1" if document.integer(root, "release", 1) >= 4 else "2"
    return Header(
        id=header.get("id", ""),
        version=header.get("version", ""),
        revision=header.get("revision", ""),
        tool=header.get("toolID", ""),
        edition=edition,
    )


def _communication(document: Document, ieds: dict[str, Ied]) -> tuple[SubNetwork, ...]:
    return tuple(
        SubNetwork(
            name=network.get("name", ""),
            type=network.get("type", ""),
            connected_access_points=tuple(
                _connected_access_point(document, network, element, ieds)
                for element in document.children(network, "ConnectedAP")
            ),
        )
        for section in document.children(document.root, "Communication")
        for network in document.children(section, "SubNetwork")
    )


def _connected_access_point(
    document: Document, network: etree._Element, element: etree._Element, ieds: dict[str, Ied]
) -> ConnectedAccessPoint:
    ied = element.get("iedName", "")
    if ied not in ieds:
        document.note(element, "names an IED this file does not hold")
    parameters = address_parameters(document, element)
    note_unusable(document, element, parameters)
    return ConnectedAccessPoint(
        ied=ied,
        access_point=element.get("apName", ""),
        subnetwork=network.get("name", ""),
        parameters=parameters,
        line=element.sourceline or 0,
    )


def _substations(document: Document, ieds: dict[str, Ied]) -> tuple[Substation, ...]:
    return tuple(
        Substation(
            name=substation.get("name", ""),
            description=substation.get("desc", ""),
            bays=tuple(
                _bay(document, level, bay, ieds)
                for level in document.children(substation, "VoltageLevel")
                for bay in document.children(level, "Bay")
            ),
        )
        for substation in document.children(document.root, "Substation")
    )


def _bay(document: Document, level: etree._Element, bay: etree._Element, ieds: dict[str, Ied]) -> Bay:
    attached = _attached(document, document.children(bay, "LNode"), ieds)
    return Bay(
        name=bay.get("name", ""),
        description=bay.get("desc", ""),
        voltage_level=level.get("name", ""),
        equipment=tuple(
            _equipment(document, element, ieds, attached)
            for element in document.children(bay, "ConductingEquipment")
        ),
        ieds=attached,
        nodes=tuple(node.get("pathName", "") for node in document.children(bay, "ConnectivityNode")),
    )


def _equipment(
    document: Document, element: etree._Element, ieds: dict[str, Ied], of_bay: tuple[str, ...]
) -> Equipment:
    attached = _attached(document, document.descendants(element, "LNode"), ieds)
    equipment = Equipment(
        name=element.get("name", ""),
        type=element.get("type", ""),
        description=element.get("desc", ""),
        ieds=attached,
        nodes=tuple(
            terminal.get("connectivityNode", "") for terminal in document.children(element, "Terminal")
        ),
    )
    relays = attached or of_bay
    if equipment.type == "MOT" and not relays:
        document.note(element, "a motor without an LNode that names its IED: not watched")
    elif equipment.type == "MOT" and len(relays) > 1:
        document.note(element, f"a motor with several IEDs ({', '.join(relays)}): the first one is used")
    return equipment


def _attached(document: Document, nodes: Iterable[etree._Element], ieds: dict[str, Ied]) -> tuple[str, ...]:
    """Return the IEDs that LNodes name, each once.

    "None" is the standard's word for a function not yet assigned.
    """
    names: dict[str, None] = {}
    for node in nodes:
        name = node.get("iedName", "None")
        if name in ieds:
            names[name] = None
        elif name != "None":
            document.note(node, "names an IED this file does not hold")
    return tuple(names)
