"""Clients and servers of other MMS stacks, and that the page tells what they see as it is."""

import re
from pathlib import Path

import pytest

from benchmarks.interoperability import stack_clients, stack_servers
from benchmarks.interoperability.peers import Result
from ied_sim.profiles.profile import shipped

PAGE = Path(__file__).parents[2] / "docs" / "evidence" / "interoperability.md"


def rows(title: str) -> dict[str, list[str]]:
    """The table below a heading of the page: its cells by the profile in the first one."""
    _, found, rest = PAGE.read_text(encoding="utf-8").partition(f"\n### {title}\n")
    assert found, title
    lines = re.findall(r"^\| `([^`]+)` \|(.+)\|$", rest.partition("\n### ")[0].partition("\n## ")[0], re.M)
    return {name: [cell.strip() for cell in cells.split("|")] for name, cells in lines}


def told(results: list[Result]) -> list[str]:
    return [result.seen for result in results]


@pytest.mark.parametrize("profile", shipped())
def test_clients_of_other_stacks_use_every_relay(profile: str, tmp_path: Path) -> None:
    results = list(stack_clients.of_profile(profile, tmp_path))
    assert not [result for result in results if not result.passed]
    assert rows("Their clients, our relays")[profile] == told(results)


@pytest.mark.parametrize("profile", shipped())
def test_our_client_uses_servers_of_other_stacks(profile: str, tmp_path: Path) -> None:
    results = list(stack_servers.of_profile(profile, tmp_path))
    assert not [result for result in results if not result.passed]
    assert rows("Our client, their servers")[profile] == told(results)
