"""The P elements of an Address: their types, in the spelling of the standard (IEC 61850-6, 8-1 and 9-2)."""

from ipaddress import ip_address

from lxml import etree

from scl.document import Document
from scl.xml_file import content

TYPES = (
    *("IP", "IP-SUBNET", "IP-GATEWAY", "IP-ClassOfTraffic", "IP-IGMPv3Src", "DNSName"),
    *("IPv6", "IPv6-SUBNET", "IPv6-GATEWAY", "IPv6FlowLabel", "IPv6ClassOfTraffic", "IPv6-IGMPv3Src"),
    *("MMS-Port", "SNTP-Port", "UDP-Port", "TCP-Port", "C37-118-IP-Port"),
    *("OSI-TSEL", "OSI-SSEL", "OSI-PSEL", "OSI-NSAP", "OSI-AP-Title", "OSI-AP-Invoke"),
    *("OSI-AE-Qualifier", "OSI-AE-Invoke"),
    *("MAC-Address", "APPID", "VLAN-ID", "VLAN-PRIORITY"),
)
"""Types that the standard gives; nothing is read of most of them."""
_BY_LETTERS = {"".join(filter(str.isalnum, kind)).casefold(): kind for kind in TYPES}
REACHED_BY = ("IP", "DNSName")


def address_parameters(document: Document, element: etree._Element) -> dict[str, str]:
    """Read the P elements of an element's Address, with or without xsi:type.

    A type in other capitals or hyphens is the standard's, with a finding. The first of a type counts.

    Parameters
    ----------
    document : Document
        The document.
    element : lxml.etree._Element
        What has the Address: a ConnectedAP, GSE or SMV.

    Returns
    -------
    dict of str to str
        Contents of the P elements by type.
    """
    parameters: dict[str, str] = {}
    for parameter in document.children(document.child(element, "Address"), "P"):
        written = parameter.get("type", "")
        kind = parameter_type(written)
        if kind != written:
            document.note(parameter, f"no type of the standard: read as {kind}")
        elif kind not in TYPES:
            document.note(parameter, "no type of the standard: passed over")
        parameters.setdefault(kind, content(parameter))
    return parameters


def parameter_type(written: str) -> str:
    """Return a type in the spelling of the standard.

    Parameters
    ----------
    written : str
        The type as written.

    Returns
    -------
    str
        "MMS-Port" for "MMS-PORT"; a type that the standard does not know as it is.
    """
    return _BY_LETTERS.get("".join(filter(str.isalnum, written)).casefold(), written)


def note_unusable(document: Document, element: etree._Element, parameters: dict[str, str]) -> None:
    """Note an access point whose Address names no host that can be reached.

    Parameters
    ----------
    document : Document
        The document.
    element : lxml.etree._Element
        The ConnectedAP.
    parameters : dict of str to str
        What its Address says.
    """
    if not parameters:
        return
    if not any(kind in parameters for kind in REACHED_BY):
        document.note(element, f"its address names no host: it has no P of type {' or '.join(REACHED_BY)}")
        return
    try:
        if "IP" in parameters:
            ip_address(parameters["IP"])
    except ValueError as error:
        document.note(element, f"its address is not understood: {error}")
