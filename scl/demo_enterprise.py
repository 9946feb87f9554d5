"""The demo enterprise's SCD: the demo plant's relays, each a host of its own behind its factory's router.

On its factory's network a relay has a name of its own and the standard's port. From the wide-area network it
is reached at its router, at the port the relay has in the demo plant. Names are host names (P element
DNSName, IEC 61850-6 edition 2.1), so that whoever runs the hosts may give them any IP address.

`python -m scl.demo_enterprise FILE` writes it.
"""

import sys
from copy import deepcopy
from pathlib import Path

from lxml import etree

from scl import DEMO_PLANT_SCD
from scl.configuration import MMS_PORT
from scl.document import Document
from scl.instantiation import write

WAN = "WAN"
ROUTERS = {"FACTORY_A": "router-a", "FACTORY_B": "router-b"}


def write_demo_enterprise(path: Path | str) -> None:
    """Write the SCD: that of the demo plant with one more subnetwork and other addresses.

    Parameters
    ----------
    path : pathlib.Path or str
        The file to write.
    """
    enterprise = Document(DEMO_PLANT_SCD)
    enterprise.root.set("release", "4")
    header = next(enterprise.children(enterprise.root, "Header"))
    header.set("id", "Demo enterprise")
    for text in enterprise.children(header, "Text"):
        text.text = "Two factories on a wide-area network. Made by scl.demo_enterprise of the demo plant."
    communication = next(enterprise.children(enterprise.root, "Communication"))
    outside = etree.Element(
        communication[0].tag, name=WAN, type="8-MMS", desc="Wide-area network, with the motor control centre"
    )
    for network in enterprise.children(communication, "SubNetwork"):
        for connected in enterprise.children(network, "ConnectedAP"):
            forwarded = deepcopy(connected)
            _set_host(enterprise, forwarded, ROUTERS[network.get("name", "")])
            outside.append(forwarded)
            bay = connected.get("iedName", "").partition("_")[0].lower()
            _set_host(enterprise, connected, f"relay-{bay}", MMS_PORT)
    communication.append(outside)
    etree.indent(enterprise.root)
    write(enterprise, Path(path))


def _set_host(document: Document, connected: etree._Element, name: str, port: int | None = None) -> None:
    """Replace the IP address by a host name, and the port where one is given."""
    (address,) = document.children(connected, "Address")
    for parameter in list(document.children(address, "P")):
        match parameter.get("type"):
            case "IP":
                parameter.set("type", "DNSName")
                parameter.text = name
            case "IP-SUBNET":
                address.remove(parameter)
            case "MMS-Port" if port is not None:
                parameter.text = str(port)


if __name__ == "__main__":
    write_demo_enterprise(sys.argv[1])
