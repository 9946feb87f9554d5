"""1,300 connections that keep a real service waiting exhaust nothing (the attacks of the benchmark)."""

import pytest

from benchmarks.attacks.connections import ATTACKS, Attack, measure

pytestmark = [pytest.mark.campaign, pytest.mark.timeout(300)]


@pytest.mark.parametrize("attack", ATTACKS[:4], ids=lambda attack: attack.name)
def test_others_are_answered_meanwhile(attack: Attack) -> None:
    """All but one of about a hundred.

    New connections of the attack displace all others within 0.3 s. A client that a busy machine holds up for
    longer, between its connection and its request, cannot be told from them.
    """
    figures = measure(attack, connections=1300, seconds=5.0)
    assert len(figures.failures) <= 1, figures.failures
    assert figures.descriptors < 700
    assert len(figures.log.splitlines()) < 10, figures.log.decode()
    assert figures.left_over < 20
