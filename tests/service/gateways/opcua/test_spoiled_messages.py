"""Messages that are wrong, from the open secure channel to a call, end no OPC UA server."""

import asyncio
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
from asyncua import Client, ua

from service.storage import Repository
from testing.service.conditions import FAULT, tell
from testing.service.gateways import running_gateways
from testing.waiting import eventually
from tests.service.gateways.opcua.clients import PUMP, address_of, node, value
from tests.service.gateways.settings import settings_of
from tests.service.gateways.spoiled_messages import Spoiling, try_spoilings

ANSWER_S = 0.3
MESSAGES = 11
"""Of the session below: hello, channel, session and so on; those of a session that goes well."""


async def session(address: str, spoiling: Spoiling) -> int:
    """Hold a session in which one message is spoiled; return how many were sent."""
    client = Client(address, timeout=ANSWER_S)
    sent = 0
    await client.connect_socket()
    transport = client.uaclient.protocol.transport
    write = transport.write

    def write_spoiled(content: bytes) -> None:
        nonlocal sent
        write(spoiling.of(sent, content))
        sent += 1

    transport.write = write_spoiled
    try:
        await client.send_hello()
        await client.open_secure_channel()
        await client.create_session()
        await client.activate_session()
        await node(client, f"{PUMP}/State").read_value()
        await node(client, PUMP).get_children()
        await node(client, f"{PUMP}/FaultLevel").read_raw_history(None, None, 10)
        await node(client, f"{PUMP}/State").write_value("healthy")
    finally:
        await _end(client)
    return sent


async def _end(client: Client) -> None:
    with suppress(Exception):  # whatever the spoiled session has left of the client
        await client.close_session()
    client.disconnect_socket()


@pytest.mark.campaign
def test_spoiled_messages_end_no_gateway(repository: Repository, tmp_path: Path) -> None:
    tell(repository, FAULT)
    chosen = settings_of("opcua", tmp_path, anonymous=True, unencrypted=True)
    address = address_of(chosen)

    def spoiled_session(spoiling: Spoiling) -> None:
        # The client raises what its library comes upon, too: only the server is looked at.
        with suppress(ua.UaError, OSError, TimeoutError, ValueError, TypeError, AttributeError):
            asyncio.run(session(address, spoiling))

    with running_gateways(chosen) as gateways:
        first = gateways.status()[0].process_id
        try_spoilings(MESSAGES, spoiled_session, examples=60)

        def told() -> Any:
            return value(chosen, f"{PUMP}/State").Value.Value

        assert eventually(lambda: told() == "fault")
        status = gateways.status()[0]
        assert (status.process_id, status.restarts) == (first, 0)
