"""The page of the alarms has the table of the code."""

from tests.docs.alarm_transitions import PAGE, table


def test_the_page_has_the_transitions_of_the_code() -> None:
    assert table() in PAGE.read_text(encoding="utf-8"), "make docs"
