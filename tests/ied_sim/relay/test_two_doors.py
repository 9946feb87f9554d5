"""Clients at both servers of one relay: its own, and the overflow server beside it."""

import threading
from pathlib import Path

import pytest

from mms import Client, FunctionalConstraint
from testing.relays.simulated import IED, Simulated, scenario_of, simulated
from testing.waiting import wait_until

BITS = (f"{IED}CON/RBGGIO1.SPCSO11", f"{IED}CON/RBGGIO1.SPCSO12")
PATIENCE_S = 10.0


@pytest.mark.parametrize("times", [200, pytest.param(10_000, marks=pytest.mark.campaign)])
def test_operating_at_both_servers_at_once_never_stops(tmp_path: Path, times: int) -> None:
    with simulated(tmp_path, scenario_of("sel-710-ed2")) as served:
        clients = both_doors(served)
        operated = [_Operating(client, times, first=bool(door)) for door, client in enumerate(clients)]
        for each in operated:
            each.start()
        while any(each.is_alive() for each in operated):
            _wait_for_progress(operated)
        assert [each.count for each in operated] == [times, times]
        wait_until(lambda: _states(clients[0]) == _states(clients[1]), "one state at both servers")
        for client in clients:
            client.close()


class _Operating(threading.Thread):
    """Operates two controls in turn, so that each keeps rising and falling."""

    def __init__(self, client: Client, times: int, *, first: bool) -> None:
        super().__init__(daemon=True)
        self._client, self._times, self._first = client, times, first
        self.count = 0

    def run(self) -> None:
        while self.count < self._times:
            self._client.operate(BITS[self.count % 2], value=(self.count // 2) % 2 == self._first)
            self.count += 1


def _wait_for_progress(operated: list[_Operating]) -> None:
    """Wait until each has operated once more, or has ended."""
    before = [each.count for each in operated]

    def goes_on() -> bool:
        return all(
            each.count > count or not each.is_alive() for each, count in zip(operated, before, strict=True)
        )

    wait_until(goes_on, f"more controls at the two servers than {before}", PATIENCE_S)


def both_doors(served: Simulated) -> tuple[Client, Client]:
    """A client of the relay's server and one of its overflow server."""
    overflow_server = served.relay._relay_server.open_overflow_server()
    assert overflow_server is not None
    own = served.relay.server
    return Client.connect(own.address, own.port), Client.connect(overflow_server.host, overflow_server.port)


def _states(client: Client) -> list[object]:
    return [client.read(f"{bit}.stVal", FunctionalConstraint.ST) for bit in BITS]
