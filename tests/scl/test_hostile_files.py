"""Files that try to do harm or make no sense: findings, or SclError and nothing else, quickly."""

from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import scl
from scl import SclError
from scl.document import MOST_FINDINGS
from scl.model_text import model_text
from scl.xml_file import MOST_ATTRIBUTES
from tests.scl.documents import TEMPLATES, scl_text, write_scl

PLANT = scl.DEMO_PLANT_SCD.read_bytes()

each_example_writes_its_own_file = settings(
    max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)


def outcome(path: Path, content: bytes) -> None:
    """Read, and use what was read as the service and the simulator do; only SclError may be raised."""
    path.write_bytes(content)
    try:
        read = scl.read(path)
        for ied in read.ieds[:2]:
            model_text(read, ied.name)
            read.address(ied.name)
            ied.report_controls(covering=f"{ied.name}PRO/FLTRDRE1.RcdMade")
        read.feeders()
    except SclError:
        return


@each_example_writes_its_own_file
@given(content=st.binary(max_size=400))
def test_any_bytes(tmp_path: Path, content: bytes) -> None:
    outcome(tmp_path / "any.scd", content)


@each_example_writes_its_own_file
@given(
    position=st.integers(0, len(PLANT)),
    cut=st.integers(0, 200),
    insert=st.one_of(
        st.binary(max_size=20), st.sampled_from([b"<LN/>", b"<Val>", b'"', b"</DO>", b"\xff\xfe"])
    ),
)
def test_a_damaged_plant(tmp_path: Path, position: int, cut: int, insert: bytes) -> None:
    outcome(tmp_path / "damaged.scd", PLANT[:position] + insert + PLANT[position + cut :])


WORDS = sorted(set(PLANT.decode().replace("<", " ").replace(">", " ").replace('"', " ").split()))


@each_example_writes_its_own_file
@given(
    old=st.sampled_from(WORDS),
    new=st.one_of(
        st.sampled_from(WORDS),
        st.text(
            st.characters(min_codepoint=32, exclude_categories=["Cs"], exclude_characters='<>&"'), max_size=80
        ),
    ),
)
def test_a_plant_with_one_word_replaced(tmp_path: Path, old: str, new: str) -> None:
    outcome(tmp_path / "replaced.scd", PLANT.replace(old.encode(), new.encode()))


@pytest.mark.parametrize(
    "declaration",
    [
        '<!DOCTYPE SCL [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;&a;&a;">]>',
        '<!DOCTYPE SCL [<!ENTITY a SYSTEM "file:///etc/hostname">]>',
        '<!DOCTYPE SCL SYSTEM "http://192.0.2.1/scl.dtd">',
        "<!DOCTYPE SCL>",
    ],
)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
def test_a_document_type_is_refused(tmp_path: Path, declaration: str, encoding: str) -> None:
    text = scl_text().replace("<SCL ", f"{declaration}<SCL ", 1).replace("UTF-8", encoding)
    path = tmp_path / "typed.scd"
    path.write_bytes(text.encode(encoding))
    with pytest.raises(SclError, match="no document type declaration"):
        scl.read(path)


def test_an_entity_bomb_is_refused(tmp_path: Path) -> None:
    levels = "".join(f'<!ENTITY e{level} "{f"&e{level - 1};" * 20}">' for level in range(1, 12))
    bomb = f'<!DOCTYPE SCL [<!ENTITY e0 "{"x" * 100}">{levels}]>'
    text = scl_text(header='<Header id="&e11;"/>').replace("<SCL ", f"{bomb}<SCL ", 1)
    with pytest.raises(SclError):
        scl.read(write_scl(tmp_path / "bomb.scd", text))


def test_deep_nesting_is_refused(tmp_path: Path) -> None:
    nested = '<SDI name="a">' * 5000 + "</SDI>" * 5000
    nodes = f'<LN lnClass="GGIO" lnType="GGIO"><DOI name="Ind1">{nested}</DOI></LN>'
    with pytest.raises(SclError, match="well-formed XML"):
        scl.read(write_scl(tmp_path / "deep.scd", scl_text(nodes=nodes)))


@pytest.mark.parametrize("beginning", ["a", "x:a"], ids=["of SCL", "of another namespace"])
def test_an_element_has_room_for_so_many_attributes(tmp_path: Path, beginning: str) -> None:
    def header(number: int) -> str:
        many = " ".join(f'{beginning}{n}=""' for n in range(number))
        return f'<Header xmlns:x="urn:x" id="x" {many}/>'

    scl.read(write_scl(tmp_path / "few.scd", scl_text(header=header(MOST_ATTRIBUTES - 1))))
    with pytest.raises(SclError, match="expected at most 200 attributes of an element, found 201"):
        scl.read(write_scl(tmp_path / "many.scd", scl_text(header=header(MOST_ATTRIBUTES))))


def of_attributes(structs: int, members: int) -> str:
    """Structs, each with so many members of the next."""
    types = "".join(
        f'<DAType id="T{level}">'
        + "".join(f'<BDA name="m{n}" bType="Struct" type="T{level + 1}"/>' for n in range(members))
        + "</DAType>"
        for level in range(structs)
    )
    return types + f'<DAType id="T{structs}"><BDA name="f" bType="FLOAT32"/></DAType>'


def of_objects(levels: int) -> str:
    """Data objects, each within the one before."""
    types = "".join(
        f'<DOType id="T{level}" cdc="X"><SDO name="s" type="T{level + 1}"/></DOType>'
        for level in range(levels)
    )
    return types + f'<DOType id="T{levels}" cdc="X"><DA name="f" bType="FLOAT32" fc="MX"/></DOType>'


@pytest.mark.parametrize(
    ("templates", "message"),
    [
        (
            TEMPLATES.replace(
                '<BDA name="f" bType="FLOAT32"/>', '<BDA name="f" bType="Struct" type="AnalogueValue"/>'
            ),
            "themselves, found DOType MV > DAType AnalogueValue > DAType AnalogueValue",
        ),
        (
            TEMPLATES.replace('cdc="SPS">', 'cdc="SPS"><SDO name="s" type="SPS"/>'),
            "types that do not contain themselves, found DOType SPS > DOType SPS",
        ),
        (
            TEMPLATES.replace('type="AnalogueValue"', 'type="T0"') + of_attributes(12, 10),
            "at most 100000 attributes",
        ),
        (
            TEMPLATES.replace('type="AnalogueValue"', 'type="T0"') + of_attributes(400, 1),
            "nested at most 16 deep",
        ),
        (TEMPLATES.replace('type="SPS"', 'type="T0"') + of_objects(3000), "nested at most 16 deep"),
        (
            TEMPLATES.replace('name="mag"', 'name="mag" count="9999"').replace(
                '<BDA name="f" bType="FLOAT32"/>',
                "".join(f'<BDA name="f{n}" bType="FLOAT32"/>' for n in range(10)),
            ),
            "at most 100000 attributes",
        ),
        (
            TEMPLATES.replace(
                '<BDA name="f" bType="FLOAT32"/>',
                "".join(f'<BDA name="f{n}" bType="FLOAT32"/>' for n in range(2001)),
            ),
            "at most 2000 members",
        ),
        (
            TEMPLATES.replace('name="mag"', f'name="{"m" * 64}"').replace('name="f"', f'name="{"f" * 64}"'),
            "128 characters",
        ),
    ],
)
def test_types_without_end_are_left_out(tmp_path: Path, templates: str, message: str) -> None:
    document = scl.read(write_scl(tmp_path / "types.icd", scl_text(templates=templates)))
    (finding,) = (each for each in document.warnings if each.left_out)
    assert finding.element.startswith("<DO name=")
    assert message in finding.message
    assert document.ied("R1").logical_nodes("GGIO")[0].data_objects


def test_types_resolved_from_the_leaves_up_are_still_counted(tmp_path: Path) -> None:
    """A chain of types must be found too long also where each of its links has been resolved before."""
    users = "".join(f'<DO name="D{level}" type="T{level}"/>' for level in range(40, -1, -1))
    templates = f'{TEMPLATES}{of_objects(41)}<LNodeType id="Chain" lnClass="GGIO">{users}</LNodeType>'
    nodes = '<LN lnClass="GGIO" inst="1" lnType="Chain"/>'
    document = scl.read(write_scl(tmp_path / "chain.icd", scl_text(templates=templates, nodes=nodes)))
    assert any("16 levels" in str(warning) for warning in document.warnings)
    (node,) = document.ied("R1").logical_nodes("GGIO")
    assert [each.name for each in node.data_objects] == [f"D{level}" for level in range(40, 26, -1)]


def test_an_ied_has_room_for_so_many_attributes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Nodes beyond the limit have no data objects, those before it are read."""
    monkeypatch.setattr("scl.ied_section.MOST_ATTRIBUTES", 20)
    nodes = "".join(f'<LN lnClass="GGIO" inst="{n}" lnType="GGIO"/>' for n in range(1, 8))
    document = scl.read(write_scl(tmp_path / "many.icd", scl_text(nodes=nodes)))
    read = [bool(node.data_objects) for node in document.ied("R1").logical_nodes("GGIO")]
    assert read == sorted(read, reverse=True)
    assert {True, False} == set(read)
    assert any("at most 20 attributes in an IED" in str(warning) for warning in document.warnings)


@pytest.mark.parametrize("faults", [100, 3000])
def test_a_fault_that_comes_often_costs_little_and_is_told_so_often(tmp_path: Path, faults: int) -> None:
    odd = "".join(f'<LN lnClass="GGIO" inst="{n}" lnType="gone"/>' for n in range(faults))
    document = scl.read(write_scl(tmp_path / "odd.icd", scl_text(nodes=odd)))
    told = [warning for warning in document.warnings if warning.left_out]
    assert len(told) == min(faults, MOST_FINDINGS + 1)


def test_a_file_too_large_is_refused(tmp_path: Path) -> None:
    with pytest.raises(SclError, match="at most 100 bytes"):
        scl.read(write_scl(tmp_path / "large.scd", scl_text()), largest_bytes=100)
