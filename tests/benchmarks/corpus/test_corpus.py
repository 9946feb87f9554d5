"""A corpus run tells of every file how it was read, and no file ends it."""

import json
import os
import sys
from pathlib import Path

import pytest

from benchmarks.corpus import kinds, made_files, workers
from benchmarks.corpus.__main__ import main
from benchmarks.corpus.kinds import files_of
from benchmarks.corpus.outcomes import Agreement, Comparison, Examined, Outcome, Reading
from tests.benchmarks.corpus.hostile_readers import HOSTILE
from tests.core.recordings.comtrade_files import RECORD_1999


def run(folder: Path, monkeypatch: pytest.MonkeyPatch, *options: str) -> int:
    monkeypatch.setattr(sys, "argv", ["corpus", str(folder), *options])
    return main()


def test_every_file_gets_its_row(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "deep").mkdir()
    RECORD_1999.write(tmp_path, name="sound.CFG", data_name="sound.DAT")
    RECORD_1999.write(tmp_path / "deep", name="lonely.cfg", data_name="other.dat")
    cut = RECORD_1999.write(tmp_path, name="cut.cfg", data_name="cut.dat")
    cut.with_suffix(".dat").write_bytes(RECORD_1999.data()[:40])
    (tmp_path / "notes.txt").write_text("no recording")
    (tmp_path / "broken.cev").write_bytes(b"\x00\xff| no report")
    os.mkfifo(tmp_path / "pipe.cfg")
    assert run(tmp_path, monkeypatch, "--json") == 0
    found = json.loads(capsys.readouterr().out)
    files = {one["file"]: one for one in found["files"]}
    assert {name: one["reading"] for name, one in files.items()} == {
        "sound.CFG": "read",
        "cut.cfg": "read only leniently",
        "deep/lonely.cfg": "refused",
        "broken.cev": "refused",
    }
    assert "data file" in files["deep/lonely.cfg"]["notes"][0]
    assert files["sound.CFG"]["agreement"] == "differs as documented"
    assert files["sound.CFG"]["differences"] == ["values in primary SI units"]
    assert (found["parts"], found["others"]) == (2, 1)
    assert [Path(name).name for name in found["orphans"]] == ["other.dat"]
    assert run(tmp_path, monkeypatch) == 0
    shown = capsys.readouterr().out
    assert "| COMTRADE | 3 | 1 | 0 | 1 | 1 | 0 |" in shown


def examined(
    folder: Path, names: list[str], monkeypatch: pytest.MonkeyPatch, *, timeout_s: float = 60.0
) -> list[Examined]:
    monkeypatch.setattr(kinds, "KINDS", (HOSTILE,))
    for name in names:
        (folder / f"{name}.bad").touch()
    files = list(workers.examine_all(files_of(folder).files, folder, timeout_s=timeout_s))
    assert [one.path for one in files] == [f"{name}.bad" for name in names]
    return files


def test_a_hostile_file_does_not_end_the_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    dies, eats, fails, fine, sound = examined(
        tmp_path, ["dies", "eats", "fails", "fine", "sound"], monkeypatch
    )
    assert {one.outcome.reading for one in (dies, eats, fails)} == {Reading.CRASHED}
    assert dies.outcome.notes == ("the process died (exit code 11)",)
    assert "memory" in eats.outcome.notes[0].lower()
    assert fails.outcome.notes == ("ZeroDivisionError: of the reader",)
    assert fine.comparison.agreement is Agreement.AGREES
    assert sound.outcome.reading is Reading.READ
    assert sound.comparison == Comparison(Agreement.PEER_FAILS, ("the process died (exit code 12)",))


@pytest.mark.campaign
def test_a_file_without_end_does_not_hold_up_the_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    before, hangs, then = examined(tmp_path, ["fine", "hangs", "then"], monkeypatch, timeout_s=10.0)
    assert hangs.outcome == Outcome(Reading.CRASHED, ("took longer than 10 s",))
    assert before.outcome.reading is then.outcome.reading is Reading.READ


def test_no_folder_is_wrong_use(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(tmp_path / "none", monkeypatch) == 2
    assert "expected a folder" in capsys.readouterr().err


def test_made_files_are_read_as_their_names_say(tmp_path: Path) -> None:
    """One file of each kind that the pages tell of; the peer agrees wherever it reads one."""
    made_files.write(tmp_path)
    found = files_of(tmp_path)
    examined = {one.path: one for one in workers.examine_all(found.files, tmp_path)}
    readings = {name: one.outcome.reading for name, one in examined.items()}
    folder = "beside the standard"
    assert {r for name, r in readings.items() if name.startswith("sound/")} == {Reading.READ}
    assert Reading.REFUSED not in {r for name, r in readings.items() if name.startswith(folder)}
    warned = {name.split("/")[1] for name, r in readings.items() if r is Reading.WARNED}
    assert warned == {
        f"{name}.CFG"
        for name in (
            "constant spare channel", "constant spare channel without a ratio", "constant channel of 24",
            "revision 2000", "revision 1998", "blank lines", *made_files.STAMPS,
            "date with spaces", "date and time in one field", "year first", "month first",
            "year of two digits", "2013 with +5h", "comma in the station's name",
            "comma in a channel's name", "comma in quotes", "commas at the ends of lines",
            "counts of samples for each rate", "line end behind binary data",
            "ASCII lines that end in a comma", "UTF-16", "UTF-16 of the configuration alone",
            "a step back and a gap",
        )
    } | {
        f"{name}.CEV"
        for name in ("event report in UTF-16", "two event reports", "words behind an event report")
    }  # fmt: skip
    agreements = {one.comparison.agreement for one in examined.values()}
    assert Agreement.DIFFERS not in agreements
    assert Reading.CRASHED not in readings.values()
    assert [path.name for path in found.orphans] == ["no configuration.DAT"]
