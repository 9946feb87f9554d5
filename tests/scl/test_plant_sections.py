"""Where relays are reached, and which motors they protect: the sections Communication and Substation."""

from pathlib import Path

import pytest

import scl
from scl import SclError
from tests.scl.documents import COMMUNICATION, scl_text, write_scl


def read(tmp_path: Path, **parts: str) -> scl.Scl:
    return scl.read(write_scl(tmp_path / "relay.cid", scl_text(**parts)))


def messages(read_scl: scl.Scl) -> str:
    return "\n".join(map(str, read_scl.warnings))


@pytest.mark.parametrize(
    ("parameters", "address"),
    [
        ('<P type="IP">10.0.0.7</P>', scl.Address("10.0.0.7", 102)),
        ('<P type="IP">fd00::7</P><P type="MMS-Port">10210</P>', scl.Address("fd00::7", 10210)),
        ('<P type="DNSName">pump-1.plant.example</P>', scl.Address("pump-1.plant.example", 102)),
        ('<P type="DNSName">pump-1</P><P type="IP">10.0.0.7</P>', scl.Address("10.0.0.7", 102)),
        (
            '<P xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" type="IP" xsi:type="tP_IP">'
            " 10.0.0.7 </P>",
            scl.Address("10.0.0.7"),
        ),
    ],
)
def test_address(tmp_path: Path, parameters: str, address: scl.Address) -> None:
    communication = COMMUNICATION.replace('<P type="IP">10.0.0.7</P>', parameters)
    assert read(tmp_path, communication=communication).address("R1") == address


@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        ("", 'a ConnectedAP with iedName="R1"'),
        ('<P type="IP">relay.example</P>', "an IPv4 or IPv6 address, found 'relay.example'"),
        ('<P type="DNSName">no name</P>', "a host name, found 'no name'"),
        ('<P type="IP">10.0.0.7</P><P type="MMS-Port">70000</P>', "a port from 1 to 65535, found '70000'"),
        ('<P type="IP">10.0.0.7</P><P type="MMS-Port">x</P>', "a port from 1 to 65535"),
    ],
)
def test_no_usable_address(tmp_path: Path, parameters: str, message: str) -> None:
    communication = COMMUNICATION.replace('<P type="IP">10.0.0.7</P>', parameters)
    read_scl = read(tmp_path, communication=communication)
    with pytest.raises(SclError, match=message):
        read_scl.address("R1")


def test_the_access_point_with_the_server_is_the_address(tmp_path: Path) -> None:
    other = '<ConnectedAP iedName="R1" apName="P1"><Address><P type="IP">10.9.9.9</P></Address></ConnectedAP>'
    communication = COMMUNICATION.replace('type="8-MMS">', f'type="8-MMS">{other}')
    assert read(tmp_path, communication=communication).address("R1").host == "10.0.0.7"


def substation(bay: str) -> str:
    return (
        '<Substation name="S" desc="Site"><VoltageLevel name="LV"><Bay name="B1">'
        f"{bay}</Bay></VoltageLevel></Substation>"
    )


@pytest.mark.parametrize(
    ("bay", "motors", "warning"),
    [
        (
            '<ConductingEquipment name="M-1" type="MOT"><LNode iedName="R1" lnClass="PTRC"/>'
            "</ConductingEquipment>",
            [("M-1", "R1")],
            "",
        ),
        (
            '<LNode iedName="R1" lnClass="PTRC"/><ConductingEquipment name="M-1" type="MOT"/>'
            '<ConductingEquipment name="Q1" type="CBR"/>',
            [("M-1", "R1")],
            "",
        ),
        (
            '<ConductingEquipment name="M-1" type="MOT"><EqFunction name="F">'
            '<LNode iedName="R1" lnClass="PTRC"/><LNode iedName="None" lnClass="ZMOT"/>'
            "</EqFunction></ConductingEquipment>",
            [("M-1", "R1")],
            "",
        ),
        ('<ConductingEquipment name="M-1" type="MOT"/>', [], "a motor without an LNode"),
        (
            '<LNode iedName="R1" lnClass="PTRC"/><ConductingEquipment type="MOT"/>',
            [],
            'type="MOT">: no name',
        ),
        (
            '<ConductingEquipment name="M-1" type="MOT"><LNode iedName="R9" lnClass="PTRC"/>'
            "</ConductingEquipment>",
            [],
            "names an IED this file does not hold",
        ),
    ],
)
def test_motor_feeders(tmp_path: Path, bay: str, motors: list[tuple[str, str]], warning: str) -> None:
    read_scl = read(tmp_path, substation=substation(bay))
    assert [(feeder.motor, feeder.ied) for feeder in read_scl.feeders()] == motors
    assert warning in messages(read_scl)
    assert bool(warning) == bool(read_scl.warnings)


def test_motor_with_two_relays_takes_the_first_and_says_so(tmp_path: Path) -> None:
    bay = (
        '<ConductingEquipment name="M-1" type="MOT"><LNode iedName="R2" lnClass="PTRC"/>'
        '<LNode iedName="R1" lnClass="PTRC"/></ConductingEquipment>'
    )
    text = scl_text(substation=substation(bay)).replace("</IED>", '</IED><IED name="R2"/>')
    read_scl = scl.read(write_scl(tmp_path / "plant.scd", text))
    assert [feeder.ied for feeder in read_scl.feeders()] == ["R2"]
    assert "several IEDs (R2, R1)" in messages(read_scl)


def terminals(*nodes: str) -> str:
    return "".join(
        f'<Terminal connectivityNode="{node}" cNodeName="{node.rpartition("/")[2]}"/>' for node in nodes
    )


def motor_bay(number: int, *buses: str) -> str:
    """A bay with a motor behind a breaker and current transformers; a disconnector to each bus."""
    bay = f"S/LV/F{number}"
    switches = "".join(
        f'<ConductingEquipment name="Q{k}" type="DIS">{terminals(bus, f"{bay}/N2")}</ConductingEquipment>'
        for k, bus in enumerate(buses)
    )
    return (
        f'<Bay name="F{number}"><LNode iedName="R1" lnClass="PTRC"/>{switches}'
        f'<ConductingEquipment name="Q9" type="CBR">{terminals(f"{bay}/N2", f"{bay}/N1")}'
        "</ConductingEquipment>"
        f'<ConductingEquipment name="T1" type="VTR">{terminals(f"{bay}/N1")}</ConductingEquipment>'
        f'<ConductingEquipment name="M-{number}" type="MOT">{terminals(f"{bay}/N1")}</ConductingEquipment>'
        f'<ConnectivityNode name="N1" pathName="{bay}/N1"/><ConnectivityNode name="N2" pathName="{bay}/N2"/>'
        "</Bay>"
    )


def bus_bays(*names: str) -> str:
    """Bays of busbars with a coupler between them, whose position nobody knows."""
    nodes = [f"S/LV/{name}/BB" for name in names]
    bays = "".join(
        f'<Bay name="{name}"><ConnectivityNode name="BB" pathName="{node}"/></Bay>'
        for name, node in zip(names, nodes, strict=True)
    )
    coupler = f'<ConductingEquipment name="Q0" type="CBR">{terminals(*nodes)}</ConductingEquipment>'
    return f'{bays}<Bay name="COUPLER">{coupler}</Bay>' if len(nodes) > 1 else bays


def test_motors_are_on_the_bus_behind_their_switches(tmp_path: Path) -> None:
    bays = (
        bus_bays("W1", "W2")
        + motor_bay(1, "S/LV/W1/BB")
        + motor_bay(2, "S/LV/W1/BB")
        + motor_bay(3, "S/LV/W2/BB")
        + motor_bay(4, "S/LV/W1/BB", "S/LV/W2/BB")
    )
    section = f'<Substation name="S"><VoltageLevel name="LV">{bays}</VoltageLevel></Substation>'
    feeders = read(tmp_path, substation=section).feeders()
    assert {feeder.motor: feeder.bus for feeder in feeders} == {
        "M-1": "S/LV/W1/BB",
        "M-2": "S/LV/W1/BB",
        "M-3": "S/LV/W2/BB",
        "M-4": None,
    }


def test_motors_of_one_bay_share_its_bus(tmp_path: Path) -> None:
    node = "S/LV/B1/BB"
    motors = "".join(
        f'<ConductingEquipment name="M-{k}" type="MOT"><LNode iedName="R1" lnClass="PTRC"/>'
        f"{terminals(f'S/LV/B1/N{k}')}</ConductingEquipment>"
        f'<ConductingEquipment name="Q{k}" type="CBR">{terminals(f"S/LV/B1/N{k}", node)}'
        "</ConductingEquipment>"
        for k in (1, 2)
    )
    nodes = "".join(
        f'<ConnectivityNode name="{name}" pathName="S/LV/B1/{name}"/>' for name in ("N1", "N2", "BB")
    )
    feeders = read(tmp_path, substation=substation(motors + nodes)).feeders()
    assert [feeder.bus for feeder in feeders] == [node, node]


def test_without_topology_no_bus_is_known(tmp_path: Path) -> None:
    motor = '<ConductingEquipment name="M-1" type="MOT"><LNode iedName="R1" lnClass="PTRC"/>'
    (feeder,) = read(tmp_path, substation=substation(f"{motor}</ConductingEquipment>")).feeders()
    assert feeder.bus is None
