"""Recordings changed in one place: no crash, and no value other than an independent reader's."""

from collections import Counter
from pathlib import Path

import pytest

from benchmarks.corpus.mutations import Mutant, judged, mutants
from tests.core.recordings.comtrade_files import RECORD_1999

EVERY = 9
"""Of all mutants one in so many, in `make test`."""


def check(chosen: list[Mutant], folder: Path) -> None:
    outcomes = Counter[str]()
    for mutant in chosen:
        verdict = judged(mutant, folder)
        outcomes[verdict.outcome] += 1
        assert verdict.outcome not in ("wrong", "crashed"), f"{mutant.name}: {verdict.note}"
        assert mutant.sound is None or verdict.outcome != "refused", f"{mutant.name}: {verdict.note}"
    assert all(outcomes[one] > len(chosen) / 20 for one in ("read", "warned", "refused")), outcomes


@pytest.mark.parametrize("first", range(3))
def test_a_part_of_the_mutants(tmp_path: Path, first: int) -> None:
    check(list(mutants())[first::EVERY], tmp_path)


@pytest.mark.campaign
def test_all_mutants(tmp_path: Path) -> None:
    every = list(mutants())
    assert len(every) > 1500
    check(every, tmp_path)


def test_a_wrong_value_is_seen(tmp_path: Path) -> None:
    """The judge itself: another value, another time and a difference from the other reader."""
    sound = {".CFG": RECORD_1999.configuration().encode(), ".DAT": RECORD_1999.data()}
    other = {**sound, ".DAT": RECORD_1999.but(rows=((1, 1, 1, 1), *RECORD_1999.rows[1:])).data()}
    assert judged(Mutant("the same", sound, sound), tmp_path).outcome == "read"
    assert judged(Mutant("a value", other, sound), tmp_path).outcome == "wrong"
    later = {**sound, ".CFG": sound[".CFG"].replace(b"06:30", b"06:31")}
    assert judged(Mutant("a time", later, sound), tmp_path).outcome == "wrong"
    assert (
        judged(
            Mutant("a date", {**sound, ".CFG": sound[".CFG"].replace(b"21/11", b"never")}, sound), tmp_path
        ).outcome
        == "refused"
    )
