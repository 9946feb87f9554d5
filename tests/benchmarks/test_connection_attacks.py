"""1,300 connections that keep a real service waiting exhaust nothing (the attacks of the benchmark)."""

import pytest

from benchmarks.attacks.connections import ATTACKS, Attack, measure

pytestmark = [pytest.mark.campaign, pytest.mark.timeout(300)]


@pytest.mark.parametrize("attack", ATTACKS[:4], ids=lambda attack: attack.name)
def test_others_are_answered_meanwhile(attack: Attack) -> None:
    """All but one of about a hundred: a busy machine may hold one up for longer than it waits."""
    figures = measure(attack, connections=1300, seconds=5.0)
    assert len(figures.failures) <= 1, figures
    assert figures.descriptors < 1800, figures  # those that wait to be served have one each
    assert len(figures.log.splitlines()) < 10, figures
    assert figures.left_over < 20, figures
