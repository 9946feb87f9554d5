"""One plant seen from several subnetworks, and the demo enterprise, which has three."""

from pathlib import Path

import pytest

import scl
from scl import Address, Scl, SclError
from scl.demo_enterprise import WAN, write_demo_enterprise


@pytest.fixture(scope="module")
def enterprise(tmp_path_factory: pytest.TempPathFactory) -> Scl:
    path = tmp_path_factory.mktemp("enterprise") / "plant.scd"
    write_demo_enterprise(path)
    return scl.read(path)


def test_the_enterprise_is_the_demo_plant_at_other_addresses(enterprise: Scl) -> None:
    plant = scl.read(scl.DEMO_PLANT_SCD)
    assert enterprise.warnings == ()
    assert enterprise.header.edition == "2.1", "DNSName is of that edition"
    assert (enterprise.ieds, enterprise.substations) == (plant.ieds, plant.substations)


def test_a_relay_is_named_on_its_factory_s_network_and_forwarded_from_outside(enterprise: Scl) -> None:
    plant, outside = scl.read(scl.DEMO_PLANT_SCD), enterprise.seen_from(WAN)
    for feeder in plant.feeders():
        name = f"relay-{feeder.bay.lower()}"
        assert enterprise.address(feeder.ied) == Address(name, 102)
        assert enterprise.seen_from(feeder.site).address(feeder.ied) == Address(name, 102)
        router = f"router-{feeder.bay[0].lower()}"
        assert outside.address(feeder.ied) == Address(router, plant.address(feeder.ied).port)


def test_no_two_relays_share_an_address_on_any_network(enterprise: Scl) -> None:
    relays = [ied.name for ied in enterprise.ieds]
    assert enterprise.shared_addresses(relays) == {}
    assert enterprise.seen_from(WAN).shared_addresses(relays) == {}


def test_who_is_not_on_a_network_has_no_address_there(enterprise: Scl) -> None:
    with pytest.raises(SclError, match='a ConnectedAP with iedName="B1_SEL710"'):
        enterprise.seen_from("FACTORY_A").address("B1_SEL710")
    with pytest.raises(SclError, match=r'name="LAN", found FACTORY_A, FACTORY_B, WAN'):
        enterprise.seen_from("LAN")


def test_names_are_compared_whatever_their_case(tmp_path: Path, enterprise: Scl) -> None:
    text = enterprise.path.read_text(encoding="utf-8").replace(">relay-a2<", ">RELAY-A1<")
    (tmp_path / "plant.scd").write_text(text, encoding="utf-8")
    shared = scl.read(tmp_path / "plant.scd").shared_addresses(["A1_SEL710", "A2_SEL710", "A3_SEL710"])
    assert shared == {Address("relay-a1", 102): ("A1_SEL710", "A2_SEL710")}
