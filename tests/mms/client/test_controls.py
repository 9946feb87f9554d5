"""Operating objects of every control model, and being refused."""

import logging
import threading
from collections.abc import Callable

import pytest

from mms import (
    AddCause,
    Client,
    ClientLimits,
    ConnectionLost,
    ControlAction,
    ControlRefused,
    FunctionalConstraint,
    ModelError,
    NotFound,
    ProtocolError,
    Server,
    Timeout,
)
from mms.client import controls
from mms.control_model import words_of
from testing.ports import LOOPBACK

OBJECT = "T1CON/RBGGIO1.SPCSO0{}"
MODELS = {"direct": 1, "select before operate": 2, "direct enhanced": 3, "select before operate enhanced": 4}


@pytest.fixture(params=list(MODELS.values()), ids=list(MODELS))
def controllable(request: pytest.FixtureRequest) -> str:
    return OBJECT.format(int(request.param))


def _obey(relay: Server, seen: list[ControlAction]) -> Callable[[ControlAction], bool]:
    def obey(action: ControlAction) -> bool:
        seen.append(action)
        relay.update(f"{action.reference}.stVal", action.value)
        return True

    return obey


def test_an_object_is_operated_by_its_control_model(relay: Server, client: Client, controllable: str) -> None:
    seen: list[ControlAction] = []
    relay.on_operate(controllable, _obey(relay, seen))
    client.operate(controllable, value=True, originator="bay 7")
    assert client.read(f"{controllable}.stVal", FunctionalConstraint.ST) is True
    client.operate(controllable, value=False)
    assert client.read(f"{controllable}.stVal", FunctionalConstraint.ST) is False
    assert [action.value for action in seen] == [True, False]
    first = seen[0]
    assert (first.reference, first.originator, first.originator_category) == (controllable, "bay 7", 3)
    assert not first.test


def test_control_numbers_count_up(relay: Server, client: Client, controllable: str) -> None:
    """Relays that look for repeated commands take the same number twice for one command."""
    seen: list[ControlAction] = []
    relay.on_operate(controllable, _obey(relay, seen))
    for number in range(258):
        client.operate(controllable, value=number % 2 == 0)
    first = seen[0].control_number
    assert [action.control_number for action in seen] == [(first + k) % 256 for k in range(258)]


@pytest.mark.parametrize(
    ("verdict", "cause"),
    [(False, "blocked by process"), (AddCause.BLOCKED_BY_INTERLOCKING, "blocked by interlocking")],
)
def test_a_refusal_carries_its_cause_in_words(
    relay: Server, client: Client, controllable: str, verdict: bool | AddCause, cause: str
) -> None:
    relay.on_operate(controllable, lambda _action: verdict)
    with pytest.raises(ControlRefused, match=cause) as refused:
        client.operate(controllable, value=True)
    assert refused.value.add_cause == cause
    assert controllable in str(refused.value)


def test_a_handler_that_raises_refuses_and_is_logged(
    relay: Server, client: Client, controllable: str, caplog: pytest.LogCaptureFixture
) -> None:
    def fail(_action: ControlAction) -> bool:
        raise ZeroDivisionError("relay logic")

    relay.on_operate(controllable, fail)
    with caplog.at_level(logging.ERROR, logger="mms"), pytest.raises(ControlRefused):
        client.operate(controllable, value=True)
    assert "relay logic" in caplog.text
    relay.on_operate(controllable, lambda _action: True)
    client.operate(controllable, value=True)


def test_a_status_only_object_is_refused(client: Client) -> None:
    with pytest.raises(ControlRefused, match="status-only"):
        client.operate(OBJECT.format(0), value=True)


def test_what_is_no_control_is_told_apart(client: Client) -> None:
    with pytest.raises(NotFound):
        client.operate("T1CON/RBGGIO1.SPCSO99", value=True)
    with pytest.raises((NotFound, ProtocolError)):
        client.operate("T1PRO/GGIO1.Ind01", value=True)
    with pytest.raises(ValueError, match="expected 2 names"):
        client.operate("T1CON/RBGGIO1", value=True)
    with pytest.raises(ValueError, match="longer than"):
        client.operate(OBJECT.format(1), value=True, originator="x" * 17)


def test_an_object_another_client_selected_is_refused(relay: Server, client: Client) -> None:
    """The first client selects and is held before its Operate; the second finds the object taken."""
    lib = client._connection.lib
    reference = OBJECT.format(2)
    with client._connection.exclusive("select") as pointer:
        control = controls._create(client._connection, "select", reference, reference.encode(), pointer)
        assert lib.ControlObjectClient_select(control)
        with Client.connect(LOOPBACK, relay.port) as second, pytest.raises(ControlRefused, match="select"):
            second.operate(reference, value=True)
        lib.ControlObjectClient_destroy(control)


def test_a_missing_command_termination_times_out(relay: Server) -> None:
    release = threading.Event()

    def hold(_action: ControlAction) -> bool:
        release.wait(5)
        return True

    relay.on_operate(OBJECT.format(3), hold)
    try:
        with (
            Client.connect(LOOPBACK, relay.port, limits=ClientLimits(command_termination_s=0.2)) as client,
            pytest.raises(Timeout, match="no command termination"),
        ):
            client.operate(OBJECT.format(3), value=True)
    finally:
        release.set()


def test_a_connection_lost_before_the_termination_is_told(relay: Server) -> None:
    with Client.connect(LOOPBACK, relay.port) as client:
        stopper: list[threading.Thread] = []

        def stop(_action: ControlAction) -> bool:
            stopper.append(threading.Thread(target=relay.stop))
            stopper[0].start()
            raise RuntimeError("stopped in the middle")

        relay.on_operate(OBJECT.format(3), stop)
        with pytest.raises((ConnectionLost, ControlRefused)):
            client.operate(OBJECT.format(3), value=True)
        stopper[0].join(10)


def test_handlers_are_for_controllable_objects_only(relay: Server) -> None:
    with pytest.raises(ModelError, match="an object of this model"):
        relay.on_operate("T1CON/RBGGIO1.SPCSO99", lambda _action: True)
    with pytest.raises(ModelError):
        relay.on_operate("T1PRO/GGIO1.Ind01", lambda _action: True)
    with pytest.raises(ModelError, match="a data object"):
        relay.on_operate("T1CON/RBGGIO1.SPCSO01.stVal", lambda _action: True)


def test_an_unknown_add_cause_still_has_words() -> None:
    assert words_of(99) == "add cause 99"
    assert words_of(8) == "blocked by mode"
