"""Clients and servers of other MMS stacks, and that the page tells what they see as it is."""

import csv
from pathlib import Path

import pytest

from benchmarks.interoperability import stack_clients, stack_servers
from benchmarks.interoperability.peers import Result
from ied_sim.profiles.profile import shipped

TABLES = Path(__file__).parents[2] / "docs" / "evidence" / "data"


def rows(name: str) -> dict[str, list[str]]:
    """A table beside the page: its cells by the profile in the first one."""
    with (TABLES / f"interoperability-{name}.csv").open(encoding="utf-8", newline="") as file:
        _, *lines = csv.reader(file)
    return {line[0]: line[1:] for line in lines}


def told(results: list[Result]) -> list[str]:
    return [result.seen for result in results]


@pytest.mark.parametrize("profile", shipped())
def test_clients_of_other_stacks_use_every_relay(profile: str, tmp_path: Path) -> None:
    results = list(stack_clients.of_profile(profile, tmp_path))
    assert not [result for result in results if not result.passed]
    assert rows("their-clients-our-relays")[profile] == told(results)


@pytest.mark.parametrize("profile", shipped())
def test_our_client_uses_servers_of_other_stacks(profile: str, tmp_path: Path) -> None:
    results = list(stack_servers.of_profile(profile, tmp_path))
    assert not [result for result in results if not result.passed]
    assert rows("our-client-their-servers")[profile] == told(results)
