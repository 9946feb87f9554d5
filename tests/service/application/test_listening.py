"""The socket of the API."""

import socket
from pathlib import Path

from service.application.serve import listening
from service.configuration.settings import Settings


def test_an_answer_does_not_wait_for_the_acknowledgement_of_its_header(tmp_path: Path) -> None:
    """On a connection that is kept, it would be 40 ms late: what uvicorn writes after the header waits."""
    with listening(Settings(data_directory=tmp_path, port=0)) as listener:
        with socket.create_connection(listener.getsockname()[:2], timeout=5):
            connection, _ = listener.accept()
        with connection:
            assert connection.getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY)
