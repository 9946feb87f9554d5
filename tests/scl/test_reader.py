"""What the reader makes of an SCL file: types resolved, instances laid over them, oddities reported."""

import pickle
from pathlib import Path

import pytest

import scl
from scl import SclError
from scl.data_model import DataAttribute, FunctionalConstraint, TriggerOptions
from tests.scl.documents import (
    MEMBER,
    TEMPLATES,
    messages,
    read,
    scl_text,
    write_scl,
)


def attribute(read_scl: scl.Scl, reference: str) -> DataAttribute:
    found = read_scl.ied("R1").find(reference)
    assert isinstance(found, DataAttribute)
    return found


def test_components_of_a_struct_take_constraint_and_triggers_of_the_attribute(tmp_path: Path) -> None:
    magnitude = attribute(read(tmp_path), "LD0/GGIO1.AnIn1.mag.f")
    assert magnitude.fc is FunctionalConstraint.MX
    assert magnitude.trigger_options is TriggerOptions.DATA_CHANGE


def test_instance_values_stand_over_type_defaults(tmp_path: Path) -> None:
    read_scl = read(
        tmp_path,
        nodes="""<LN lnClass="GGIO" inst="1" lnType="GGIO">
          <DOI name="Ind1"><DAI name="d"><Val>from the instance</Val></DAI></DOI>
          <DOI name="AnIn1"><SDI name="units"><DAI name="SIUnit"><Val>V</Val></DAI></SDI></DOI>
        </LN><LN lnClass="GGIO" inst="2" lnType="GGIO"/>""",
    )
    assert read_scl.warnings == ()
    assert attribute(read_scl, "R1LD0/GGIO1.Ind1.d").value == "from the instance"
    assert attribute(read_scl, "LD0/GGIO1.AnIn1.units.SIUnit").ordinal == 29
    assert attribute(read_scl, "LD0/GGIO2.Ind1.d").value == "from the type"
    assert attribute(read_scl, "LD0/GGIO2.AnIn1.units.SIUnit").ordinal == 5


def test_value_of_the_first_setting_group_is_taken(tmp_path: Path) -> None:
    node = """<LN lnClass="GGIO" inst="1" lnType="GGIO"><DOI name="Ind1"><DAI name="d">
      <Val sGroup="1">one</Val><Val sGroup="2">two</Val></DAI></DOI></LN>"""
    assert attribute(read(tmp_path, nodes=node), "LD0/GGIO1.Ind1.d").value == "one"


@pytest.mark.parametrize(
    ("attributes", "edition"),
    [
        ("", "1"),
        ('version="2007" revision="A"', "2"),
        ('version="2007" revision="B"', "2"),
        ('version="2007" revision="B" release="4"', "2.1"),
    ],
)
def test_editions(tmp_path: Path, attributes: str, edition: str) -> None:
    read_scl = read(tmp_path, root=f'xmlns="http://www.iec.ch/61850/2003/SCL" {attributes}')
    assert read_scl.header.edition == edition


def test_private_and_foreign_parts_are_passed_over(tmp_path: Path) -> None:
    read_scl = read(
        tmp_path,
        root='xmlns="http://www.iec.ch/61850/2003/SCL" xmlns:x="urn:vendor" version="2007"',
        services='<Private type="x"><x:IED name="R2"/><LDevice/></Private><x:AccessPoint name="no"/>',
        nodes="""<!-- comment --><?instruction?><x:LN/>
          <LN lnClass="GGIO" inst="1" lnType="GGIO"><Private type="x"><x:Val>3</x:Val></Private></LN>""",
    )
    assert read_scl.warnings == ()
    assert [node.name for node in read_scl.ied("R1").logical_nodes()] == ["LLN0", "GGIO1"]


def test_file_without_namespace_is_read_with_a_warning(tmp_path: Path) -> None:
    read_scl = read(tmp_path, root='version="2007"')
    assert attribute(read_scl, "LD0/GGIO1.Ind1.q").basic_type == "Quality"
    assert "no namespace" in messages(read_scl)


def test_ld_name_is_the_domain_and_data_sets_follow_it(tmp_path: Path) -> None:
    node_zero = """<LN0 lnClass="LLN0" inst="" lnType="LLN0"><DataSet name="DS1">
        <FCDA ldInst="LD0" lnClass="GGIO" lnInst="1" doName="AnIn1" daName="mag.f" fc="MX"/>
      </DataSet></LN0>"""
    ied = read(tmp_path, device='inst="LD0" ldName="Motor7"', node_zero=node_zero).ied("R1")
    assert [device.name for device in ied.logical_devices] == ["Motor7"]
    (data_set,) = ied.data_sets(covering="Motor7/GGIO1.AnIn1")
    assert data_set.reference == "Motor7/LLN0.DS1"
    assert not data_set.covers("Motor7/GGIO1.AnIn10")
    assert not data_set.covers("Motor7/GGIO1.AnIn1.q")


def test_indexed_reports_have_one_control_block_a_client(tmp_path: Path) -> None:
    node_zero = """<LN0 lnClass="LLN0" lnType="LLN0">
      <ReportControl name="Meas" buffered="false" confRev="3" intgPd="1000" bufTime="20">
        <TrgOps period="true"/><OptFields seqNum="true" bufOvfl="false"/><RptEnabled max="3"/></ReportControl>
      <ReportControl name="Ev" indexed="false" buffered="true" confRev="1"><OptFields/></ReportControl>
    </LN0>"""
    metering, events = read(tmp_path, node_zero=node_zero).ied("R1").report_controls()
    assert metering.instances == ("Meas01", "Meas02", "Meas03")
    assert metering.references[2] == "R1LD0/LLN0.RP.Meas03"
    assert metering.trigger_options == TriggerOptions.INTEGRITY | TriggerOptions.GENERAL_INTERROGATION
    assert (metering.integrity_period_ms, metering.buffer_time_ms) == (1000, 20)
    assert events.references == ("R1LD0/LLN0.BR.Ev",)
    assert events.data_set is None


def test_logs_settings_and_goose(tmp_path: Path) -> None:
    node_zero = """<LN0 lnClass="LLN0" lnType="LLN0">
      <DataSet name="DS1"><FCDA ldInst="LD0" lnClass="GGIO" lnInst="1" doName="Ind1" fc="ST"/></DataSet>
      <LogControl name="EventLog" datSet="DS1" logName="GeneralLog"/><SettingControl numOfSGs="3" actSG="2"/>
      <GSEControl name="Trip" appID="R1 trip" datSet="DS1" confRev="7"/>
      <GSEControl name="Old" type="GSSE" appID="x"/><Log/></LN0>"""
    communication = """<Communication><SubNetwork name="N"><ConnectedAP iedName="R1" apName="S1">
      <GSE ldInst="LD0" cbName="Trip"><Address><P type="MAC-Address">01-0C-CD-01-00-03</P>
        <P type="APPID">3001</P><P type="VLAN-ID">00A</P><P type="VLAN-PRIORITY">4</P></Address>
        <MinTime unit="s" multiplier="m">4</MinTime></GSE>
      <GSE ldInst="LD0" cbName="Old"><Address><P type="MAC-Address">everywhere</P></Address></GSE>
      </ConnectedAP></SubNetwork></Communication>"""
    read_scl = read(tmp_path, node_zero=node_zero, communication=communication)
    node = read_scl.ied("R1").logical_nodes("LLN0")[0]
    assert node.setting_groups is not None
    assert (node.setting_groups.number, node.setting_groups.active) == (3, 2)
    assert node.logs == ("GeneralLog",)
    assert (node.log_controls[0].data_set, node.log_controls[0].log) == ("DS1", "GeneralLog")
    (goose,) = node.goose_controls
    assert goose.address is not None
    assert goose.address.mac == bytes.fromhex("010CCD010003")
    assert (goose.address.application_id, goose.address.vlan_id) == (0x3001, 10)
    assert (goose.address.minimum_time_ms, goose.address.maximum_time_ms) == (4, None)
    assert "no usable multicast address" in messages(read_scl)


@pytest.mark.parametrize(
    "namespace",
    [
        "http://www.iec.ch/61850/2006/SCL",
        "http://www.iec.ch/61850/2003/SCL/",
        "https://www.iec.ch/61850/2007/SCL",
        "http://www.IEC.ch/61850/2003/scl",
    ],
)
def test_other_spellings_of_the_namespace_are_told_and_read(tmp_path: Path, namespace: str) -> None:
    read_scl = read(tmp_path, root=f'xmlns="{namespace}"')
    assert f"{namespace} namespace: read as http://www.iec.ch/61850/2003/SCL" in messages(read_scl)
    assert read_scl.ied("R1").logical_nodes("GGIO")
    assert read_scl.address("R1").host == "10.0.0.7"


def test_names_with_an_undeclared_prefix_are_told_once_and_passed_over(tmp_path: Path) -> None:
    read_scl = read(tmp_path, nodes='<LN lnClass="GGIO" inst="1" lnType="GGIO" xsi:type="tLN"/><v:Odd/>')
    assert read_scl.ied("R1").logical_nodes("GGIO")
    assert messages(read_scl).count("not defined") == 1
    assert "Namespace prefix xsi for type on LN is not defined" in messages(read_scl)


def test_a_fault_is_named_also_beside_an_undeclared_prefix(tmp_path: Path) -> None:
    path = write_scl(tmp_path / "cut.scd", scl_text(nodes='<LN xsi:type="tLN">'))
    with pytest.raises(SclError, match="Opening and ending tag mismatch: LN"):
        scl.read(path)


@pytest.mark.parametrize("root", ['xmlns="urn:something"', 'xmlns="http://www.iec.ch/61850/2003/CIM"'])
def test_another_document_is_an_error_with_place(tmp_path: Path, root: str) -> None:
    with pytest.raises(SclError) as caught:
        read(tmp_path, root=root)
    assert "a root element SCL" in str(caught.value)
    assert "relay.cid" in str(caught.value)
    assert caught.value.line
    assert caught.value.found


def test_harmonics_of_several_thousand_attributes_are_read(tmp_path: Path) -> None:
    """Seven spectra of 64 harmonics, as power quality relays have them."""
    spectra = "".join(
        f'<SDO name="{name}Har" type="CMV" count="64"/>'
        for name in ("phsA", "phsB", "phsC", "neut", "net", "res", "zero")
    )
    types = (
        f'<DOType id="HWYE" cdc="HWYE">{spectra}</DOType><DOType id="CMV" cdc="CMV">'
        '<DA name="cVal" bType="Struct" type="Vector" fc="MX"/><DA name="q" bType="Quality" fc="MX"/>'
        '<DA name="t" bType="Timestamp" fc="MX"/>'
        '<DA name="units" bType="Struct" type="Unit" fc="CF"/></DOType>'
        '<DAType id="Vector"><BDA name="mag" bType="Struct" type="AnalogueValue"/></DAType>'
    )
    templates = TEMPLATES.replace('<DO name="AnIn1" type="MV"/>', '<DO name="HA" type="HWYE"/>') + types
    read_scl = read(tmp_path, templates=templates)
    assert not [each for each in read_scl.warnings if each.left_out]
    assert read_scl.ied("R1").find("R1LD0/GGIO1.HA.phsAHar.cVal.mag.f") is not None


def test_a_node_without_a_type_still_has_its_data_sets_and_blocks(tmp_path: Path) -> None:
    blocks = '<ReportControl name="R" datSet="D" confRev="1"/>'
    node_zero = (
        f'<LN0 lnClass="LLN0" inst="" lnType="gone"><DataSet name="D">{MEMBER}</DataSet>{blocks}</LN0>'
    )
    read_scl = read(tmp_path, node_zero=node_zero)
    (report,) = read_scl.ied("R1").report_controls()
    assert report.data_set is not None
    assert report.data_set.members[0].path == "Ind1"
    assert "its data objects are left out: expected a LNodeType" in messages(read_scl)


def test_names_too_long_for_mms_are_left_out(tmp_path: Path) -> None:
    prefix = "A" * 45
    nodes = f'<LN prefix="{prefix}" lnClass="GGIO" inst="1" lnType="GGIO"/>'
    read_scl = read(tmp_path, nodes=nodes)
    node = read_scl.ied("R1").logical_nodes("GGIO")[0]
    assert [data_object.name for data_object in node.data_objects] == ["Ind1"]
    longest = len(f"{prefix}GGIO1$ST$AnIn1$units$SIUnit")
    assert f"AnIn1 is left out: its longest MMS name has {longest} characters" in messages(read_scl)


def test_missing_file_and_folder_are_named(tmp_path: Path) -> None:
    with pytest.raises(SclError, match=r"absent\.scd: expected a readable file, found No such file"):
        scl.read(tmp_path / "absent.scd")
    with pytest.raises(SclError, match="readable file"):
        scl.read(tmp_path)
    with pytest.raises(SclError, match="file name"):
        scl.read("a\0b")


def test_truncated_file_names_the_line(tmp_path: Path) -> None:
    path = write_scl(tmp_path / "cut.scd", scl_text()[:900])
    with pytest.raises(SclError, match="expected well-formed XML") as caught:
        scl.read(path)
    assert caught.value.line


def test_error_survives_the_way_between_processes() -> None:
    error = SclError("a.scd", line=3, element="<LN>", expected="this", found="that")
    copy = pickle.loads(pickle.dumps(error))  # noqa: S301
    assert str(copy) == str(error) == "a.scd: line 3: <LN>: expected this, found that"
