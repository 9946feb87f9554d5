"""Multicast addresses of GOOSE and sampled value control blocks, from the communication section."""

import re
from collections.abc import Mapping

from lxml import etree

from scl.address_parameters import address_parameters
from scl.attribute_values import decimal
from scl.control_block_model import MulticastAddress
from scl.document import Document
from scl.xml_file import content

MAC = re.compile(r"(?:[0-9A-Fa-f]{2}[-:]?){5}[0-9A-Fa-f]{2}")

MulticastAddresses = Mapping[tuple[str, str, str, str], MulticastAddress]
"""By element (GSE or SMV), IED name, logical device inst and control block name."""


def multicast_addresses(document: Document) -> MulticastAddresses:
    """Read the multicast addresses of a document; unusable ones become findings.

    Parameters
    ----------
    document : Document
        The document.

    Returns
    -------
    MulticastAddresses
        The addresses by element, IED, logical device and control block.
    """
    addresses: dict[tuple[str, str, str, str], MulticastAddress] = {}
    for section in document.children(document.root, "Communication"):
        for connected in document.descendants(section, "ConnectedAP"):
            ied = connected.get("iedName", "")
            for element in document.children(connected, "GSE", "SMV"):
                address = _address(document, element)
                block = ied, element.get("ldInst", ""), element.get("cbName", "")
                if address is not None:
                    addresses.setdefault((etree.QName(element).localname, *block), address)
    return addresses


def _address(document: Document, element: etree._Element) -> MulticastAddress | None:
    parameters = address_parameters(document, element)
    mac = parameters.get("MAC-Address", "")
    application_id = _hexadecimal(parameters.get("APPID", "0"))
    vlan_id = _hexadecimal(parameters.get("VLAN-ID", "0"))
    vlan_priority = decimal(parameters.get("VLAN-PRIORITY", "4"))
    octets = mac_octets(mac)
    if octets is None or application_id is None or vlan_id is None or vlan_priority is None:
        document.note(element, "no usable multicast address: left out")
        return None
    return MulticastAddress(
        mac=octets,
        application_id=application_id,
        vlan_id=vlan_id & 0xFFF,
        vlan_priority=vlan_priority & 7,
        minimum_time_ms=_milliseconds(document, element, "MinTime"),
        maximum_time_ms=_milliseconds(document, element, "MaxTime"),
    )


def mac_octets(text: str) -> bytes | None:
    """Read an Ethernet address.

    Parameters
    ----------
    text : str
        Six octets in hexadecimal digits, with hyphens, colons or nothing between.

    Returns
    -------
    bytes or None
        The octets; None where the text is no address.
    """
    return bytes.fromhex(re.sub("[-:]", "", text)) if MAC.fullmatch(text) else None


def _hexadecimal(text: str) -> int | None:
    return int(text, 16) if re.fullmatch("[0-9A-Fa-f]{1,4}", text) else None


def _milliseconds(document: Document, element: etree._Element, tag: str) -> int | None:
    child = document.child(element, tag)
    return None if child is None else decimal(content(child))
