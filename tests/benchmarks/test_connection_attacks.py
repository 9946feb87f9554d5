"""1,300 connections that keep a real service waiting exhaust nothing (the attacks of the benchmark)."""

import pytest

from benchmarks.attacks.connections import ATTACKS, Attack, measure

pytestmark = [pytest.mark.campaign, pytest.mark.timeout(300)]


@pytest.mark.parametrize("attack", ATTACKS[:4], ids=lambda attack: attack.name)
def test_others_are_answered_meanwhile(attack: Attack) -> None:
    figures = measure(attack, connections=1300, seconds=5.0)
    assert figures.failed("/healthz") == 0
    assert figures.failed("/api/v1/motors") == 0
    assert figures.descriptors < 700
    assert figures.log_lines < 10
    assert figures.left_over < 20
