"""Files that tools saved or cut in other forms are read, with a warning; no address is lost silently."""

import codecs
from pathlib import Path

import pytest

import scl
from scl import Address
from tests.scl.documents import COMMUNICATION, messages, read, scl_text

ADDRESS = '<P type="IP">10.0.0.7</P>'


@pytest.mark.parametrize("blanks", ["\n", "\r\n\r\n", "  ", "\t\n"])
@pytest.mark.parametrize("mark", [b"", codecs.BOM_UTF8])
def test_blanks_before_the_declaration(tmp_path: Path, blanks: str, mark: bytes) -> None:
    path = tmp_path / "relay.cid"
    text = scl_text(header="")
    path.write_bytes(mark + (blanks + text).encode())
    found = scl.read(path)
    assert found.address("R1") == Address("10.0.0.7", 102)
    assert "blanks before the XML declaration are passed over" in messages(found)
    sound = read(tmp_path, header="")
    lines = {one.line for one in found.warnings if "no Header" in one.message}
    moved = blanks.count("\n")
    assert lines == {one.line + moved for one in sound.warnings if "no Header" in one.message}


@pytest.mark.parametrize("declared", ['encoding="UTF-8"', "encoding='UTF-16'", ""])
@pytest.mark.parametrize(
    ("mark", "encoding"),
    [
        (codecs.BOM_UTF16_LE, "utf-16-le"),
        (codecs.BOM_UTF16_BE, "utf-16-be"),
        (b"", "utf-16-le"),
        (b"", "utf-16-be"),
    ],
)
def test_utf_16_whatever_the_declaration_says(
    tmp_path: Path, mark: bytes, encoding: str, declared: str
) -> None:
    path = tmp_path / "relay.cid"
    text = scl_text(header='<Header id="Máquina 1"/>').replace('encoding="UTF-8"', declared)
    path.write_bytes(mark + text.encode(encoding))
    found = scl.read(path)
    assert found.header.id == "Máquina 1"
    assert found.address("R1") == Address("10.0.0.7", 102)
    assert "the text is UTF-16: read as such" in messages(found)


def test_utf_16_that_was_cut_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "relay.cid"
    path.write_bytes(codecs.BOM_UTF16_LE + scl_text().encode("utf-16-le")[:-1])
    with pytest.raises(scl.SclError, match="expected a text in UTF-16"):
        scl.read(path)


@pytest.mark.parametrize(
    ("host", "port"), [("ip", "MMS-PORT"), ("Ip", "mms-port"), ("IP", "MMSPort"), (" IP", "MMS_Port")]
)
def test_types_of_an_address_in_other_capitals(tmp_path: Path, host: str, port: str) -> None:
    written = f'<P type="{host}">10.0.0.9</P><P type="{port}">1102</P>'
    found = read(tmp_path, communication=COMMUNICATION.replace(ADDRESS, written))
    assert found.address("R1") == Address("10.0.0.9", 1102)
    assert "no type of the standard: read as MMS-Port" in messages(found)
    moved = tmp_path / "moved.cid"
    scl.instantiate(tmp_path / "relay.cid", moved, "R1", Address("10.0.0.8", 1103))
    assert scl.read(moved).address("R1") == Address("10.0.0.8", 1103)


@pytest.mark.parametrize(
    ("written", "said"),
    [
        ('<P type="IP">10.0.0.7.1</P>', "its address is not understood: '10.0.0.7.1'"),
        ('<P type="IP"></P>', "its address is not understood"),
        ('<P type="Host">10.0.0.7</P>', "no type of the standard: passed over"),
        ('<P type="IP-SUBNET">255.255.255.0</P>', "its address names no host"),
    ],
)
def test_an_address_that_is_not_understood_is_not_lost_silently(
    tmp_path: Path, written: str, said: str
) -> None:
    found = read(tmp_path, communication=COMMUNICATION.replace(ADDRESS, written))
    assert said in messages(found)
    with pytest.raises(scl.SclError):
        found.address("R1")
