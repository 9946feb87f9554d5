"""The SCL half of a corpus run: reasons, counts beside those of lxml, and relays served over MMS."""

import json
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from benchmarks.corpus.__main__ import main
from benchmarks.corpus.outcomes import Agreement, Reading, Service
from benchmarks.corpus.scl_counts import compared
from benchmarks.corpus.scl_files import compare_file, read_file
from benchmarks.corpus.scl_serving import serve_relays
from scl import read
from tests.scl.documents import NODE_ZERO, NODES, TEMPLATES, scl_text, write_scl
from tests.scl.vendor_shapes import SHAPES

ODD = TEMPLATES.replace('type="MV"', 'type="gone"')
SERVER = '<Server><Authentication/><LDevice inst="LD0"/></Server>'
EMPTY = f'<IED name="R2"><AccessPoint name="S1">{SERVER}</AccessPoint></IED>'


@pytest.mark.parametrize("shape", SHAPES)
def test_files_of_every_edition_are_served_whole(tmp_path: Path, shape: str) -> None:
    path = write_scl(tmp_path / shape, SHAPES[shape])
    assert compare_file(path).agreement is Agreement.AGREES
    (served,) = serve_relays(path)
    assert served.service is Service.WHOLE


def test_what_is_left_out_is_told_once_and_explains_the_counts(tmp_path: Path) -> None:
    twice = '<LN lnClass="GGIO" inst="1" lnType="GGIO"/>'
    path = write_scl(tmp_path / "odd.cid", scl_text(nodes=NODES + twice * 2, templates=ODD))
    outcome = read_file(path)
    assert outcome.reading is Reading.WARNED
    assert outcome.notes[0].startswith("line ")
    assert sum("a second logical node" in note for note in outcome.notes) == 1
    assert any("(and 1 more like it)" in note for note in outcome.notes)
    comparison = compare_file(path)
    assert comparison.agreement is Agreement.EXPLAINED
    assert comparison.notes == ("LN: 2 read, 4 in the file: warnings name what is left out",)


def test_a_reader_that_loses_a_node_without_a_word_differs(tmp_path: Path) -> None:
    path = write_scl(tmp_path / "relay.cid", scl_text())
    document = read(path)
    (ied,) = document.ieds
    (point,) = ied.access_points
    (device,) = point.logical_devices
    lost = replace(point, logical_devices=(replace(device, logical_nodes=device.logical_nodes[:1]),))
    comparison = compared(replace(document, ieds=(replace(ied, access_points=(lost,)),)), path)
    assert comparison.agreement is Agreement.DIFFERS
    assert comparison.notes == ("LN: 1 read, 2 in the file: warnings leave 2",)


def test_relays_in_part_and_not_at_all_have_a_reason(tmp_path: Path) -> None:
    member = '<DataSet name="D"><FCDA lnClass="GGIO" lnInst="9" doName="Ind1" fc="ST"/></DataSet>'
    text = scl_text(node_zero=NODE_ZERO.replace("/>", f">{member}</LN0>")).replace("</IED>", f"</IED>{EMPTY}")
    in_part, not_served = serve_relays(write_scl(tmp_path / "plant.scd", text))
    assert (in_part.relay, in_part.service) == ("R1", Service.IN_PART)
    assert in_part.notes == ("R1LD0/LLN0.D without 1 members: R1LD0/GGIO9.Ind1[ST]",)
    assert (not_served.relay, not_served.service) == ("R2", Service.NOT_SERVED)
    assert "a logical node with data objects" in not_served.notes[0]


@pytest.mark.campaign
def test_scl_files_have_their_rows_in_a_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    write_scl(tmp_path / "sound.CID", scl_text())
    write_scl(tmp_path / "odd.scd", scl_text(templates=ODD))
    write_scl(tmp_path / "broken.icd", scl_text()[:500])
    monkeypatch.setattr(sys, "argv", ["corpus", str(tmp_path), "--json"])
    assert main() == 0
    found = json.loads(capsys.readouterr().out)
    files = {one["file"]: one for one in found["files"]}
    assert {name: one["reading"] for name, one in files.items()} == {
        "broken.icd": "refused",
        "odd.scd": "read with warnings",
        "sound.CID": "read",
    }
    assert files["sound.CID"]["served"] == [{"relay": "R1", "service": "served whole", "notes": []}]
    monkeypatch.setattr(sys, "argv", ["corpus", str(tmp_path)])
    assert main() == 0
    shown = capsys.readouterr().out
    assert "| SCL | 3 | 1 | 1 | 0 | 1 | 0 |" in shown
    assert "| 2 | 2 | 0 | 0 | 0 | 0 |" in shown
