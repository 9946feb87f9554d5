"""What `mcc rediagnose --batch` refuses before it begins. What it does: tests/service/application."""

import pytest

from service.cli.app import main
from service.cli.recordings import batch


def refused(capsys: pytest.CaptureFixture[str], *words: str) -> tuple[int, str]:
    """The exit code, and what is said on stderr in one line."""
    code = main(["rediagnose", *words])
    return code, " ".join(capsys.readouterr().err.replace("│", " ").split())


def test_without_dask_it_says_what_to_install(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(batch, "find_spec", lambda _name: None)
    assert refused(capsys, "--batch") == (
        1,
        'mcc: rediagnose: expected the library distributed, found none: pip install "statorwatch[dask]"',
    )


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ((), "expected the ids of recordings, or --batch for all of them"),
        (("--batch", "0b6f0a55"), "--batch: expected neither recordings nor --csv"),
        (("0b6f0a55", "--motor", "PUMP-A1"), "are for --batch"),
    ],
)
def test_words_that_do_not_go_together(
    capsys: pytest.CaptureFixture[str], words: tuple[str, ...], said: str
) -> None:
    code, complained = refused(capsys, *words)
    assert code == 2
    assert said in complained


@pytest.mark.parametrize(
    ("time", "said"),
    [("2200-01-01", "expected a time that has passed"), ("yesterday", "expected an RFC 3339 time")],
)
def test_a_time_that_is_of_no_use(capsys: pytest.CaptureFixture[str], time: str, said: str) -> None:
    code, complained = refused(capsys, "--batch", "--made-before", time)
    assert code == 1
    assert complained.startswith(f"mcc: --made-before: {said}")
