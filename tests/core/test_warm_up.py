"""What is compiled before the first record: all that its motor's condition needs."""

import pytest

from core.condition.following import direction
from core.warm_up import warm_up


def test_what_records_would_show_is_told_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """It is told only while nothing is called: else the first fold of an installation compiles it."""
    told: list[object] = []

    def recorded(*arguments: object) -> float:
        told.append(arguments)
        return 0.01

    monkeypatch.setattr(direction, "detectable", recorded)
    warm_up()
    assert told
