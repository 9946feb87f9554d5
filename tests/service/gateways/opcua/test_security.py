"""Who comes into an OPC UA server: over which channel, with whose certificate and which password."""

import asyncio
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest
from asyncua import Client, ua
from asyncua.crypto.security_policies import (
    SecurityPolicyAes128Sha256RsaOaep,
    SecurityPolicyAes256Sha256RsaPss,
    SecurityPolicyBasic256Sha256,
)
from cryptography import x509
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import rsa

from service.configuration.settings import Settings
from service.gateways.opcua.certificate import own_certificate
from service.storage import Repository
from service.storage.records import Role
from testing.ports import LOOPBACK
from testing.relays.certificates import Identity, identity
from testing.service.conditions import FAULT, HEALTHY, tell
from testing.service.gateways import running_gateways, started_gateways
from testing.waiting import wait_until
from tests.service.gateways.opcua.clients import PASSWORD, PUMP, add_user, address_of, done, node, value
from tests.service.gateways.settings import settings_of

URI = "urn:statorwatch:test-client"
STATE = f"{PUMP}/State"
POLICIES = (SecurityPolicyBasic256Sha256, SecurityPolicyAes128Sha256RsaOaep, SecurityPolicyAes256Sha256RsaPss)
SIGN, SIGN_AND_ENCRYPT = ua.MessageSecurityMode.Sign, ua.MessageSecurityMode.SignAndEncrypt


@dataclass(frozen=True)
class Card:
    """What a client shows: its certificate, with the key of it."""

    certificate: Path
    key: Path


def card(folder: Path) -> Card:
    """One that a client has made for itself."""
    folder.mkdir()
    return Card(*own_certificate(folder, URI, LOOPBACK))


def reissued(made: x509.Certificate, issuer: x509.Name) -> x509.CertificateBuilder:
    """The same certificate without its extensions, to be signed again."""
    return x509.CertificateBuilder(
        issuer,
        made.subject,
        made.public_key(),
        made.serial_number,
        made.not_valid_before_utc,
        made.not_valid_after_utc,
    )


def signed_by(authority: Identity, own: Card) -> Card:
    """The same client's, with the authority's signature instead of its own."""
    made = x509.load_der_x509_certificate(own.certificate.read_bytes())
    builder = reissued(made, authority.certificate.subject)
    for extension in made.extensions:
        builder = builder.add_extension(extension.value, critical=extension.critical)
    certificate = own.certificate.with_name("signed.der")
    signed = builder.sign(authority.private_key, hashes.SHA256())
    certificate.write_bytes(signed.public_bytes(serialization.Encoding.DER))
    return Card(certificate, own.key)


def without_names(own: Card) -> None:
    """Have the certificate say nothing of the application."""
    made = x509.load_der_x509_certificate(own.certificate.read_bytes())
    key = serialization.load_pem_private_key(own.key.read_bytes(), password=None)
    assert isinstance(key, rsa.RSAPrivateKey)
    signed = reissued(made, made.issuer).sign(key, hashes.SHA256())
    own.certificate.write_bytes(signed.public_bytes(serialization.Encoding.DER))


def trust(folder: Path, *certificates: Path) -> str:
    """Make a folder of the certificates that are trusted."""
    folder.mkdir()
    for number, one in enumerate(certificates):
        (folder / f"{number}{one.suffix}").write_bytes(one.read_bytes())
    return str(folder)


async def secured(
    settings: Settings,
    own: Card,
    *,
    policy: Callable[..., object] = SecurityPolicyBasic256Sha256,
    mode: ua.MessageSecurityMode = SIGN_AND_ENCRYPT,
    password: str = PASSWORD,
    uri: str = URI,
) -> Client:
    """A client of the user otto, not connected yet. uri: of the application that it says it is."""
    client = Client(address_of(settings))
    client.application_uri = uri
    client.set_user("otto")
    client.set_password(password)
    await client.set_security(
        policy,
        certificate=str(own.certificate),
        private_key=str(own.key),
        server_certificate=str(settings.data_directory / "opcua-certificate.der"),
        mode=mode,
    )
    return client


async def state(
    settings: Settings,
    own: Card,
    *,
    policy: Callable[..., object] = SecurityPolicyBasic256Sha256,
    mode: ua.MessageSecurityMode = SIGN_AND_ENCRYPT,
    password: str = PASSWORD,
    uri: str = URI,
) -> str:
    """What such a client reads as the motor's state, or why it is not let in."""
    client = await secured(settings, own, policy=policy, mode=mode, password=password, uri=uri)
    try:
        async with client:
            return str(await node(client, STATE).read_value())
    except ua.UaStatusCodeError as refused:
        return type(refused).__name__


def session_of(settings: Settings, certificate: bytes | None = None) -> ua.CreateSessionParameters:
    """What a client asks for to have a session. certificate: the one that it names as its own."""
    return ua.CreateSessionParameters(
        ClientDescription=ua.ApplicationDescription(
            ApplicationUri=URI, ApplicationType=ua.ApplicationType.Client
        ),
        EndpointUrl=address_of(settings),
        SessionName="a session of the tests",
        ClientNonce=bytes(32),
        ClientCertificate=certificate,
        RequestedSessionTimeout=60_000.0,
    )


async def state_in_clear(settings: Settings) -> str:
    """What otto reads over a channel without encryption, whatever the server offers; or why not."""
    client = Client(address_of(settings))
    token = ua.UserNameIdentityToken(PolicyId="username", UserName="otto", Password=PASSWORD.encode())
    await client.connect_socket()
    try:
        await client.send_hello()
        await client.open_secure_channel()
        await client.uaclient.create_session(session_of(settings))
        await client.uaclient.activate_session(ua.ActivateSessionParameters(UserIdentityToken=token))
        return str(await node(client, STATE).read_value())
    except ua.UaStatusCodeError as refused:
        return type(refused).__name__
    finally:
        client.disconnect_socket()


async def session_naming(settings: Settings, own: Card, named: bytes | None) -> str:
    """Whether a client has a session that names this certificate over a channel with its own."""
    client = await secured(settings, own)
    await client.connect_socket()
    try:
        await client.send_hello()
        await client.open_secure_channel()
        await client.uaclient.create_session(session_of(settings, named))
    except ua.UaStatusCodeError as refused:
        return type(refused).__name__
    finally:
        client.disconnect_socket()
    return "a session"


def test_each_policy_lets_in_who_knows_the_password(repository: Repository, tmp_path: Path) -> None:
    add_user(repository, "otto", Role.VIEWER)
    tell(repository, FAULT)
    chosen = settings_of("opcua", tmp_path)
    own = card(tmp_path / "client")
    with running_gateways(chosen):
        for policy in POLICIES:
            assert asyncio.run(state(chosen, own, policy=policy)) == "fault", policy
            refused = asyncio.run(state(chosen, own, policy=policy, password="wrong"))  # noqa: S106 - it is
            assert refused == "BadUserAccessDenied", policy
    failed = [origin for action, _, origin in done(repository) if action == "login-failed"]
    assert failed == [f"opcua {LOOPBACK}"] * len(POLICIES)


def test_a_channel_that_is_signed_alone_is_refused_at_once(repository: Repository, tmp_path: Path) -> None:
    add_user(repository, "otto", Role.VIEWER)
    chosen = settings_of("opcua", tmp_path)
    own = card(tmp_path / "client")

    async def offered() -> list[tuple[str, ua.MessageSecurityMode]]:
        found = await Client(address_of(chosen)).connect_and_get_server_endpoints()
        return [(one.SecurityPolicyUri, one.SecurityMode) for one in found]

    with running_gateways(chosen):
        for policy in POLICIES:
            assert asyncio.run(state(chosen, own, policy=policy, mode=SIGN)) == "BadSecurityPolicyRejected"
        assert asyncio.run(offered()) == [(policy.URI, SIGN_AND_ENCRYPT) for policy in POLICIES]


def test_a_user_comes_in_without_encryption_only_where_the_settings_say_so(
    repository: Repository, tmp_path: Path
) -> None:
    add_user(repository, "otto", Role.VIEWER)
    tell(repository, FAULT)
    chosen = settings_of("opcua", tmp_path)
    with running_gateways(chosen):
        assert asyncio.run(state_in_clear(chosen)) == "BadSecurityPolicyRejected"
    unencrypted = settings_of("opcua", tmp_path, unencrypted=True)
    with running_gateways(unencrypted):
        assert asyncio.run(state_in_clear(unencrypted)) == "fault"


def test_only_clients_that_are_trusted_come_in(repository: Repository, tmp_path: Path) -> None:
    add_user(repository, "otto", Role.VIEWER)
    tell(repository, HEALTHY)
    known, stranger, employed = (card(tmp_path / name) for name in ("known", "stranger", "employed"))
    authority = identity(tmp_path, "plant", authority=True)
    trusted = trust(tmp_path / "trusted", known.certificate, authority.certificate_file)
    chosen = settings_of("opcua", tmp_path, trusted=trusted)
    with running_gateways(chosen):
        assert asyncio.run(state(chosen, known)) == "healthy"
        assert asyncio.run(state(chosen, signed_by(authority, employed))) == "healthy"
        assert asyncio.run(state(chosen, employed)) == "BadCertificateUntrusted"
        assert asyncio.run(state(chosen, stranger)) == "BadCertificateUntrusted"


@pytest.mark.parametrize("names", ["nobody", "somebody that is trusted"])
def test_a_stranger_has_no_session_that_names_no_certificate_or_anothers(
    repository: Repository, tmp_path: Path, names: str
) -> None:
    known, stranger = card(tmp_path / "known"), card(tmp_path / "stranger")
    chosen = settings_of("opcua", tmp_path, trusted=trust(tmp_path / "trusted", known.certificate))
    named = None if names == "nobody" else known.certificate.read_bytes()
    with running_gateways(chosen):
        assert asyncio.run(session_naming(chosen, stranger, named)) == "BadCertificateInvalid"
        own = known.certificate.read_bytes()
        assert asyncio.run(session_naming(chosen, known, own)) == "a session"


def test_a_certificate_lets_in_the_application_alone_that_it_names(
    repository: Repository, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    add_user(repository, "otto", Role.VIEWER)
    tell(repository, HEALTHY)
    own, unnamed = card(tmp_path / "client"), card(tmp_path / "unnamed")
    without_names(unnamed)
    chosen = settings_of("opcua", tmp_path)
    with running_gateways(chosen):
        assert asyncio.run(state(chosen, own)) == "healthy"
        assert asyncio.run(state(chosen, own, uri="urn:statorwatch:another")) == "BadCertificateUriInvalid"
        assert asyncio.run(state(chosen, unnamed)) == "BadCertificateUriInvalid"
    told = [line for line in capfd.readouterr().err.splitlines() if "another application's" in line]
    assert len(told) == 2
    assert "urn:statorwatch:another" in told[0]
    assert URI in told[0]


def test_nobody_comes_in_where_nobody_is_trusted(repository: Repository, tmp_path: Path) -> None:
    add_user(repository, "otto", Role.VIEWER)
    own = card(tmp_path / "client")
    chosen = settings_of("opcua", tmp_path, trusted=trust(tmp_path / "trusted"))
    with started_gateways(chosen) as gateways:
        wait_until(lambda: "no certificate" in (gateways.status()[0].problem or ""), "the folder to be named")
        assert asyncio.run(state(chosen, own)) == "BadCertificateUntrusted"


def test_files_of_trusted_clients_come_and_go_and_one_that_is_none_is_told(
    repository: Repository, tmp_path: Path
) -> None:
    """The server of such a folder never came up."""
    add_user(repository, "otto", Role.VIEWER)
    tell(repository, HEALTHY)
    first, second = card(tmp_path / "first"), card(tmp_path / "second")
    folder = Path(trust(tmp_path / "trusted", first.certificate))
    (folder / "broken.der").write_bytes(b"no certificate")
    chosen = settings_of("opcua", tmp_path, trusted=str(folder))
    with started_gateways(chosen) as gateways:
        wait_until(lambda: "broken.der" in (gateways.status()[0].problem or ""), "the file to be named")
        assert asyncio.run(state(chosen, first)) == "healthy"
        assert asyncio.run(state(chosen, second)) == "BadCertificateUntrusted"
        (folder / "broken.der").unlink()
        made = x509.load_der_x509_certificate(second.certificate.read_bytes())
        (folder / "second.crt").write_bytes(made.public_bytes(serialization.Encoding.PEM))
        assert asyncio.run(state(chosen, second)) == "healthy"
        wait_until(lambda: gateways.status()[0].problem is None, "the file to be forgotten")
        (folder / "0.der").unlink()
        assert asyncio.run(state(chosen, first)) == "BadCertificateUntrusted"


def test_a_server_lists_none_but_itself(repository: Repository, tmp_path: Path) -> None:
    chosen = settings_of("opcua", tmp_path, anonymous=True, unencrypted=True)
    other = ua.RegisteredServer(
        ServerUri="urn:another", ServerNames=[ua.LocalizedText("another")], DiscoveryUrls=["opc.tcp://there"]
    )

    async def register() -> str:
        client = Client(address_of(chosen))
        await client.connect_sessionless()
        try:
            await client.uaclient.register_server(other)
        except ua.UaStatusCodeError as refused:
            return type(refused).__name__
        finally:
            await client.disconnect_sessionless()
        return "registered"

    async def listed() -> list[str]:
        found = await Client(address_of(chosen)).connect_and_find_servers()
        return [str(one.ApplicationUri) for one in found]

    with running_gateways(chosen):
        assert asyncio.run(register()) == "BadServiceUnsupported"
        (itself,) = asyncio.run(listed())
        assert itself.startswith("urn:statorwatch:")
        assert value(chosen, STATE).StatusCode.value == ua.StatusCodes.BadWaitingForInitialData


def test_a_key_that_others_may_read_is_told_until_it_is_its_owners_alone(
    repository: Repository, tmp_path: Path
) -> None:
    tell(repository, HEALTHY)
    own = card(tmp_path / "server")
    own.key.chmod(0o640)
    chosen = settings_of(
        "opcua", tmp_path, certificate=own.certificate, key=own.key, anonymous=True, unencrypted=True
    )
    with started_gateways(chosen) as gateways:
        wait_until(lambda: "mode 600" in str(gateways.status()[0].problem), "the key to be named")
        assert f"gateways.opcua.key: {own.key}" in str(gateways.status()[0].problem)
        own.key.chmod(0o600)
        wait_until(lambda: gateways.status()[0].problem is None, "the gateway to work")
        assert value(chosen, STATE).Value.Value == "healthy"
        assert gateways.status()[0].restarts == 0
