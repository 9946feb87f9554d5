"""Departures from the schema: warnings at their line, however often the shape has been right before."""

import re
from pathlib import Path

import pytest

import scl
from tests.scl.documents import TEMPLATES, scl_text, write_scl

SOUND = (
    '<LN lnClass="GGIO" inst="{}" lnType="GGIO"><DOI name="Ind1"><DAI name="d"><Val>x</Val></DAI></DOI></LN>'
)


def lines(count: int, odd: str) -> str:
    """Sound logical nodes, a line each, and among them an odd one."""
    nodes = [SOUND.format(number) for number in range(2, count)]
    nodes.insert(len(nodes) // 2, odd)
    return "\n".join(nodes)


@pytest.mark.parametrize(
    ("odd", "message"),
    [
        ('<LN lnClass="GGIO" inst="1" lnType="GGIO" colour="red"/>', "no attribute colour here"),
        ('<LN lnClass="GGIO" inst="1" lnType="GGIO"><Colour/></LN>', "no such element"),
        (
            '<LN lnClass="GGIO" inst="1" lnType="GGIO"><LDevice inst="X"/></LN>',
            "where the SCL schema has none",
        ),
        (
            '<LN lnClass="GGIO" inst="1" lnType="GGIO"><DOI name="Ind1"/><DataSet name="D"/></LN>',
            "stands after DOI, which it precedes",
        ),
        (
            '<LN lnClass="GGIO" inst="1" lnType="GGIO"><DOI name="Ind1"><DAI/></DOI></LN>',
            "no name, which the SCL schema requires",
        ),
    ],
)
def test_a_violation_among_sound_elements_is_told_with_its_line(
    tmp_path: Path, odd: str, message: str
) -> None:
    text = scl_text(nodes=lines(40, odd))
    (line,) = [number for number, each in enumerate(text.splitlines(), 1) if odd in each]
    found = scl.read(write_scl(tmp_path / "odd.scd", text)).warnings
    assert [warning.line for warning in found if message in str(warning)] == [line]
    assert len(scl.read(tmp_path / "odd.scd").ieds) == 1


def test_a_violation_repeated_is_told_each_time(tmp_path: Path) -> None:
    odd = '<LN lnClass="GGIO" inst="{}" lnType="GGIO" colour="red"/>'
    text = scl_text(nodes="\n".join(odd.format(number) for number in range(1, 6)))
    found = scl.read(write_scl(tmp_path / "odd.scd", text)).warnings
    told = [warning.line for warning in found if "no attribute colour" in str(warning)]
    assert told == sorted(set(told))
    assert len(told) == 5


@pytest.mark.parametrize(("kind", "member", "length"), [("DAType", "BDA", 10), ("DOType", "SDO", 10)])
def test_types_that_come_round_to_themselves_after_ten_are_left_out(
    tmp_path: Path, kind: str, member: str, length: int
) -> None:
    struct = 'bType="Struct" ' if kind == "DAType" else ""
    common = "" if kind == "DAType" else ' cdc="X"'
    ring = "\n".join(
        f'<{kind} id="T{k}"{common}><{member} name="m" {struct}type="T{(k + 1) % length}"/></{kind}>'
        for k in range(length)
    )
    entry = 'type="AnalogueValue"' if kind == "DAType" else 'name="AnIn1" type="MV"'
    into = 'type="T0"' if kind == "DAType" else 'name="AnIn1" type="T0"'
    text = scl_text(templates=TEMPLATES.replace(entry, into) + ring)
    last = next(number for number, line in enumerate(text.splitlines(), 1) if f'id="T{length - 1}"' in line)
    (warning,) = (each for each in scl.read(write_scl(tmp_path / "ring.icd", text)).warnings if each.left_out)
    assert warning.element.startswith("<DO name=")
    wanted = rf"themselves, found .*{kind} T0 > {kind} T1 > .*{kind} T8.* at line {last}, <{member} "
    assert re.search(wanted, warning.message)
