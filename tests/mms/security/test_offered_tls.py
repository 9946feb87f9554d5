"""What our side of TLS offers and takes, read from the wire: one version, and forward secrecy always."""

import socket
import ssl
from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager, suppress

import pytest

from mms import Client, ConnectFailed, MmsError, TlsConfiguration, TlsVersion
from testing.ports import LOOPBACK
from testing.relays.certificates import Identity, identity
from testing.relays.client_hello import TLS_1_2, TLS_1_3, ClientHello, offered_by
from testing.relays.serving import start_relay

CONNECT_REQUEST_BEGINS = bytes([3, 0])
"""TPKT (RFC 1006)."""

WITH_RSA_KEY_EXCHANGE = "AES128-SHA256:AES128-GCM-SHA256:AES256-GCM-SHA384:AES128-SHA"
WITH_ECDHE = ("ECDHE-RSA-AES128-GCM-SHA256", "ECDHE-RSA-AES256-GCM-SHA384")
WITH_DHE = ("DHE-RSA-AES128-GCM-SHA256", "DHE-RSA-AES256-GCM-SHA384")
IANA_WITH_FORWARD_SECRECY = {0xC02B, 0xC02C, 0xC02F, 0xC030, 0x009E, 0x009F}
"""ECDHE or DHE, with AES-GCM."""


@pytest.fixture(scope="module")
def relay(tmp_path_factory: pytest.TempPathFactory) -> Identity:
    """An RSA certificate, which all key exchanges can use."""
    return identity(tmp_path_factory.mktemp("relay"), "relay", with_rsa=True)


@pytest.fixture(scope="module")
def client(tmp_path_factory: pytest.TempPathFactory) -> Identity:
    return identity(tmp_path_factory.mktemp("client"), "client", with_rsa=True)


def side(own: Identity, other: Identity, version: TlsVersion | None = None) -> TlsConfiguration:
    files = (own.certificate_file, own.key_file, (other.certificate_file,))
    return TlsConfiguration(*files) if version is None else TlsConfiguration(*files, version=version)


def hello_of(tls: TlsConfiguration) -> ClientHello:
    def connect(port: int) -> None:
        with suppress(MmsError):
            Client.connect(LOOPBACK, port, connect_timeout_s=1.0, tls=tls).close()

    return offered_by(connect)


def test_a_client_offers_tls_1_2_alone_with_forward_secrecy(client: Identity, relay: Identity) -> None:
    hello = hello_of(side(client, relay))
    assert hello.versions == (TLS_1_2,)
    assert set(hello.suites) == IANA_WITH_FORWARD_SECRECY


def test_a_client_offers_tls_1_3_alone_where_it_is_chosen(client: Identity, relay: Identity) -> None:
    hello = hello_of(side(client, relay, TlsVersion.TLS_1_3))
    assert hello.versions == (TLS_1_3,)
    assert hello.suites
    assert {suite >> 8 for suite in hello.suites} == {0x13}


# a server of another implementation (OpenSSL)


@contextmanager
def openssl_server(own: Identity, *, ciphers: str | None, version: ssl.TLSVersion) -> Iterator[int]:
    """A server for some connections; it takes any client that speaks this version with these ciphers."""
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.load_cert_chain(own.certificate_file, own.key_file)
    context.minimum_version = context.maximum_version = version
    if ciphers is not None:
        context.set_ciphers(ciphers)

    def serve(listener: socket.socket) -> None:
        while True:
            try:
                connection, _ = listener.accept()
            except OSError:
                return
            with connection, suppress(OSError), context.wrap_socket(connection, server_side=True) as secured:
                received.append((secured.cipher() or (), secured.recv(2)))

    received: list[tuple[tuple[object, ...], bytes]] = []
    with socket.create_server((LOOPBACK, 0)) as listener, ThreadPoolExecutor(1) as threads:
        running: Future[None] = threads.submit(serve, listener)
        try:
            yield listener.getsockname()[1]
        finally:
            listener.shutdown(socket.SHUT_RDWR)
            running.result(10)
    handshakes.extend(received)


handshakes: list[tuple[tuple[object, ...], bytes]] = []
"""Cipher and first octets of each that succeeded at the last server."""


def refusal_of(port: int, tls: TlsConfiguration) -> str:
    with pytest.raises(ConnectFailed) as failure:
        Client.connect(LOOPBACK, port, connect_timeout_s=3.0, tls=tls)
    return str(failure.value)


@pytest.fixture(autouse=True)
def _no_handshakes_yet() -> None:
    handshakes.clear()


def test_a_relay_without_forward_secrecy_is_refused(client: Identity, relay: Identity) -> None:
    with openssl_server(relay, ciphers=WITH_RSA_KEY_EXCHANGE, version=ssl.TLSVersion.TLSv1_2) as port:
        refusal = refusal_of(port, side(client, relay))
    assert handshakes == []
    assert "not TLS 1.2 with a cipher suite that we offer: ECDHE or DHE, with AES-GCM" in refusal


@pytest.mark.parametrize("cipher", WITH_ECDHE)
def test_a_relay_with_forward_secrecy_is_spoken_to(client: Identity, relay: Identity, cipher: str) -> None:
    """The server is none of MMS, so that the connect fails in the end."""
    with openssl_server(relay, ciphers=cipher, version=ssl.TLSVersion.TLSv1_2) as port:
        refusal_of(port, side(client, relay))
    chosen, octets = handshakes[0]
    assert (*chosen[:2], octets) == (cipher, "TLSv1.2", CONNECT_REQUEST_BEGINS)


@pytest.mark.parametrize(
    ("theirs", "ours", "other"),
    [
        (ssl.TLSVersion.TLSv1_3, TlsVersion.TLS_1_2, TlsVersion.TLS_1_3),
        (ssl.TLSVersion.TLSv1_2, TlsVersion.TLS_1_3, TlsVersion.TLS_1_2),
    ],
)
def test_a_relay_of_the_other_version_is_told_with_the_setting(
    client: Identity, relay: Identity, theirs: ssl.TLSVersion, ours: TlsVersion, other: TlsVersion
) -> None:
    with openssl_server(relay, ciphers=None, version=theirs) as port:
        refusal = refusal_of(port, side(client, relay, ours))
    assert f'the relay speaks TLS {other}, not {ours}: set version = "{other}"' in refusal
    assert handshakes == []


# our server, asked by a client of another implementation


def handshake(port: int, own: Identity, *, ciphers: str) -> str | None:
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
    context.load_cert_chain(own.certificate_file, own.key_file)
    context.maximum_version = ssl.TLSVersion.TLSv1_2
    context.set_ciphers(ciphers)
    with socket.create_connection((LOOPBACK, port), 5) as plain, context.wrap_socket(plain) as secured:
        return secured.version()


def test_our_server_takes_no_client_without_forward_secrecy(client: Identity, relay: Identity) -> None:
    with start_relay(tls=side(relay, client)) as server:
        with pytest.raises(ssl.SSLError):
            handshake(server.port, client, ciphers=WITH_RSA_KEY_EXCHANGE)
        for cipher in (*WITH_ECDHE, *WITH_DHE):
            assert handshake(server.port, client, ciphers=cipher) == "TLSv1.2"
