"""Messages that are wrong, from COTP to MMS, end no IEC 61850 server and keep nobody out."""

import socket
from contextlib import suppress
from pathlib import Path

from mms import Client, MmsError
from service.storage import Repository
from testing.ports import LOOPBACK
from testing.service.conditions import FAULT, tell
from testing.service.gateways import running_gateways
from testing.waiting import eventually
from tests.service.gateways.iec61850.recorded_session import message, recorded
from tests.service.gateways.iec61850.test_iec61850 import MEASURED, PUMP, STATUS
from tests.service.gateways.settings import port_of, settings_of
from tests.service.gateways.spoiled_messages import Spoiling, try_spoilings

ANSWER_S = 0.1


def browse_and_read(port: int) -> None:
    """A session with most of what clients ask a server of verdicts for."""
    with Client.connect(LOOPBACK, port) as client:
        client.logical_devices()
        client.data_sets(f"{PUMP}/LLN0")
        client.read(f"{PUMP}/ZMOT1.EEHealth", STATUS)
        client.read(f"{PUMP}/GGIO1.AnIn1.mag.f", MEASURED)


def test_spoiled_messages_end_no_gateway(repository: Repository, tmp_path: Path) -> None:
    tell(repository, FAULT)
    chosen = settings_of("iec61850", tmp_path)
    port = port_of(chosen)

    with running_gateways(chosen) as gateways:
        first = gateways.status()[0].process_id
        sent = recorded(port, browse_and_read)

        def session(spoiling: Spoiling) -> None:
            with socket.create_connection((LOOPBACK, port), timeout=10) as link:
                link.settimeout(ANSWER_S)
                with suppress(OSError):
                    for number, content in enumerate(sent):
                        link.sendall(spoiling.of(number, content))
                        message(link)

        def health() -> object:
            with suppress(MmsError), Client.connect(LOOPBACK, port) as client:
                return client.read(f"{PUMP}/ZMOT1.EEHealth.stVal", STATUS)
            return None

        try_spoilings(len(sent), session, examples=100)
        assert eventually(lambda: health() == 3)
        status = gateways.status()[0]
        assert (status.process_id, status.restarts) == (first, 0)
