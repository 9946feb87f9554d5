"""Browsing the served model gives exactly what the file holds, down to attributes and control blocks."""

from pathlib import Path

import pytest

import scl
from mms import FunctionalConstraint
from scl.model_text import model_text
from testing.relays.browsing import contents_of_file, contents_of_server, served
from tests.scl.documents import write_scl
from tests.scl.vendor_shapes import EDITION_2, EDITION_2_1, SHAPES


@pytest.mark.parametrize("name", [*SHAPES, "sel710.icd"])
def test_the_server_offers_exactly_what_the_file_holds(tmp_path: Path, name: str) -> None:
    path = write_scl(tmp_path / name, SHAPES[name]) if name in SHAPES else scl.SEL710_ICD
    read = scl.read(path)
    assert read.warnings == ()
    (ied,) = read.ieds
    wanted = contents_of_file(path, ied.name)
    found = contents_of_server(model_text(read, ied.name))
    assert found.names == wanted.names
    assert found.data_sets == wanted.data_sets
    assert wanted.data_sets


def test_the_walk_covers_blocks_of_every_kind(tmp_path: Path) -> None:
    kinds = set()
    for name, text in SHAPES.items():
        path = write_scl(tmp_path / name, text)
        contents = contents_of_file(path, scl.read(path).ieds[0].name)
        kinds |= {each.split("$")[1] for names in contents.names.values() for each in names if "$" in each}
    assert kinds >= {"BR", "RP", "LG", "GO", "MS", "US", "SP", "SG", "SE", "MX", "ST", "CO", "BL", "OR"}


def test_editions_are_told_apart(tmp_path: Path) -> None:
    editions = [scl.read(write_scl(tmp_path / name, text)).header.edition for name, text in SHAPES.items()]
    assert editions == ["1", "2", "2.1"]


def test_elements_of_an_array_are_read_one_by_one(tmp_path: Path) -> None:
    read = scl.read(write_scl(tmp_path / "mu.iid", EDITION_2_1))
    with served(model_text(read, "MU")) as client:
        harmonics = client.read("Merging_1/MHAI1.HA.har", FunctionalConstraint.MX)
        assert isinstance(harmonics, tuple)
        assert len(harmonics) == 3
        assert client.read("Merging_1/MHAI1.HA.har(2).cVal.mag.f", FunctionalConstraint.MX) == 0.0
        points = client.read("Merging_1/MHAI1.Curve.crvPts", FunctionalConstraint.DC)
        assert points == ((0.0, (0.0,)),) * 4
        values = [member.value for member in client.read_data_set("Merging_1/LLN0.PhsMeas1")]
        assert values == [0.0, False]


def test_a_log_control_without_a_log_does_not_disturb_updates(tmp_path: Path) -> None:
    read = scl.read(write_scl(tmp_path / "relay.iid", EDITION_2))
    with served(model_text(read, "RELAY_2"), {"RELAY_2PRO/FLTRDRE1.RcdMade.stVal": True}) as client:
        assert client.read("RELAY_2PRO/FLTRDRE1.RcdMade.stVal", FunctionalConstraint.ST) is True


def test_node_types_of_one_id_are_told_apart_by_their_class(tmp_path: Path) -> None:
    read = scl.read(write_scl(tmp_path / "mu.iid", EDITION_2_1))
    swapped = EDITION_2_1.replace('<LNodeType id="RDRE" lnClass="RDRE">', '<LNodeType id="x" lnClass="X">')
    assert read.ied("MU").find("Q0/DEF_RDRE1.RcdMade.stVal") is not None
    assert scl.read(write_scl(tmp_path / "x.iid", swapped)).ied("MU").find("Q0/DEF_RDRE1.Ind") is not None
