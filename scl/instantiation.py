"""Writing of configuration files: the IED of an ICD under a new name, and copies with other addresses."""

from collections.abc import Mapping
from ipaddress import ip_address
from pathlib import Path

from lxml import etree

from scl.address_parameters import parameter_type
from scl.configuration import Address
from scl.document import IED_NAME, Document
from scl.errors import SclError
from scl.multicast_addresses import mac_octets
from scl.reader import read
from scl.xml_file import content

GOOSE_ADDRESSES = 512
"""Multicast addresses 01-0C-CD-01-00-00 to 01-0C-CD-01-01-FF (IEC 61850-8-1 annex B)."""


def instantiate(
    path_in: Path | str, path_out: Path | str, ied_name: str, address: Address | None = None
) -> None:
    """Write a CID: the one IED of an ICD under a name, and at an address, of its own.

    The name replaces the ICD's (TEMPLATE by convention) wherever the file refers to it.

    Parameters
    ----------
    path_in : pathlib.Path or str
        The ICD.
    path_out : pathlib.Path or str
        The CID to write.
    ied_name : str
        Name of the IED.
    address : Address, optional
        Its address. Without it the ICD's stays.

    Raises
    ------
    SclError
        The file has not exactly one IED, or the name or address is unusable.
    """
    document = Document(Path(path_in))
    rename_ied(document, ied_name)
    if address is not None:
        set_address(document, ied_name, address)
    write(document, Path(path_out))


def with_addresses(path_in: Path | str, path_out: Path | str, addresses: Mapping[str, Address]) -> None:
    """Write a copy of an SCL file in which the named IEDs have other addresses (P elements IP and MMS-Port).

    Of an IED's access points the one that `Scl.address` reports is changed.

    Parameters
    ----------
    path_in : pathlib.Path or str
        The file.
    path_out : pathlib.Path or str
        The copy to write.
    addresses : mapping of str to Address
        New addresses by name of the IED.

    Raises
    ------
    SclError
        A named IED is not in the file, or an address is unusable.
    """
    document = Document(Path(path_in))
    scl = read(path_in)
    for name, address in addresses.items():
        set_address(document, name, address, scl.connected_access_point(name).access_point)
    write(document, Path(path_out))


def rename_ied(document: Document, name: str) -> None:
    """Give the only IED of a document (an ICD) another name, in the IED and wherever it is referred to.

    Parameters
    ----------
    document : Document
        The document, which is changed.
    name : str
        The new name.

    Raises
    ------
    SclError
        The document has not exactly one IED, or the name is unusable.
    """
    if not IED_NAME.fullmatch(name):
        raise SclError(
            document.path,
            element="<IED>",
            expected="an IED name of letters, digits and underscores that begins with a letter",
            found=repr(name),
        )
    ieds = list(document.children(document.root, "IED"))
    if len(ieds) != 1:
        raise document.error(document.root, "exactly one IED (an ICD)", f"{len(ieds)}")
    old_name = document.required(ieds[0], "name")
    ieds[0].set("name", name)
    for element in document.root.iter(etree.Element):
        if element.get("iedName") == old_name:
            element.set("iedName", name)
    for control in document.descendants(document.root, "GSEControl"):
        if control.get("appID") == old_name:
            control.set("appID", name)


def set_address(document: Document, ied_name: str, address: Address, access_point: str | None = None) -> None:
    """Change the address of an IED's ConnectedAP, of one access point or of all.

    Parameters
    ----------
    document : Document
        The document, which is changed.
    ied_name : str
        Name of the IED.
    address : Address
        The new address.
    access_point : str, optional
        Name of the access point. All by default.

    Raises
    ------
    SclError
        There is no such ConnectedAP, or the address is unusable.
    """
    _check(document.path, address)
    found = [
        element
        for element in document.descendants(document.root, "ConnectedAP")
        if element.get("iedName") == ied_name and access_point in (None, element.get("apName"))
    ]
    if not found:
        raise document.error(document.root, f'a ConnectedAP with iedName="{ied_name}"', "none")
    for element in found:
        _set_parameter(document, element, "IP", address.host)
        _set_parameter(document, element, "MMS-Port", str(address.port))


def number_goose(document: Document, number: int) -> None:
    """Give the GOOSE control blocks of a document addresses by the number of their relay.

    Each block has the multicast address and APPID that the file gives it, plus the number. A file whose
    relays have one block each so gets addresses of its own for every relay.

    Parameters
    ----------
    document : Document
        The document, which is changed.
    number : int
        Number of the relay, from 0 to 511: GOOSE has so many multicast addresses.

    Raises
    ------
    SclError
        The number is not in that range, or the file has an address that is none.
    """
    if not 0 <= number < GOOSE_ADDRESSES:
        raise SclError(
            document.path, expected=f"a relay's number from 0 to {GOOSE_ADDRESSES - 1}", found=str(number)
        )
    for block in document.descendants(document.root, "GSE"):
        for section in document.children(block, "Address"):
            for parameter in document.children(section, "P"):
                text = content(parameter)
                kind = parameter_type(parameter.get("type", ""))
                if kind == "MAC-Address":
                    octets = mac_octets(text)
                    if octets is None:
                        raise document.error(parameter, "an Ethernet address", repr(text))
                    parameter.text = (int.from_bytes(octets) + number).to_bytes(6).hex("-").upper()
                elif kind == "APPID":
                    parameter.text = f"{int(text, 16) + number:04X}"


def write(document: Document, path: Path) -> None:
    """Write a document as UTF-8. Comments are not kept.

    Parameters
    ----------
    document : Document
        The document.
    path : pathlib.Path
        The file to write.
    """
    path.write_bytes(etree.tostring(document.root, xml_declaration=True, encoding="UTF-8", pretty_print=True))


def _set_parameter(document: Document, connected: etree._Element, kind: str, value: str) -> None:
    section = document.child(connected, "Address")
    if section is None:
        section = document.add(connected, "Address")
        connected.insert(0, section)
    same = (each for each in document.children(section, "P") if parameter_type(each.get("type", "")) == kind)
    parameter = next(same, None)
    if parameter is None:
        parameter = document.add(section, "P", type=kind)
    parameter.text = value


def _check(path: Path, address: Address) -> None:
    try:
        ip_address(address.host)
    except ValueError:
        raise SclError(path, expected="an IPv4 or IPv6 address", found=repr(address.host)) from None
    if not 0 < address.port < 65536:
        raise SclError(path, expected="a port from 1 to 65535", found=str(address.port))
