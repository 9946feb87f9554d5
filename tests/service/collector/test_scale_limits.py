"""benchmarks/collector/scale.py judges what it measures; here, without the half hour."""

from collections.abc import Iterator

import pytest

from benchmarks.collector import scale
from benchmarks.collector.scale import JUDGED_MINUTES, LOOK_S, Seen, broken_limits, main

MINUTES = 30.0
PERIOD_MINUTES = 5.0


def seen(slope: float = 0.5, delay_s: float = 1.0, missed: int = 0) -> Seen:
    """A run that keeps to all limits unless told otherwise; its memory grows fast while it warms up."""
    found = Seen(looks=round(MINUTES * 60 / LOOK_S))
    found.missed = {("R1", str(number)): f"R1, poll {number}" for number in range(missed)}
    minutes = [look * LOOK_S / 60 for look in range(found.looks)]
    found.memory = [(minute, 1_000.0 + slope * minute - 100.0 * (minute < 3)) for minute in minutes]
    # p95 stands below the slowest twentieth.
    found.delays_s = {str(number): 9.0 if number < 4 else delay_s for number in range(100)}
    return found


def test_a_good_run_breaks_no_limit() -> None:
    assert broken_limits(seen(), MINUTES, PERIOD_MINUTES) == []


@pytest.mark.parametrize(
    ("run", "told"),
    [
        (seen(missed=2), "missed polls: expected none, found 2 in 360 looks"),
        (seen(slope=1.5), "memory: expected below 1 MB a minute, found +1.50"),
        (seen(delay_s=2.5), "made to stored: expected p95 at most 1 s, found 2.50 s"),
    ],
)
def test_each_limit_is_named_when_it_is_broken(run: Seen, told: str) -> None:
    assert broken_limits(run, MINUTES, PERIOD_MINUTES) == [told]


def test_a_run_that_saw_nothing_is_not_good() -> None:
    assert len(broken_limits(Seen(), MINUTES, PERIOD_MINUTES)) == 3


def test_a_run_without_triggers_or_too_short_for_a_slope_is_not_judged() -> None:
    bad = seen(slope=9.0, delay_s=9.0, missed=9)
    assert broken_limits(bad, MINUTES, 0.0) == []
    assert broken_limits(bad, JUDGED_MINUTES - 0.1, PERIOD_MINUTES) == []
    assert len(broken_limits(bad, JUDGED_MINUTES, PERIOD_MINUTES)) == 3


@pytest.mark.parametrize(("missed", "exit_code"), [(0, 0), (1, 1)])
def test_the_command_ends_with_what_it_found(
    missed: int, exit_code: int, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def measured(run: Seen, *_: float, **_options: bool) -> Iterator[str]:
        good = seen(missed=missed)
        run.looks, run.missed, run.memory, run.delays_s = good.looks, good.missed, good.memory, good.delays_s
        yield "measured"

    monkeypatch.setattr(scale, "measure", measured)
    monkeypatch.setattr("sys.argv", ["scale"])
    assert main() == exit_code
    assert ("limit broken: missed polls" in capsys.readouterr().out) is bool(missed)
