"""A schedule is said in words."""

import pytest

from service.plant.schedule import Schedule


@pytest.mark.parametrize(
    ("expression", "words"),
    [
        ("* * * * *", "every minute"),
        ("0 6 * * *", "at 06:00 every day (UTC)"),
        ("30 6 * * MON", "at 06:30 on Monday (UTC)"),
    ],
)
def test_a_schedule_in_words(expression: str, words: str) -> None:
    assert Schedule.parse(expression).in_words() == words
