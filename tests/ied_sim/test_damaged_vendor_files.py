"""Files with parts removed, moved, doubled and renamed: what is left of them is served, or a reason told."""

import copy
import random
from collections.abc import Iterator
from pathlib import Path

import pytest
from lxml import etree

import scl
from ied_sim.errors import SimulatorError
from ied_sim.simulator import Simulator
from mms import Client
from scl import Address
from testing.ports import LOOPBACK, free_port
from tests.scl.vendor_shapes import SHAPES

WORDS = (
    *("", "x y", "Ä", "A" * 70, "0", "-1", "99999999999", "true", "LLN0", "a.b", "a$b", "a(b)", "{", '"'),
    *("Struct", "Enum", "BOOLEAN", "INT128", "Quality", "CO", "CF", "ST", "SE", "SG"),
)
"""Values that names, types and constraints may have by mistake."""


def damaged(text: str, seed: int) -> bytes:
    """The file with one to ten faults, always the same ones for a seed."""
    chance = random.Random(seed)
    root = etree.fromstring(text.encode())
    for _ in range(chance.choice((1, 1, 2, 4, 10))):
        elements = list(root.iter(etree.Element))[1:]
        if not elements:
            break
        element, other = chance.choice(elements), chance.choice(elements)
        parent = element.getparent()
        assert parent is not None
        names = sorted(element.attrib)
        match chance.choice(("remove", "double", "empty", "move", "forget", "rename", "mistake")):
            case "remove":
                parent.remove(element)
            case "double":
                parent.append(copy.deepcopy(element))
            case "empty":
                del element[:]
            case "move" if element not in other.iterancestors() and element is not other:
                other.append(element)
            case "forget" if names:
                del element.attrib[chance.choice(names)]
            case "rename" if names:
                element.set(chance.choice(names), chance.choice(WORDS))
            case "mistake" if names and names[0] in other.attrib:
                element.set(names[0], other.attrib[names[0]])
    return etree.tostring(root)


def browsed(document: scl.Scl, files: Path) -> Iterator[str]:
    """Serve all relays, and let a client look at everything they have."""
    addresses = {ied.name: Address(LOOPBACK, free_port()) for ied in document.ieds}
    with Simulator(document, {}, files=files, addresses=addresses) as simulator:
        for name, address in simulator.addresses.items():
            with Client.connect(address.host, address.port) as client:
                for device in client.logical_devices():
                    for node in client.logical_nodes(device):
                        client.data_objects(f"{device}/{node}")
                        for data_set in client.data_sets(f"{device}/{node}"):
                            client.read_data_set(f"{device}/{node}.{data_set}")
            yield name


@pytest.mark.campaign
@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("seed", range(40))
def test_a_damaged_file_is_served_as_far_as_it_goes(tmp_path: Path, shape: str, seed: int) -> None:
    path = tmp_path / shape
    path.write_bytes(damaged(SHAPES[shape], seed))
    document = scl.read(path)
    try:
        served, reason = list(browsed(document, tmp_path / "files")), ""
    except SimulatorError as error:
        served, reason = [], str(error)
    assert served or "no relay to serve" in reason
