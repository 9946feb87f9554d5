"""A service that has ended, or stands still, is not told to be alive by the process that accepts for it."""

import socket
import threading

import pytest

from service.process import acceptor
from service.process.acceptor import Acceptor

HEALTH = b"GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n"
PATIENCE_S = 20.0


@pytest.mark.parametrize("signs", [[], [b"HTTP/1.1 200 OK\r\n\r\n"]], ids=["no sign of life", "an old one"])
def test_a_service_that_stands_still_is_not_told_to_be_alive(
    signs: list[bytes], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(acceptor, "STILL_ALIVE_S", 0.0)
    service, other = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    with socket.create_server(("127.0.0.1", 0)) as listener, service, other:
        for sign in signs:
            service.send(sign)
        thread = threading.Thread(target=Acceptor(listener, other, most=10).run)
        thread.start()
        with socket.create_connection(listener.getsockname(), timeout=PATIENCE_S) as client:
            client.sendall(HEALTH)
            service.settimeout(PATIENCE_S)
            message, descriptors, _, _ = socket.recv_fds(service, 10, 10)
            with socket.socket(fileno=descriptors[0]) as handed:
                assert (message, handed.recv(100)) == (acceptor.HANDED, HEALTH)
        service.close()
        thread.join(PATIENCE_S)
        assert not thread.is_alive(), "it ends with the service"
