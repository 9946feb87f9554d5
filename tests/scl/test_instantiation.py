"""Copies of SCL files: other names, other addresses."""

from pathlib import Path

import pytest

import scl
from scl import SEL710_ICD, Address, SclError
from scl.document import Document
from scl.goose_blocks import goose_blocks
from scl.instantiation import number_goose, write
from tests.scl.documents import COMMUNICATION, scl_text, write_scl


def test_relay_made_from_its_icd(tmp_path: Path) -> None:
    path = tmp_path / "pump.cid"
    scl.instantiate(scl.SEL710_ICD, path, "PUMP_1", Address("127.0.0.2", 10300))
    read = scl.read(path)
    assert read.warnings == ()
    assert read.address("PUMP_1") == Address("127.0.0.2", 10300)
    assert read.ied("PUMP_1").logical_devices[0].name == "PUMP_1CFG"
    assert "TEMPLATE" not in path.read_text(encoding="utf-8")


def test_relay_keeps_the_icd_s_address_unless_told(tmp_path: Path) -> None:
    scl.instantiate(scl.SEL710_ICD, tmp_path / "pump.cid", "PUMP_1")
    assert scl.read(tmp_path / "pump.cid").address("PUMP_1") == Address("127.0.0.1", 102)


@pytest.mark.parametrize("name", ["", "1A", "A-1", "Ä1", "A 1", "A" * 65])
def test_names_that_are_no_ied_names(tmp_path: Path, name: str) -> None:
    with pytest.raises(SclError, match="an IED name of letters"):
        scl.instantiate(scl.SEL710_ICD, tmp_path / "x.cid", name)
    assert not (tmp_path / "x.cid").exists()


def test_only_an_icd_can_be_instantiated(tmp_path: Path) -> None:
    with pytest.raises(SclError, match=r"exactly one IED \(an ICD\), found 6"):
        scl.instantiate(scl.DEMO_PLANT_SCD, tmp_path / "x.cid", "R1")


def test_other_addresses_and_nothing_else_changes(tmp_path: Path) -> None:
    path = tmp_path / "plant.scd"
    addresses = {"A1_SEL710": Address("127.0.0.1", 49152), "B3_SEL710": Address("::1", 49153)}
    scl.with_addresses(scl.DEMO_PLANT_SCD, path, addresses)
    before, after = scl.read(scl.DEMO_PLANT_SCD), scl.read(path)
    assert {ied.name: after.address(ied.name) for ied in after.ieds} == {
        ied.name: addresses.get(ied.name, before.address(ied.name)) for ied in before.ieds
    }
    assert (after.ieds, after.substations, after.header) == (before.ieds, before.substations, before.header)


def test_port_is_added_where_the_file_has_none(tmp_path: Path) -> None:
    original = write_scl(tmp_path / "relay.cid", scl_text())
    scl.with_addresses(original, tmp_path / "copy.cid", {"R1": Address("10.0.0.8", 1102)})
    assert scl.read(tmp_path / "copy.cid").address("R1") == Address("10.0.0.8", 1102)


def test_address_is_added_where_the_file_has_none(tmp_path: Path) -> None:
    empty = """<Communication><SubNetwork name="N"><ConnectedAP iedName="R1" apName="S1"/>
      </SubNetwork></Communication>"""
    original = write_scl(tmp_path / "relay.icd", scl_text(communication=empty))
    scl.instantiate(original, tmp_path / "copy.cid", "R2", Address("10.0.0.8"))
    assert scl.read(tmp_path / "copy.cid").address("R2") == Address("10.0.0.8", 102)


@pytest.mark.parametrize(
    ("addresses", "message"),
    [
        ({"R9": Address("127.0.0.1")}, 'an IED with name="R9"'),
        ({"R1": Address("localhost")}, "an IPv4 or IPv6 address"),
        ({"R1": Address("127.0.0.1", 0)}, "a port from 1 to 65535"),
    ],
)
def test_addresses_that_cannot_be_given(tmp_path: Path, addresses: dict[str, Address], message: str) -> None:
    original = write_scl(tmp_path / "relay.cid", scl_text())
    with pytest.raises(SclError, match=message):
        scl.with_addresses(original, tmp_path / "copy.cid", addresses)


def test_an_ied_off_every_subnetwork_has_no_address_to_change(tmp_path: Path) -> None:
    original = write_scl(tmp_path / "relay.icd", scl_text(communication=COMMUNICATION.replace("R1", "R5")))
    with pytest.raises(SclError, match='a ConnectedAP with iedName="R2"'):
        scl.instantiate(original, tmp_path / "copy.cid", "R2", Address("10.0.0.8"))


def test_every_relay_has_goose_addresses_of_its_own(tmp_path: Path) -> None:
    addresses = []
    for number in (0, 300):
        relay = Document(SEL710_ICD)
        number_goose(relay, number)
        write(relay, tmp_path / "relay.icd")
        (block,) = goose_blocks(scl.read(tmp_path / "relay.icd").ieds[0])
        assert block.control.address is not None
        addresses.append((block.control.address.mac.hex(), block.control.address.application_id))
    assert addresses == [("010ccd010000", 1), ("010ccd01012c", 301)]
    with pytest.raises(SclError, match="a relay's number from 0 to 511"):
        number_goose(Document(SEL710_ICD), 512)


def test_a_goose_address_that_is_none_is_named() -> None:
    relay = Document(SEL710_ICD)
    for parameter in relay.descendants(relay.root, "P"):
        if parameter.get("type") == "MAC-Address":
            parameter.text = "somewhere"
    with pytest.raises(SclError, match=r"an Ethernet address.*somewhere"):
        number_goose(relay, 1)
