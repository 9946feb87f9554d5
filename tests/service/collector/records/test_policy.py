"""What the policy's limits mean, and that docs/reference/record-life.md shows the policy as it is."""

import re
from dataclasses import fields
from pathlib import Path

import pytest

from mms import (
    AccessDenied,
    ConnectionLost,
    ProtocolError,
    RequestRejected,
    ServiceFailed,
    Timeout,
    ValueRefused,
)
from service.collector.records.life import Life
from service.collector.records.policy import (
    DEFAULT_RULES,
    PULL_FAILURES,
    RECORD_POLICY,
    Attempts,
    Failure,
    failure_of,
)

PAGE = Path(__file__).parents[4] / "docs" / "reference" / "record-life.md"


def rows_of(section: str) -> list[list[str]]:
    """The cells of a section's table, without its head."""
    text = PAGE.read_text(encoding="utf-8").partition(f"\n## {section}\n")[2].partition("\n## ")[0]
    lines = re.findall(r"^\| (.+) \|$", text, re.MULTILINE)
    return [line.split(" | ") for line in lines[1:]]


def words(attempts: Attempts) -> str:
    numbers = {
        "of this kind": attempts.of_kind,
        "since the start": attempts.since_start,
        "in all": attempts.in_all,
    }
    return " and ".join(f"{number} {what}" for what, number in numbers.items() if number)


def any_of(limits: tuple[Attempts, ...]) -> str:
    return ", or ".join(map(words, limits)) or "never"


def test_the_page_shows_every_failure_with_its_rule() -> None:
    policy = RECORD_POLICY
    expected = [
        [
            str(failure),
            "-" if rule.pause is None else f"{rule.pause.first_s:g} s",
            "-" if rule.pause is None else f"{rule.pause.longest_s:g} s",
            any_of(rule.alarm_after),
            any_of(rule.refuse_after),
        ]
        for failure, rule in policy.rules.items()
    ]
    tomorrow = "to the next day of UTC"
    a_day = f"{policy.wrong_listings_a_day} of one name in a day"
    expected += [
        ["listing wrong again and again", tomorrow, tomorrow, a_day, "never"],
        ["unsteady", "-", "-", f"{policy.unsteady_s:g} s", "never"],
        ["incomplete", "-", "-", "never", "setting `record_timeout_s`"],
    ]
    assert rows_of("Failures") == expected


def test_the_page_shows_every_other_figure() -> None:
    figures = {
        field.name: getattr(RECORD_POLICY, field.name)
        for field in fields(RECORD_POLICY)
        if field.name != "rules"
    }
    shown = {name.strip("`"): value for name, value, _meaning in rows_of("Waiting")}
    assert shown == {
        name: f"{figure:g} s" if name.endswith("_s") else str(figure) for name, figure in figures.items()
    }


def test_the_page_shows_every_state() -> None:
    assert [row[0].strip("`") for row in rows_of("States")] == [str(life) for life in Life]


def test_every_failure_has_a_rule_and_an_error() -> None:
    assert DEFAULT_RULES.keys() == set(Failure)
    assert {failure_of(kind.__new__(kind)) for kind in PULL_FAILURES} == set(Failure)


@pytest.mark.parametrize(
    ("kind", "failure"),
    [
        (AccessDenied, Failure.DENIED),
        (ServiceFailed, Failure.DENIED),
        (ConnectionLost, Failure.LINK_LOST),
        (Timeout, Failure.LINK_LOST),
        (ProtocolError, Failure.PROTOCOL_BROKEN),
        (RequestRejected, Failure.PROTOCOL_BROKEN),
        (ValueRefused, Failure.DENIED),
    ],
)
def test_an_error_is_of_the_most_special_kind(kind: type[Exception], failure: Failure) -> None:
    assert failure_of(kind("relay", "download", 0, "no")) is failure


def test_a_limit_is_reached_when_each_of_its_numbers_is() -> None:
    limit = Attempts(since_start=2, in_all=9)
    assert Attempts(of_kind=1, since_start=2, in_all=9).reach((limit,))
    assert not Attempts(of_kind=1, since_start=1, in_all=20).reach((limit,)), "denied before a restart"
    assert not Attempts(of_kind=8, since_start=8, in_all=8).reach((limit,))
    assert Attempts(of_kind=8).reach((limit, Attempts(of_kind=8)))
    assert not Attempts(of_kind=8, since_start=8, in_all=8).reach(())
