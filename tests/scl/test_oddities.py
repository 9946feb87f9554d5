"""Files that are odd, or wrong in parts: told with the line, and read but for the smallest part."""

from pathlib import Path

import pytest

from tests.scl.documents import (
    COMMUNICATION,
    MEMBER,
    NODE_ZERO,
    NODES,
    TEMPLATES,
    messages,
    read,
)


@pytest.mark.parametrize(
    ("parts", "message"),
    [
        ({"header": ""}, "no Header"),
        ({"templates": TEMPLATES.replace('DA name="q"', 'DA name="q "')}, "blanks around name='q '"),
        ({"nodes": '<LN lnClass="GGIO" inst="1" lnType="GGIO"/>' * 2}, "a second logical node GGIO1"),
        ({"node_zero": ""}, "no LN0"),
        (
            {"node_zero": '<LN0 lnType="LLN0"><ReportControl name="R" datSet="gone"/></LN0>'},
            "no DataSet 'gone'",
        ),
        (
            {"node_zero": '<LN0 lnType="LLN0"><ReportControl name="R" bufTime="soon" buffered="si"/></LN0>'},
            "bufTime='soon' is no number",
        ),
        (
            {
                "node_zero": '<LN0 lnType="LLN0"><DataSet name="D">'
                '<FCDA ldInst="LD9" lnClass="GGIO" doName="Ind1" fc="ST"/></DataSet></LN0>'
            },
            "no LDevice 'LD9'",
        ),
        (
            {
                "node_zero": '<LN0 lnType="LLN0"><DataSet name="D"><FCDA lnClass="GGIO" fc="ST"/></DataSet>'
                '<DataSet name="D"/></LN0>'
            },
            "names no data without doName",
        ),
        (
            {
                "node_zero": '<LN0 lnType="LLN0"><DataSet name="D">'
                '<FCDA lnClass="GGIO" lnInst="1" doName="Ind1" fc="MX"/></DataSet></LN0>'
            },
            "the data model has no R1LD0/GGIO1.Ind1 [MX]",
        ),
        (
            {"nodes": '<LN lnClass="GGIO" lnType="GGIO"><DOI name="Ind9"/><DOI name="Ind9"/></LN>'},
            "the data type has nothing of this name",
        ),
        (
            {"nodes": '<LN lnClass="GGIO" lnType="GGIO"><DOI name="Ind1" ix="3"/></LN>'},
            "values of single array elements",
        ),
        (
            {"templates": TEMPLATES.replace('bType="Quality"', 'bType="Quantity"')},
            "bType, a basic type of IEC 61850-6, found 'Quantity'",
        ),
        ({"templates": TEMPLATES.replace('ord="5"', 'ord="five"')}, "ord='five' is no number"),
        ({"templates": TEMPLATES.replace('EnumType id="Mode"', 'EnumType id="Mood"')}, "no EnumType 'Mode'"),
        ({"templates": TEMPLATES + '<EnumType id="Mode"/>'}, "a second type of this id"),
        (
            {"templates": '<LNodeType id="GGIO" lnClass="GGIO"/>' + TEMPLATES},
            "a second type of this id: the first one counts",
        ),
        (
            {"node_zero": '<LN0 lnType="LLN0"><ReportControl name="R"/><ReportControl name="R"/></LN0>'},
            "left out: a second control block of this name, the first one counts",
        ),
        (
            {"templates": TEMPLATES.replace('<DO name="AnIn1" type="MV"/>', '<DO name="Ind1" type="MV"/>')},
            "a second member of this name",
        ),
        ({"templates": TEMPLATES.replace('name="mag"', 'name="mag" count="n"')}, "array count 'n'"),
        (
            {
                "node_zero": '<LN0 lnType="LLN0"><DataSet name="D">'
                f'<FCDA lnClass="GGIO" doName="{"x" * 130}" fc="ST"/></DataSet></LN0>'
            },
            "left out: a reference of over 129 characters",
        ),
        (
            {"node_zero": '<LN0 lnType="LLN0"><DataSet name="D 1"/><ReportControl/></LN0>'},
            "left out: name='D 1' is no name of letters, digits and _",
        ),
        (
            {
                "node_zero": '<LN0 lnType="LLN0"><DataSet name="D">'
                '<FCDA lnClass="G G" doName="Ind1" fc="ST"/></DataSet></LN0>'
            },
            "left out: names no logical node",
        ),
        (
            {"nodes": '<LN lnClass="GGIO" inst="1" lnType="GGIO"><DOI/></LN>'},
            "an instance without name: left out",
        ),
        ({"communication": COMMUNICATION.replace('apName="S1"', "")}, 'iedName="R1">: no apName'),
        (
            {
                "node_zero": '<LN0 lnType="LLN0"><DataSet name="D">'
                '<FCDA lnClass="GGIO" lnInst="1" doName="Ind1" ix="i" fc="ST"/></DataSet></LN0>'
            },
            "ix='i' is no number",
        ),
        (
            {
                "node_zero": '<LN0 lnType="LLN0"><DataSet name="D">'
                '<FCDA ldInst="R1LD0" lnClass="GGIO" lnInst="1" doName="Ind1" fc="ST"/></DataSet></LN0>'
            },
            "ldInst='R1LD0' is the name of a domain: taken as 'LD0'",
        ),
        ({"communication": COMMUNICATION.replace("R1", "R7")}, "names an IED this file does not hold"),
    ],
)
def test_oddities_become_warnings_with_a_line(tmp_path: Path, parts: dict[str, str], message: str) -> None:
    read_scl = read(tmp_path, **parts)
    assert message in messages(read_scl)
    assert all(finding.line > 0 for finding in read_scl.warnings)
    assert read_scl.ied("R1").logical_nodes()


@pytest.mark.parametrize(
    ("parts", "place", "reason"),
    [
        ({"nodes": NODES + '<LN lnClass="GGIO" lnType="gone"/>'}, "LN", 'a LNodeType with id="gone"'),
        ({"nodes": NODES + '<LN lnClass="GGIO"/>'}, "LN", "expected an attribute lnType"),
        ({"nodes": NODES + '<LN lnClass="G G" lnType="GGIO"/>'}, "LN", "lnClass of 1 to 64 letters"),
        ({"nodes": NODES * 2}, "LN", "a second logical node GGIO1"),
        (
            {"nodes": f'{NODES}<LN prefix="{"P" * 40}" lnClass="GGIO" inst="{"1" * 40}" lnType="GGIO"/>'},
            "LN",
            "a name of at most 64 characters",
        ),
        ({"templates": TEMPLATES.replace('type="MV"', 'type="gone"')}, "DO", 'a DOType with id="gone"'),
        ({"templates": TEMPLATES.replace('type="MV"', "")}, "DO", "expected an attribute type"),
        ({"templates": TEMPLATES.replace('"AnIn1"', '"An In"')}, "DO", "name of 1 to 64 letters"),
        ({"templates": TEMPLATES.replace(' fc="DC"', "")}, "DA", "expected an attribute fc"),
        ({"templates": TEMPLATES.replace('fc="DC"', 'fc="XX"')}, "DA", "fc, one of ST, MX"),
        ({"templates": TEMPLATES.replace('bType="Quality"', "")}, "DA", "expected an attribute bType"),
        ({"templates": TEMPLATES.replace('bType="Quality"', 'bType="Bits"')}, "DA", "a basic type"),
        ({"templates": TEMPLATES.replace('type="Unit"', 'type="gone"')}, "DA", 'a DAType with id="gone"'),
        ({"templates": TEMPLATES.replace('bType="Struct" type="Unit"', 'bType="Struct"')}, "DA", "type"),
        (
            {"templates": TEMPLATES.replace('<BDA name="f" bType="FLOAT32"/>', "")},
            "DA",
            "DAType 'AnalogueValue' with members, found none that can be used",
        ),
        (
            {"templates": TEMPLATES.replace('type="MV"', 'type="E"') + '<DOType id="E" cdc="E"/>'},
            "DO",
            "DOType 'E' with members",
        ),
        ({"device": 'inst="LD0"/><LDevice inst="LD/0"'}, "LDevice", "inst of 1 to 64 letters"),
        ({"device": 'inst="LD0"/><LDevice'}, "LDevice", "expected an attribute inst"),
        ({"device": f'inst="LD0"/><LDevice inst="{"L" * 64}"'}, "LDevice", "at most 64 characters together"),
        (
            {"nodes": f'{NODES}</LDevice><LDevice inst="LD0">{NODE_ZERO}'},
            "LDevice",
            "one LDevice of each inst",
        ),
        ({"nodes": f'{NODES}</LDevice><LDevice inst="9" ldName="R1LD0">'}, "LDevice", "one LDevice of each"),
        (
            {"node_zero": '<LN0 lnType="LLN0"><GSEControl name="G" type="GSSE" appID="x"/></LN0>'},
            "GSEControl",
            "GSSE",
        ),
        ({"services": '</IED><IED name="R1"/><IED name="R2">'}, "IED", "a second IED of this name"),
        ({"services": '</IED><IED/><IED name="R2">'}, "IED", "expected an attribute name"),
        ({"services": '</IED><IED name="Ä/1"/><IED name="R2">'}, "IED", "name of 1 to 64 letters"),
    ],
)
def test_what_cannot_be_used_is_left_out_and_named(
    tmp_path: Path, parts: dict[str, str], place: str, reason: str
) -> None:
    read_scl = read(tmp_path, **parts)
    (finding,) = (each for each in read_scl.warnings if each.left_out)
    assert finding.element.startswith(f"<{place}")
    assert "left out: " in finding.message
    assert reason in finding.message
    lines = read_scl.path.read_text(encoding="utf-8").splitlines()
    assert f"<{place}" in lines[finding.line - 1]


def test_all_but_what_is_left_out_is_read(tmp_path: Path) -> None:
    """One odd data object costs neither its node nor what stands beside it."""
    odd = TEMPLATES.replace(
        '<DO name="AnIn1" type="MV"/>', '<DO name="AnIn1" type="gone"/><DO name="Ind2" type="SPS"/>'
    )
    members = MEMBER + MEMBER.replace("Ind1", "AnIn1") + '<FCDA ldInst="LD0" doName="Mod" fc="ST"/>' + MEMBER
    node_zero = f'<LN0 lnType="LLN0"><DataSet name="D">{members}</DataSet></LN0>'
    read_scl = read(tmp_path, templates=odd, node_zero=node_zero)
    node = read_scl.ied("R1").logical_nodes("GGIO")[0]
    assert [data_object.name for data_object in node.data_objects] == ["Ind1", "Ind2"]
    (data_set,) = read_scl.ied("R1").data_sets()
    assert [member.path for member in data_set.members] == ["Ind1", "AnIn1", "Ind1"]
    assert "left out: names no logical node without lnClass" in messages(read_scl)
    assert "the data model has no R1LD0/GGIO1.AnIn1 [ST]" in messages(read_scl)
