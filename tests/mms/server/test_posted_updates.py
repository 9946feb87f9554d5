"""Updates that other threads post to a server."""

import logging
import queue

import pytest

from mms import Client, ControlAction, FunctionalConstraint, ModelError, Report, Server
from testing.ports import LOOPBACK, free_port
from testing.relays.model import MODEL_TEXT
from testing.waiting import wait_until

ST = FunctionalConstraint.ST
IND01 = "T1PRO/GGIO1.Ind01.stVal"
NUMBER = "T1PRO/GGIO1.Types.int32"
CONTROL = "T1CON/RBGGIO1.SPCSO01"


def test_a_client_soon_reads_what_was_posted(relay: Server, client: Client) -> None:
    for number in range(50):
        relay.post({NUMBER: number, IND01: number % 2 == 0})
    wait_until(lambda: client.read(NUMBER, ST) == 49, "the posted value", 5)
    assert client.read(IND01, ST) is False


def test_updates_are_made_in_the_order_they_were_posted(relay: Server, client: Client) -> None:
    reports: queue.SimpleQueue[Report] = queue.SimpleQueue()
    client.subscribe("T1PRO/LLN0.BR.BRep01", reports)
    for number in range(6):
        relay.post({IND01: number % 2 == 0})
    states: list[object] = []
    while len(states) < 6:
        (value,) = (member.value for member in reports.get(timeout=20).members)
        assert isinstance(value, tuple)
        states.append(value[0])
    assert states == [True, False] * 3


def test_what_a_handler_posts_is_there_when_the_control_is_answered(relay: Server, client: Client) -> None:
    seen = []

    def operated(action: ControlAction) -> bool:
        relay.post({f"{CONTROL}.stVal": action.value})
        seen.append(relay.read(f"{CONTROL}.stVal"))
        return True

    relay.on_operate(CONTROL, operated)
    client.operate(CONTROL, value=True)
    assert seen == [True]
    assert client.read(f"{CONTROL}.stVal", ST) is True


def test_what_does_not_fit_is_logged_and_holds_nothing_up(
    relay: Server, client: Client, caplog: pytest.LogCaptureFixture
) -> None:
    relay.post({NUMBER: "text"})
    relay.post({NUMBER: 7})
    with caplog.at_level(logging.ERROR):
        wait_until(lambda: client.read(NUMBER, ST) == 7, "what was posted next", 5)
    assert [record.getMessage() for record in caplog.records] == ["a posted change does not fit the model"]


def test_what_was_posted_before_the_start_is_checked_on_request() -> None:
    server = Server(MODEL_TEXT, port=free_port())
    server.post({NUMBER: 8})
    server.post({NUMBER: "text"})
    with pytest.raises(ModelError):
        server.apply_posted()
    with server, Client.connect(LOOPBACK, server.port) as client:
        assert client.read(NUMBER, ST) == 8
