"""Clients of the OPC UA server that tests look with, and its users."""

import asyncio
import sys
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any

from asyncua import Client, ua
from asyncua.crypto.security_policies import SecurityPolicyBasic256Sha256

from service.access.passwords import hashed
from service.configuration.settings import Settings
from service.gateways.opcua.certificate import own_certificate
from service.storage import Repository
from service.storage.records import Role
from testing.not_installed import not_installed
from testing.ports import LOOPBACK
from testing.service.accounts import TESTS
from testing.service.plants import NOW_NS
from tests.service.gateways.settings import port_of

PASSWORD = "correct horse battery"  # noqa: S105 - of a test's user
PUMP = "motor/PUMP-A1"
PEER = Path(sys.prefix) / "open62541"
"""Where .ci/run installs the other stack's client."""


def require_open62541() -> None:
    """Skip the test where the other stack's client is not installed; fail it in CI."""
    if not PEER.exists():
        not_installed(f"no open62541: python -m pip install --no-deps --target {PEER} o6==2.2.0")


def address_of(settings: Settings) -> str:
    return f"opc.tcp://{LOOPBACK}:{port_of(settings)}/"


def add_user(repository: Repository, name: str, role: Role, *, now_ns: int = NOW_NS) -> None:
    repository.add_user(name, {role}, password=hashed(PASSWORD), by=TESTS, now_ns=now_ns)


def done(repository: Repository) -> list[tuple[str, str, str]]:
    """What the audit trail has: action, by whom, from where."""
    with repository.audit_trail() as trail:
        return [(one.action, one.actor, one.origin) for one in trail.entries()]


async def encrypted(settings: Settings, user: str | None = None, password: str = PASSWORD) -> Client:
    """A client with a certificate of its own, not connected yet."""
    folder = settings.data_directory / "client"
    folder.mkdir(exist_ok=True)
    certificate, key = own_certificate(folder, "urn:statorwatch:test-client", LOOPBACK)
    client = Client(address_of(settings), timeout=60)
    client.application_uri = "urn:statorwatch:test-client"
    if user is not None:
        client.set_user(user)
        client.set_password(password)
    await client.set_security(
        SecurityPolicyBasic256Sha256,
        certificate=str(certificate),
        private_key=str(key),
        server_certificate=str(settings.data_directory / "opcua-certificate.der"),
        mode=ua.MessageSecurityMode.SignAndEncrypt,
    )
    return client


def looking(settings: Settings, look: Callable[[Client], Awaitable[Any]]) -> Any:
    """What a client that is nobody sees."""

    async def ask() -> Any:
        async with Client(address_of(settings)) as client:
            return await look(client)

    return asyncio.run(ask())


def node(client: Client, path: str) -> Any:
    return client.get_node(f"ns=2;s={path}")


def value(settings: Settings, path: str) -> Any:
    """Value, status and time of a variable."""

    async def read(client: Client) -> Any:
        return await node(client, path).read_data_value(raise_on_bad_status=False)

    return looking(settings, read)
