"""The OPC UA gateway: follows the plant's state, and offers it as the nodes of a server."""

import asyncio
import gc
import socket
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path
from typing import Final

import structlog
from asyncua import ua
from asyncua.crypto.validator import CertificateValidator, CertificateValidatorOptions

from mms import CredentialFileError, read_secret
from service.configuration.gateways.opcua import OpcUaSettings
from service.gateways.context import GatewayContext
from service.gateways.opcua.account_watch import AccountWatch
from service.gateways.opcua.address_space import PlantNodes
from service.gateways.opcua.alarm_events import AlarmEvents
from service.gateways.opcua.certificate import own_certificate
from service.gateways.opcua.history import TrendHistory, tell_capabilities
from service.gateways.opcua.limits import set_limits
from service.gateways.opcua.methods import PlantMethods
from service.gateways.opcua.transport import BoundedServer
from service.gateways.opcua.trusted_clients import TrustedClients
from service.gateways.opcua.users import PlantRules, ServiceUsers
from service.process.installation import installation_id

log = structlog.get_logger(__name__)

LOOK_S: Final = 1.0
"""Longest wait for a change before it is seen whether the service is gone."""
LARGEST_MESSAGE: Final = 4 * 1024**2
ENCRYPTED: Final = (
    ua.SecurityPolicyType.Basic256Sha256_SignAndEncrypt,
    ua.SecurityPolicyType.Aes128Sha256RsaOaep_SignAndEncrypt,
    ua.SecurityPolicyType.Aes256Sha256RsaPss_SignAndEncrypt,
)


def run(context: GatewayContext) -> None:
    """Serve until the service is gone."""
    settings = context.settings.gateways.opcua
    assert settings is not None  # noqa: S101 - it was started for them
    if settings.key is not None:
        _wait_for_key(context, settings.key)
    if not context.stop.is_set():
        asyncio.run(_serve(context, settings))


def _wait_for_key(context: GatewayContext, key: Path) -> None:
    """Return once the key can be used and is its owner's alone; tell meanwhile why it is not."""
    while not context.stop.is_set():
        try:
            read_secret(key)
        except CredentialFileError as error:
            context.tell(f"gateways.opcua.key: {error}")
            context.stop.wait(LOOK_S)
        else:
            return


async def _serve(context: GatewayContext, settings: OpcUaSettings) -> None:
    trusted = None if settings.trusted is None else TrustedClients(settings.trusted)
    users = ServiceUsers(context.repository, context.settings.access, anonymous=settings.anonymous)
    uri = f"urn:statorwatch:{installation_id(context.settings.data_directory)}"
    server = await _server(context, settings, uri, users, trusted)
    nodes = PlantNodes(server, uri)
    await nodes.begin()
    methods = PlantMethods(server, context.repository, context.settings)
    await methods.begin()
    history = TrendHistory(server.iserver, context.repository, nodes.histories)
    server.iserver.history_manager = history
    await tell_capabilities(server)
    events = await AlarmEvents.of(server, nodes)
    follower = context.follower()
    # Of its own: values have to stop being good while all other threads wait for a database that hangs.
    following = ThreadPoolExecutor(1, "OPC UA follower")
    next_change = partial(follower.next_change, context.stop, longest_s=LOOK_S)
    loop = asyncio.get_running_loop()
    watching = asyncio.create_task(AccountWatch(server, context.repository).run())
    is_known = False
    try:
        while not context.stop.is_set():
            change = await loop.run_in_executor(following, next_change)
            if change is not None:
                await nodes.tell(change)
            if server.bserver is not None and change is not None:
                await events.tell(change)
            is_known = is_known or change is not None
            if server.bserver is None and is_known:
                context.tell(await _begun(settings, server))
            elif is_known:
                problems = (follower.problem, None if trusted is None else trusted.problem())
                context.tell("; ".join(filter(None, problems)) or None)
            if watching.done():
                watching.result()  # it has failed, and so the gateway does: the service starts it again
    finally:
        watching.cancel()
        following.shutdown(wait=False)
        follower.close()
        for threads in (users, methods, history):
            threads.close()
        if server.bserver is not None:
            await server.stop()


async def _server(
    context: GatewayContext,
    settings: OpcUaSettings,
    uri: str,
    users: ServiceUsers,
    trusted: TrustedClients | None,
) -> BoundedServer:
    server = BoundedServer(users)
    server.product_uri, server.manufacturer_name = "urn:statorwatch", "StatorWatch"
    gc.disable()  # the objects of the standard's nodes stay for good: it is in vain to look through them
    try:
        await server.init()
    finally:
        gc.freeze()
        gc.enable()
    server.set_endpoint(f"opc.tcp://{settings.bind_address}:{settings.port}/")
    server.set_server_name("StatorWatch")
    await server.set_application_uri(uri)
    await set_limits(server, settings.max_connections)
    server.limits.max_message_size = LARGEST_MESSAGE
    certificate, key = settings.certificate, settings.key
    if certificate is None or key is None:
        certificate, key = own_certificate(context.settings.data_directory, uri, str(settings.bind_address))
    await server.load_certificate(certificate)
    await server.load_private_key(key)
    if trusted is not None:
        options = CertificateValidatorOptions.TRUSTED_VALIDATION | CertificateValidatorOptions.PEER_CLIENT
        server.set_certificate_validator(CertificateValidator(options, trusted))
    policies = list(ENCRYPTED)
    if settings.unencrypted:
        policies.append(ua.SecurityPolicyType.NoSecurity)
    server.set_security_policy(policies, permission_ruleset=PlantRules())
    tokens: list[type] = [ua.UserNameIdentityToken]
    if settings.anonymous:
        tokens.append(ua.AnonymousIdentityToken)
    server.set_identity_tokens(tokens)
    return server


async def _begun(settings: OpcUaSettings, server: BoundedServer) -> str | None:
    """Listen. Return why that cannot be, None where it can; it is tried again."""
    with socket.socket() as probe:  # the library is not to be started again after it failed
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((str(settings.bind_address), settings.port))
        except OSError as error:
            return f"{settings.bind_address}:{settings.port}: {error.strerror}"
    await server.start()
    log.info("serving OPC UA", port=settings.port)
    return None
