"""A whole configuration file: its header, its IEDs and the addresses at which they are reached."""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from ipaddress import ip_address
from pathlib import Path

from scl.errors import Finding, SclError
from scl.ied_model import Ied
from scl.motor_feeders import motor_feeders
from scl.substation_model import MotorFeeder, Substation

MMS_PORT = 102

HOST_NAME = re.compile(r"(?=.{1,253}$)[A-Za-z0-9]([A-Za-z0-9-]{0,62})(\.[A-Za-z0-9][A-Za-z0-9-]{0,62})*")
"""Host names of RFC 1123."""


@dataclass(frozen=True, slots=True)
class Address:
    """Address of an IED's MMS server.

    Parameters
    ----------
    host : str
        IP address, or a name that the network knows.
    port : int
        TCP port.
    """

    host: str
    port: int = MMS_PORT

    def __str__(self) -> str:
        return f"[{self.host}]:{self.port}" if ":" in self.host else f"{self.host}:{self.port}"


@dataclass(frozen=True, slots=True)
class Header:
    """Header of a file.

    Parameters
    ----------
    id : str
        Identification of the file.
    version : str
        Version of the content.
    revision : str
        Revision of the version.
    tool : str
        Tool that wrote the file.
    edition : str
        Edition of SCL, "1", "2" or "2.1", from the version, revision and release of the SCL element.
    """

    id: str
    version: str
    revision: str
    tool: str
    edition: str


@dataclass(frozen=True, slots=True)
class ConnectedAccessPoint:
    """An access point on a subnetwork.

    Parameters
    ----------
    ied : str
        Name of the IED.
    access_point : str
        Name of the access point.
    subnetwork : str
        Name of the subnetwork.
    parameters : mapping of str to str
        Contents of its P elements by type ("IP", "MMS-Port").
    line : int
        Line of the element in the file.
    """

    ied: str
    access_point: str
    subnetwork: str
    parameters: Mapping[str, str]
    line: int


@dataclass(frozen=True, slots=True)
class SubNetwork:
    """A subnetwork of the communication section.

    Parameters
    ----------
    name : str
        Name of the subnetwork.
    type : str
        Protocol, such as "8-MMS".
    connected_access_points : tuple of ConnectedAccessPoint
        Access points on it.
    """

    name: str
    type: str
    connected_access_points: tuple[ConnectedAccessPoint, ...]


@dataclass(frozen=True, slots=True)
class Scl:
    """An SCL file (ICD, CID, IID, SCD).

    Parameters
    ----------
    path : pathlib.Path
        The file.
    header : Header
        Its header.
    ieds : tuple of Ied
        Its IEDs.
    communication : tuple of SubNetwork
        Its subnetworks.
    substations : tuple of Substation
        Its substations.
    warnings : tuple of Finding
        Oddities that did not keep the file from being read.

    References
    ----------
    IEC 61850-6, configuration description language.
    """

    path: Path
    header: Header
    ieds: tuple[Ied, ...]
    communication: tuple[SubNetwork, ...]
    substations: tuple[Substation, ...]
    warnings: tuple[Finding, ...]

    def ied(self, name: str) -> Ied:
        """Find an IED by its name.

        Parameters
        ----------
        name : str
            Name of the IED.

        Returns
        -------
        Ied
            The IED.

        Raises
        ------
        SclError
            The file has no such IED.
        """
        for ied in self.ieds:
            if ied.name == name:
                return ied
        known = ", ".join(ied.name for ied in self.ieds[:20]) or "none at all"
        raise SclError(self.path, element="<IED>", expected=f'an IED with name="{name}"', found=known)

    def address(self, ied_name: str) -> Address:
        """Find where the IED's MMS server is reached.

        The address is the P element IP, or else DNSName, with MMS-Port (or 102). An IED on several
        subnetworks is reached where an access point has a server and an address; of several such, on the
        subnetwork that comes first. `seen_from` chooses another.

        Parameters
        ----------
        ied_name : str
            Name of the IED.

        Returns
        -------
        Address
            The address.

        Raises
        ------
        SclError
            The file has no such IED, or no usable address for it.
        """
        connected = self.connected_access_point(ied_name)
        host = self._host(connected)
        port = connected.parameters.get("MMS-Port", str(MMS_PORT))
        if not (port.isascii() and port.isdecimal() and len(port) <= 5 and 0 < int(port) < 65536):
            raise self._address_error(connected, "MMS-Port", "a port from 1 to 65535", port)
        return Address(host, int(port))

    def connected_access_point(self, ied_name: str) -> ConnectedAccessPoint:
        """Find the ConnectedAP whose address clients use.

        Parameters
        ----------
        ied_name : str
            Name of the IED.

        Returns
        -------
        ConnectedAccessPoint
            The access point.

        Raises
        ------
        SclError
            No access point of the IED has an address.
        """
        ied = self.ied(ied_name)
        serving = {point.name for point in ied.access_points if point.logical_devices}
        candidates = [
            connected
            for network in self.communication
            for connected in network.connected_access_points
            if connected.ied == ied_name and connected.parameters.keys() & {"IP", "DNSName"}
        ]
        candidates.sort(key=lambda connected: connected.access_point not in serving)
        if not candidates:
            raise SclError(
                self.path,
                element="<Communication>",
                expected=f'a ConnectedAP with iedName="{ied_name}" and an address (P elements IP or DNSName)',
                found="none",
            )
        return candidates[0]

    def seen_from(self, subnetwork: str) -> "Scl":
        """Restrict the configuration to one subnetwork, so that IEDs have the addresses they have there.

        Parameters
        ----------
        subnetwork : str
            Name of the subnetwork.

        Returns
        -------
        Scl
            The configuration as seen from the subnetwork.

        Raises
        ------
        SclError
            The file has no such subnetwork.
        """
        networks = tuple(network for network in self.communication if network.name == subnetwork)
        if not networks:
            raise SclError(
                self.path,
                element="<Communication>",
                expected=f'a SubNetwork with name="{subnetwork}"',
                found=", ".join(network.name for network in self.communication[:20]) or "none at all",
            )
        return replace(self, communication=networks)

    def shared_addresses(self, ied_names: Iterable[str]) -> dict[Address, tuple[str, ...]]:
        """Find addresses that several IEDs have.

        Parameters
        ----------
        ied_names : iterable of str
            Names of the IEDs to compare.

        Returns
        -------
        dict of Address to tuple of str
            Names of the IEDs by shared address.

        Raises
        ------
        SclError
            An IED has no usable address.
        """
        holders: dict[Address, list[str]] = {}
        for name in ied_names:
            address = self.address(name)
            holders.setdefault(Address(_canonical(address.host), address.port), []).append(name)
        return {address: tuple(names) for address, names in holders.items() if len(names) > 1}

    def feeders(self) -> tuple[MotorFeeder, ...]:
        """List every motor with the IED attached to it or else to its bay.

        A motor is a ConductingEquipment of type MOT.

        Returns
        -------
        tuple of MotorFeeder
            The motors in file order.
        """
        return motor_feeders(self.substations)

    def _host(self, connected: ConnectedAccessPoint) -> str:
        host = connected.parameters.get("IP")
        if host is None:
            name = connected.parameters["DNSName"]
            if not HOST_NAME.fullmatch(name):
                raise self._address_error(connected, "DNSName", "a host name", name)
            return name
        try:
            ip_address(host)
        except ValueError:
            raise self._address_error(connected, "IP", "an IPv4 or IPv6 address", host) from None
        return host

    def _address_error(
        self, connected: ConnectedAccessPoint, kind: str, expected: str, found: str
    ) -> SclError:
        element = f'<P type="{kind}"> of <ConnectedAP iedName="{connected.ied}">'
        return SclError(
            self.path, line=connected.line, element=element, expected=expected, found=repr(found[:60])
        )


def _canonical(host: str) -> str:
    """Return one spelling of a host: ::1 is 0:0:0:0:0:0:0:1, PUMPS.PLANT is pumps.plant."""
    try:
        return str(ip_address(host))
    except ValueError:
        return host.lower()
