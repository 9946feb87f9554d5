"""SCL files of any make, written here with the oddities that makers' files have, served by the simulator."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

import scl
from ied_sim.errors import SimulatorError
from ied_sim.simulator import Simulator
from mms import Client, FunctionalConstraint
from scl import Address
from testing.ports import LOOPBACK, free_port
from testing.waiting import wait_until
from tests.scl.documents import NODE_ZERO, TEMPLATES, scl_text, write_scl
from tests.scl.vendor_shapes import SHAPES

OPER = """<DAType id="Oper"><BDA name="ctlVal" bType="BOOLEAN"/>
  <BDA name="origin" bType="Struct" type="Origin"/><BDA name="ctlNum" bType="INT8U"/>
  <BDA name="T" bType="Timestamp"/><BDA name="Test" bType="BOOLEAN"/>
  <BDA name="Check" bType="Check"/></DAType>
  <DAType id="Origin"><BDA name="orCat" bType="INT8"/><BDA name="orIdent" bType="Octet64"/></DAType>"""
STATUS = '<DA name="stVal" bType="BOOLEAN" fc="ST" dchg="true"/>'
OPERATED = '<DA name="Oper" bType="Struct" type="Oper" fc="CO"/>'
MODEL = '<DA name="ctlModel" bType="Enum" type="CtlModel" fc="CF"><Val>1</Val></DA>'


@contextmanager
def simulated(path: Path, files: Path, *names: str) -> Iterator[tuple[Simulator, dict[str, Client]]]:
    """The simulator on a file, with a client of each of the named relays."""
    document = scl.read(path)
    addresses = {ied.name: Address(LOOPBACK, free_port()) for ied in document.ieds}
    with Simulator(document, {}, files=files, addresses=addresses) as simulator:
        clients = {name: Client.connect(LOOPBACK, simulator.addresses[name].port) for name in names}
        try:
            yield simulator, clients
        finally:
            for client in clients.values():
                client.close()


@pytest.mark.parametrize(
    "attributes",
    [
        pytest.param(OPERATED + MODEL, id="a control without stVal"),
        pytest.param(OPERATED + STATUS, id="a control without ctlModel"),
        pytest.param(OPERATED + STATUS + MODEL.replace("<Val>1</Val>", ""), id="a ctlModel without value"),
        pytest.param(
            OPERATED + STATUS + MODEL.replace('bType="Enum"', 'bType="Unicode255"'), id="ctlModel text"
        ),
        pytest.param(OPERATED + STATUS.replace("BOOLEAN", "INT32") + MODEL, id="a number as status"),
        pytest.param(STATUS + MODEL, id="no Oper"),
        pytest.param(OPERATED, id="nothing but Oper"),
        pytest.param(MODEL, id="nothing but ctlModel"),
        pytest.param(STATUS.replace("/>", ' count="3"/>') + OPERATED + MODEL, id="an array as status"),
        pytest.param(
            OPERATED.replace('bType="Struct" type="Oper"', 'bType="BOOLEAN"') + MODEL, id="a flat Oper"
        ),
    ],
)
def test_controls_of_all_shapes_are_served(tmp_path: Path, attributes: str) -> None:
    control = f'<DOType id="Control" cdc="SPC">{attributes}</DOType>'
    zero = TEMPLATES.replace(
        '<DO name="Mod" type="Mod"/>', '<DO name="Mod" type="Mod"/><DO name="PhRot" type="Control"/>'
    )
    path = write_scl(tmp_path / "relay.cid", scl_text(templates=zero + control + OPER))
    with simulated(path, tmp_path / "files", "R1") as (simulator, clients):
        assert "PhRot" in clients["R1"].data_objects("R1LD0/LLN0")
        assert not simulator.left_out


@pytest.mark.parametrize("shape", SHAPES)
def test_relays_of_every_edition_are_served_without_a_profile(shape: str, tmp_path: Path) -> None:
    path = write_scl(tmp_path / shape, SHAPES[shape])
    (ied,) = scl.read(path).ieds
    with simulated(path, tmp_path / "files", ied.name) as (_, clients):
        domains = {device.name for device in ied.logical_devices}
        assert set(clients[ied.name].logical_devices()) == domains


def test_a_relay_is_triggered_by_the_point_of_its_standard_name(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    """An edition 2 recorder without remote bits: RcdTrg makes a record, RcdMade and FltNum tell of it."""
    path = write_scl(tmp_path / "relay.iid", SHAPES["edition-2.iid"])
    with simulated(path, tmp_path / "files", "RELAY_2") as (_, clients):
        client = clients["RELAY_2"]
        client.operate("RELAY_2PRO/FLTRDRE1.RcdTrg", value=True)
        made = "RELAY_2PRO/FLTRDRE1.RcdMade.stVal"
        wait_until(lambda: client.read(made, FunctionalConstraint.ST) is True, "a record")
        assert {entry.name.rpartition(".")[2] for entry in client.files("EVENTS")} == {"CFG", "DAT", "HDR"}
    assert "RELAY_2: not all points of sel-710-ed2 are in its model: " in caplog.text
    assert "trigger is PRO/FLTRDRE1.RcdTrg" in caplog.text


ODD_IED = """<IED name="{}"><AccessPoint name="S1"><Server><Authentication/><LDevice inst="LD0">{}</LDevice>
  </Server></AccessPoint></IED>"""


def test_one_odd_ied_does_not_keep_a_plant_from_starting(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    """R1 is served; the others have no node type, no server, no LDevice, R1's name, or a name of blanks."""
    others = (
        ODD_IED.format("EMPTY", '<LN0 lnClass="LLN0" inst="" lnType="gone"/>')
        + '<IED name="CLIENT"><AccessPoint name="S1"/></IED>'
        + ODD_IED.format("R1", NODE_ZERO)
        + ODD_IED.format("A B", NODE_ZERO)
        + ODD_IED.format("R2", NODE_ZERO)
    )
    path = write_scl(tmp_path / "plant.scd", scl_text().replace("</IED>", f"</IED>{others}"))
    with simulated(path, tmp_path / "files", "R1", "R2") as (simulator, clients):
        assert all(client.logical_devices() for client in clients.values())
        assert set(simulator.left_out) == {"EMPTY", "CLIENT"}
    assert "EMPTY is not served: " in caplog.text
    assert "CLIENT is not served: it has no server" in caplog.text


def test_a_file_without_a_relay_to_serve_says_why(tmp_path: Path) -> None:
    text = scl_text(node_zero="", nodes="")
    document = scl.read(write_scl(tmp_path / "relay.icd", text))
    with pytest.raises(SimulatorError, match=r"no relay to serve: R1: .*logical node with data objects"):
        Simulator(document, {}, files=tmp_path, addresses={"R1": Address(LOOPBACK, free_port())})
    with pytest.raises(SimulatorError, match=r"R1: .*found none; --host and --port give it an address"):
        Simulator(scl.read(write_scl(tmp_path / "no.cid", scl_text(communication=""))), {}, files=tmp_path)


def test_relays_of_one_address_are_told(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    """Files of makers have one and the same address in all of them."""
    port = free_port()
    address = f'<Address><P type="IP">{LOOPBACK}</P><P type="MMS-Port">{port}</P></Address></ConnectedAP>'
    network = "".join(f'<ConnectedAP iedName="{name}" apName="S1">{address}' for name in ("R1", "R2"))
    text = scl_text(
        communication=f'<Communication><SubNetwork name="N">{network}</SubNetwork></Communication>'
    ).replace("</IED>", "</IED>" + ODD_IED.format("R2", NODE_ZERO))
    document = scl.read(write_scl(tmp_path / "plant.scd", text))
    simulator = Simulator(document, {}, files=tmp_path)
    simulator.stop()
    assert list(simulator.relays) == ["R1"]
    assert f"R2 is not served: R1 has its address, {LOOPBACK}:{port}" in caplog.text


def test_a_control_whose_model_the_file_leaves_open_can_be_operated(tmp_path: Path) -> None:
    """Oper says that it is operable; files of whole families leave ctlModel to the engineer."""
    shape = SHAPES["edition-2.iid"].replace("<Val>direct-with-normal-security</Val>", "")
    path = write_scl(tmp_path / "relay.iid", shape)
    with simulated(path, tmp_path / "files", "RELAY_2") as (_, clients):
        clients["RELAY_2"].operate("RELAY_2PRO/FLTRDRE1.RcdTrg", value=True)
        wait_until(lambda: clients["RELAY_2"].files("EVENTS"), "a record")


ARRAYS = TEMPLATES.replace('<DO name="AnIn1" type="MV"/>', '<DO name="HA" type="HMV"/>').replace(
    '<DOType id="MV"',
    '<DOType id="HMV" cdc="HMV"><SDO name="har" type="MV" count="64"/></DOType><DOType id="MV"',
)


@pytest.mark.parametrize(
    ("member", "served"),
    [
        ('doName="HA.har" daName="mag.f" ix="63"', 1),
        ('doName="HA.har" daName="mag.f" ix="64"', 0),
        ('doName="HA.har" daName="mag.f"', 0),
        ('doName="HA.har"', 1),
    ],
)
def test_members_beyond_an_array_are_not_served(tmp_path: Path, member: str, served: int) -> None:
    """The MMS library dies of reading an element that an array has not."""
    data_set = f'<DataSet name="D"><FCDA lnClass="GGIO" lnInst="1" {member} fc="MX"/></DataSet>'
    node_zero = f'<LN0 lnClass="LLN0" inst="" lnType="LLN0">{data_set}</LN0>'
    path = write_scl(tmp_path / "relay.cid", scl_text(templates=ARRAYS, node_zero=node_zero))
    with simulated(path, tmp_path / "files", "R1") as (_, clients):
        assert len(clients["R1"].read_data_set("R1LD0/LLN0.D")) == served


def test_a_status_of_a_wrong_constraint_is_not_published(tmp_path: Path) -> None:
    """The MMS library has no value for what is only operated."""
    quality = '<DA name="q" bType="Quality" fc="ST"'
    shape = SHAPES["edition-2.iid"].replace(quality, quality.replace("ST", "CO"))
    path = write_scl(tmp_path / "relay.iid", shape)
    with simulated(path, tmp_path / "files", "RELAY_2") as (_, clients):
        assert clients["RELAY_2"].read("RELAY_2PRO/FLTRDRE1.RcdMade.stVal", FunctionalConstraint.ST) is False


def test_an_ied_and_devices_with_hyphens_are_served(tmp_path: Path) -> None:
    text = scl_text(device='inst="BAY-1"').replace('"R1"', '"MCC-R1"')
    path = write_scl(tmp_path / "relay.cid", text)
    with simulated(path, tmp_path / "files", "MCC-R1") as (_, clients):
        assert clients["MCC-R1"].read("MCC-R1BAY-1/GGIO1.Ind1.stVal", FunctionalConstraint.ST) is False
