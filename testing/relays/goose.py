"""SCL files whose relays send their protection data by GOOSE."""

from pathlib import Path

from lxml import etree

from scl import Scl, read

DATA_SET = "DSet04"
BLOCK = "GPub01"
REVISION = 3
APPLICATION_ID = 0x3001


def with_goose(source: Path, made: Path) -> Scl:
    """Write a copy in which the logical device CFG of each IED publishes DSet04, and read it."""
    tree = etree.parse(source)
    namespace = f"{{{etree.QName(tree.getroot()).namespace}}}"
    for device in tree.iter(f"{namespace}LDevice"):
        node = device.find(f"{namespace}LN0")
        if device.get("inst") == "CFG" and node is not None:
            ied = next(parent for parent in device.iterancestors() if parent.tag == f"{namespace}IED")
            etree.SubElement(
                node,
                f"{namespace}GSEControl",
                name=BLOCK,
                appID=ied.get("name", ""),
                datSet=DATA_SET,
                confRev=str(REVISION),
            )
    for number, connected in enumerate(tree.iter(f"{namespace}ConnectedAP")):
        sent = etree.SubElement(connected, f"{namespace}GSE", ldInst="CFG", cbName=BLOCK)
        address = etree.SubElement(sent, f"{namespace}Address")
        for kind, text in (
            ("MAC-Address", f"01-0C-CD-01-{number >> 8:02X}-{number & 0xFF:02X}"),
            ("APPID", f"{APPLICATION_ID:04X}"),
            ("VLAN-ID", "000"),
        ):
            etree.SubElement(address, f"{namespace}P", type=kind).text = text
        etree.SubElement(sent, f"{namespace}MinTime", unit="s", multiplier="m").text = "4"
        etree.SubElement(sent, f"{namespace}MaxTime", unit="s", multiplier="m").text = "500"
    tree.write(made)
    return read(made)
