"""The model text: what libiec61850 serves from it is the file's data model; nothing breaks its grammar."""

from pathlib import Path

import pytest

import mms
import scl
from mms import FunctionalConstraint
from scl import Scl, SclError
from scl.logical_node import LogicalNode
from scl.model_text import model_text
from testing.relays.browsing import served
from tests.scl.documents import NODE_ZERO, TEMPLATES, scl_text, write_scl


def read_text(tmp_path: Path, **parts: str) -> str:
    return model_text(scl.read(write_scl(tmp_path / "relay.cid", scl_text(**parts))), "R1")


def line_of(text: str, start: str) -> str:
    return next(line for line in text.splitlines() if line.startswith(start))


def check_node(client: mms.Client, node: LogicalNode) -> None:
    names = {data_object.name for data_object in node.data_objects}
    assert set(client.data_objects(node.reference)) == names
    assert set(client.data_sets(node.reference)) == {data_set.name for data_set in node.data_sets}
    for buffered, listed in (
        (True, client.buffered_reports(node.reference)),
        (False, client.unbuffered_reports(node.reference)),
    ):
        assert set(listed) == {
            instance
            for report in node.report_controls
            if report.buffered is buffered
            for instance in report.instances
        }
    for data_set in node.data_sets:
        assert [str(member) for member in client.data_set_directory(data_set.reference)] == [
            f"{member.reference}[{member.fc}]" for member in data_set.members
        ]


def test_served_relay_has_the_data_model_of_the_scd() -> None:
    plant: Scl = scl.read(scl.DEMO_PLANT_SCD)
    ied = plant.ied("B2_SEL710")
    with served(model_text(plant, ied.name)) as client:
        assert set(client.logical_devices()) == {device.name for device in ied.logical_devices}
        for device in ied.logical_devices:
            assert set(client.logical_nodes(device.name)) == {node.name for node in device.logical_nodes}
            for node in device.logical_nodes:
                check_node(client, node)
        assert client.read("B2_SEL710CON/RBGGIO1.SPCSO01.ctlModel", FunctionalConstraint.CF) == 1
        assert client.read("B2_SEL710CON/RBGGIO1.SPCSO02.d", FunctionalConstraint.DC) == "RB02"
        assert client.read("B2_SEL710CFG/LLN0.Mod.stVal", FunctionalConstraint.ST) == 1
        assert client.read("B2_SEL710MET/METMMXU1.Hz.units.SIUnit", FunctionalConstraint.CF) == 33
        assert client.read("B2_SEL710CFG/LLN0.NamPlt.vendor", FunctionalConstraint.DC) == "SEL"


EVERYTHING = """
  <LNodeType id="LLN0" lnClass="LLN0"><DO name="Mod" type="All"/></LNodeType>
  <DOType id="All" cdc="X">
    <DA name="stVal" bType="BOOLEAN" fc="ST"><Val>TRUE</Val></DA>
    <DA name="i8" bType="INT8" fc="ST"><Val>-129</Val></DA>
    <DA name="i32" bType="INT32" fc="ST"><Val>-2147483648</Val></DA>
    <DA name="u32" bType="INT32U" fc="ST"><Val>4294967295</Val></DA>
    <DA name="no" bType="INT32" fc="ST"><Val>many</Val></DA>
    <DA name="f32" bType="FLOAT32" fc="ST"><Val>1.5e-3</Val></DA>
    <DA name="f64" bType="FLOAT64" fc="ST"><Val>inf</Val></DA>
    <DA name="fx" bType="FLOAT32" fc="ST"><Val>1,5</Val></DA>
    <DA name="text" bType="VisString64" fc="DC"><Val>say "R_TRIG" = {
      twice µ{</Val></DA>
    <DA name="dU" bType="Unicode255" fc="DC"><Val>Überlast</Val></DA>
    <DA name="pos" bType="Dbpos" fc="ST"><Val>on</Val></DA>
    <DA name="mode" bType="Enum" type="Mode" fc="ST"><Val>5</Val></DA>
    <DA name="odd" bType="Enum" type="Mode" fc="ST"><Val>nowhere</Val></DA>
    <DA name="opt" bType="Optional" fc="SP"/>
    <DA name="set" bType="INT32" fc="SE"><Val>7</Val></DA>
  </DOType>
  <EnumType id="Mode"><EnumVal ord="1">on</EnumVal></EnumType>
"""


def test_initial_values_the_grammar_can_carry(tmp_path: Path) -> None:
    text = read_text(tmp_path, templates=EVERYTHING, nodes="")
    for start, end in [
        ("DA(stVal ", "=1;"),
        ("DA(i8 ", "0);"),
        ("DA(i32 ", "=-2147483648;"),
        ("DA(u32 ", "=4294967295;"),
        ("DA(no ", "0);"),
        ("DA(f32 ", "=0.0015;"),
        ("DA(f64 ", "0);"),
        ("DA(fx ", "0);"),
        ("DA(dU ", '="Überlast";'),
        ("DA(pos ", "0);"),
        ("DA(mode ", "=5;"),
        ("DA(odd ", "0);"),
    ]:
        assert line_of(text, start).endswith(end)
    assert "opt" not in text
    assert [line for line in text.splitlines() if line.startswith("DA(set")] == [
        "DA(set 0 3 6 0 0)=7;",
        "DA(set 0 3 7 0 0)=7;",
    ]
    with served(text) as client:
        description = client.read("R1LD0/LLN0.Mod.text", FunctionalConstraint.DC)
        assert description == "say 'R_TRIG' = {      twice ?"


def test_control_blocks_are_written_for_the_parser(tmp_path: Path) -> None:
    node_zero = """<LN0 lnClass="LLN0" lnType="LLN0">
      <DataSet name="DS1"><FCDA ldInst="LD0" lnClass="GGIO" lnInst="1" doName="Ind1" fc="ST"/>
        <FCDA ldInst="LD0" lnClass="GGIO" lnInst="1" doName="Gone" fc="ST"/></DataSet>
      <ReportControl name="Ev" datSet="DS1" rptID="with blank" buffered="true" confRev="2" bufTime="5">
        <TrgOps dchg="true"/><OptFields entryID="true"/><RptEnabled max="2"/></ReportControl>
      <LogControl name="EventLog" datSet="DS1" logName="GeneralLog"/><Log name="GeneralLog"/>
      <GSEControl name="Trip" appID="R1Trip" datSet="DS1" confRev="7"/><GSEControl name="Idle" appID="x"/>
      <SettingControl numOfSGs="3" actSG="2"/></LN0>"""
    communication = """<Communication><SubNetwork name="N"><ConnectedAP iedName="R1" apName="S1">
      <GSE ldInst="LD0" cbName="Trip"><Address><P type="MAC-Address">01-0C-CD-01-00-03</P>
        <P type="APPID">3001</P><P type="VLAN-ID">00A</P></Address><MaxTime>1000</MaxTime></GSE>
      </ConnectedAP></SubNetwork></Communication>"""
    services = '<Services><ReportSettings owner="true"/></Services>'
    text = read_text(tmp_path, node_zero=node_zero, communication=communication, services=services)
    lines = text.splitlines()
    assert "RC(Ev01 - 1 DS1 2 81 96 5 0);" in lines
    assert "RC(Ev02 - 1 DS1 2 81 96 5 0);" in lines
    assert "LC(EventLog DS1 LD0/LLN0$GeneralLog 16 0 1 1);" in lines
    assert "LOG(GeneralLog);" in lines
    assert "SG(2 3)" in lines
    assert "GC(Trip R1Trip DS1 7 0 -1 1000 ){" in lines
    assert "PA(4 10 12289 010ccd010003);" in lines
    assert [line for line in lines if line.startswith("DE")] == ["DE(GGIO1$ST$Ind1);"]
    with served(text) as client:
        assert client.buffered_reports("R1LD0/LLN0") == ["Ev01", "Ev02"]
        assert len(client.data_set_directory("R1LD0/LLN0.DS1")) == 1


@pytest.mark.parametrize(
    ("member", "entry"),
    [
        ('doName="Har.har" daName="mag.f" ix="1" fc="MX"', "DE(GGIO1$MX$Har$har 1 mag$f);"),
        ('doName="Har.har(1)" daName="mag.f" fc="MX"', "DE(GGIO1$MX$Har$har 1 mag$f);"),
        ('doName="Har.har" ix="1" fc="MX"', "DE(GGIO1$MX$Har$har 1);"),
        ('doName="Ind1" ix="1" fc="ST"', "DE(GGIO1$ST$Ind1);"),
    ],
)
def test_array_elements_in_data_sets(tmp_path: Path, member: str, entry: str) -> None:
    templates = TEMPLATES.replace('<DO name="AnIn1" type="MV"/>', '<DO name="Har" type="HMV"/>').replace(
        "<DAType ", '<DOType id="HMV" cdc="HMV"><SDO name="har" type="MV" count="3"/></DOType><DAType ', 1
    )
    node_zero = NODE_ZERO.replace(
        "/>", f'><DataSet name="DS"><FCDA ldInst="LD0" lnClass="GGIO" lnInst="1" {member}/></DataSet></LN0>'
    )
    assert entry in read_text(tmp_path, templates=templates, node_zero=node_zero).splitlines()


def test_members_in_other_logical_devices_and_ld_names(tmp_path: Path) -> None:
    nodes = """</LDevice><LDevice inst="LD1" ldName="Second"><LN0 lnClass="LLN0" lnType="LLN0">
      <DataSet name="DS"><FCDA ldInst="LD0" lnClass="LLN0" doName="Mod" daName="stVal" fc="ST"/></DataSet>
      </LN0>"""
    lines = read_text(tmp_path, nodes=nodes).splitlines()
    assert lines[0] == "MODEL{"
    assert "LD(R1LD0){" in lines
    assert "LD(Second){" in lines
    assert "DE(R1LD0/LLN0$ST$Mod$stVal);" in lines


def test_transient_objects_are_marked(tmp_path: Path) -> None:
    templates = TEMPLATES.replace(
        '<DO name="Ind1" type="SPS"/>', '<DO name="Ind1" type="SPS" transient="true"/>'
    )
    assert "DA(q 0 23 0 130 0);" in read_text(tmp_path, templates=templates).splitlines()


def test_ied_that_serves_nothing_has_no_model(tmp_path: Path) -> None:
    text = scl_text().replace("</IED>", '</IED><IED name="Client"><AccessPoint name="A"/></IED>')
    read = scl.read(write_scl(tmp_path / "plant.scd", text))
    with pytest.raises(SclError, match="expected an access point with a Server"):
        model_text(read, "Client")


def test_words_longer_than_the_parser_s_buffers_are_refused(tmp_path: Path) -> None:
    node_zero = f"""<LN0 lnClass="LLN0" lnType="LLN0" prefix="{"P" * 50}">
      <LogControl name="L" logName="{"l" * 64}"/></LN0>"""
    with pytest.raises(SclError, match="128 characters a name"):
        read_text(tmp_path, node_zero=node_zero, device=f'inst="{"d" * 60}"')


@pytest.mark.parametrize(
    ("attributes", "model"),
    [
        ('<DA name="Oper" bType="BOOLEAN" fc="CO"/>', "=1"),
        ('<DA name="SBO" bType="VisString64" fc="CO"/><DA name="Oper" bType="BOOLEAN" fc="CO"/>', "=2"),
        ('<DA name="SBOw" bType="BOOLEAN" fc="CO"/><DA name="Oper" bType="BOOLEAN" fc="CO"/>', "=4"),
        ("", ""),
    ],
)
def test_a_control_model_that_the_file_leaves_open_follows_from_the_control(
    tmp_path: Path, attributes: str, model: str
) -> None:
    open_model = '<DA name="ctlModel" bType="Enum" type="CtlModel" fc="CF"/>'
    control = f'<DOType id="SPC" cdc="SPC">{attributes}{open_model}</DOType>'
    templates = TEMPLATES.replace('<DO name="AnIn1" type="MV"/>', '<DO name="SPCSO1" type="SPC"/>') + control
    document = scl.read(write_scl(tmp_path / "relay.cid", scl_text(templates=templates)))
    assert f"DA(ctlModel 0 12 4 0 0){model};" in model_text(document, "R1").partition("SPCSO1")[2]
