"""MMS over TLS on the loopback interface: who is let in, who is not, and what is said of it."""

import queue
import socket
import ssl
import threading
import time
from collections.abc import Iterator
from dataclasses import replace
from datetime import timedelta
from io import BytesIO
from pathlib import Path

import pytest

from mms import (
    CertificateRefused,
    Client,
    ConnectFailed,
    CredentialFileError,
    FunctionalConstraint,
    RelayNotTrusted,
    Report,
    Server,
    TlsConfiguration,
    TlsNotSpoken,
    TlsRequired,
    TlsVersion,
)
from mms.binding.library import library
from mms.security import credential_files
from mms.security.credential_files import describe_certificate
from mms.security.tls import TlsContext, unverified_context
from testing.ports import LOOPBACK
from testing.relays.certificates import identity, revocation_list
from testing.relays.pki import Pki
from testing.relays.serving import RelayProcess, mute_server, start_relay
from testing.waiting import eventually

IND01 = "T1PRO/GGIO1.Ind01.stVal"
REPORTS = "T1PRO/LLN0.BR.BRep01"
CONNECT_REQUEST = bytes.fromhex("0300001611e00000000100c0010dc2020001c1020000")
A_DAY = timedelta(days=1)


@pytest.fixture(scope="module")
def pki(tmp_path_factory: pytest.TempPathFactory) -> Pki:
    return Pki.make(tmp_path_factory.mktemp("pki"))


@pytest.fixture
def relay(pki: Pki, file_root: Path) -> Iterator[Server]:
    """It speaks TLS with the client of `pki` alone."""
    with start_relay(file_root=file_root, tls=pki.of_relay()) as server:
        yield server


def connect(relay: Server, tls: TlsConfiguration | None) -> Client:
    return Client.connect(LOOPBACK, relay.port, tls=tls)


def reads(client: Client) -> bool:
    return client.read(IND01, FunctionalConstraint.ST) is False


# who is let in


@pytest.mark.parametrize("version", TlsVersion)
def test_each_version_of_tls_carries_mms(pki: Pki, version: TlsVersion) -> None:
    of_relay = pki.of_relay(version=version)
    with start_relay(tls=of_relay) as relay, connect(relay, pki.of_client(version=version)) as client:
        assert reads(client)


def test_files_and_reports_come_over_tls(pki: Pki, relay: Server, file_root: Path) -> None:
    reports: queue.SimpleQueue[Report] = queue.SimpleQueue()
    with connect(relay, pki.of_client()) as client:
        client.subscribe(REPORTS, reports)
        content = BytesIO()
        client.download("EVENTS/C4_00001.CEV", content)
        assert content.getvalue() == (file_root / "EVENTS" / "C4_00001.CEV").read_bytes()
        relay.update(IND01, value=True)
        assert reports.get(timeout=10).members


def test_self_signed_certificates_need_no_authority(tmp_path: Path) -> None:
    ours, theirs = identity(tmp_path, "ours"), identity(tmp_path, "theirs")
    of_relay = TlsConfiguration(theirs.certificate_file, theirs.key_file, (ours.certificate_file,))
    of_client = TlsConfiguration(ours.certificate_file, ours.key_file, (theirs.certificate_file,))
    with start_relay(tls=of_relay) as relay, connect(relay, of_client) as client:
        assert reads(client)


def test_a_certificate_is_exchanged_with_both_pinned_for_a_while(pki: Pki) -> None:
    newer = pki.signed("newer-relay", -A_DAY, A_DAY)
    of_client = pki.of_client()
    of_client = replace(of_client, pinned=(*of_client.pinned, newer.certificate_file))
    with start_relay(tls=pki.of_relay()) as relay, connect(relay, of_client) as client:
        assert reads(client)
    of_relay = replace(pki.of_relay(), certificate=newer.certificate_file, key=newer.key_file)
    with start_relay(tls=of_relay) as relay, connect(relay, of_client) as client:
        assert reads(client)


# who is not


@pytest.mark.parametrize("version", TlsVersion)
@pytest.mark.parametrize("who", ["of the authority, not pinned", "of another authority"])
def test_an_unknown_client_is_refused(pki: Pki, version: TlsVersion, who: str) -> None:
    other = pki.alien if "another" in who else pki.signed("unpinned", -A_DAY, A_DAY)
    tls = replace(pki.of(other), version=version)
    with start_relay(tls=pki.of_relay(version=version)) as relay:
        refusal = rf"127\.0\.0\.1:{relay.port}: connect: .*our certificate"
        with pytest.raises(CertificateRefused, match=refusal):
            connect(relay, tls)
        with connect(relay, pki.of_client(version=version)) as client:
            assert reads(client), "it goes on serving the others"


def test_a_refusal_that_comes_late_is_no_wrong_password(pki: Pki, monkeypatch: pytest.MonkeyPatch) -> None:
    """With TLS 1.3 the library may not hear why the relay hung up: it fails to write, and says nothing."""
    on_event = TlsContext._on_event

    def deaf(
        self: TlsContext, parameter: None, level: int, code: int, message: bytes, connection: int
    ) -> None:
        if level == 0:
            on_event(self, parameter, level, code, message, connection)

    monkeypatch.setattr(TlsContext, "_on_event", deaf)
    tls = replace(pki.of(pki.alien), version=TlsVersion.TLS_1_3)
    with (
        start_relay(tls=pki.of_relay(version=TlsVersion.TLS_1_3)) as relay,
        pytest.raises(CertificateRefused),
    ):
        Client.connect(LOOPBACK, relay.port, tls=tls, password="OTTER")  # noqa: S106


@pytest.mark.parametrize("version", TlsVersion)
def test_a_client_without_certificate_gets_no_answer(pki: Pki, version: TlsVersion) -> None:
    with start_relay(tls=pki.of_relay(version=version)) as relay:
        context = unverified_context(version)

        def ask() -> bytes:
            with (
                socket.create_connection((LOOPBACK, relay.port), 5) as plain,
                context.wrap_socket(plain) as secured,
            ):
                secured.sendall(CONNECT_REQUEST)
                return secured.recv(1)

        with pytest.raises(ssl.SSLError):
            ask()


def test_a_relay_with_another_certificate_is_not_trusted(pki: Pki, relay: Server) -> None:
    tls = replace(pki.of_client(), pinned=(pki.client.certificate_file,))
    with pytest.raises(RelayNotTrusted, match="none of the pinned ones") as refusal:
        connect(relay, tls)
    assert describe_certificate(pki.client.certificate) in str(refusal.value), "what was expected"


def test_a_relay_whose_certificate_is_revoked_is_not_trusted(pki: Pki, relay: Server, tmp_path: Path) -> None:
    tls = replace(pki.of_client(), crl=tmp_path / "revoked.crl")
    (tmp_path / "revoked.crl").write_bytes(revocation_list(pki.authority, pki.client))
    with connect(relay, tls) as client:
        assert reads(client), "another is revoked"
    (tmp_path / "revoked.crl").write_bytes(revocation_list(pki.authority, pki.relay))
    with pytest.raises(CredentialFileError, match="all of them are revoked"):
        connect(relay, tls)


def test_a_client_whose_certificate_is_revoked_is_refused(pki: Pki, tmp_path: Path) -> None:
    stolen = pki.signed("stolen-client", -A_DAY, A_DAY)
    crl = tmp_path / "revoked.crl"
    crl.write_bytes(revocation_list(pki.authority, stolen))
    of_relay = pki.of_relay()
    of_relay = replace(of_relay, pinned=(*of_relay.pinned, stolen.certificate_file), crl=crl)
    with start_relay(tls=of_relay) as relay:
        with pytest.raises(CertificateRefused):
            connect(relay, pki.of(stolen))
        with connect(relay, pki.of_client()) as client:
            assert reads(client)


@pytest.mark.parametrize("content", [b"", b"nonsense", b"-----BEGIN CERTIFICATE-----\nnone\n", None])
def test_a_list_that_cannot_be_used_lets_nobody_in(
    pki: Pki, relay: Server, tmp_path: Path, content: bytes | None
) -> None:
    """None: made by an authority that is not the plant's."""
    alien = identity(tmp_path, "alien-authority", authority=True)
    crl = tmp_path / "revoked.crl"
    crl.write_bytes(revocation_list(alien) if content is None else content)
    with pytest.raises(CredentialFileError, match=r"revoked\.crl"):
        connect(relay, replace(pki.of_client(), crl=crl))


def test_a_relay_of_an_unknown_authority_is_not_trusted(pki: Pki, relay: Server) -> None:
    tls = replace(pki.of_client(), ca=pki.folder / "other-authority.pem")
    with pytest.raises(RelayNotTrusted, match="no known authority"):
        connect(relay, tls)


@pytest.mark.parametrize(
    ("since", "until", "reason"), [(-2 * A_DAY, -A_DAY, "expired"), (A_DAY, 2 * A_DAY, "not valid")]
)
def test_a_relay_whose_certificate_is_out_of_time_is_not_trusted(
    pki: Pki, monkeypatch: pytest.MonkeyPatch, since: timedelta, until: timedelta, reason: str
) -> None:
    outdated = pki.signed(f"outdated-{reason}", since, until)
    of_relay = replace(pki.of_relay(), certificate=outdated.certificate_file, key=outdated.key_file)
    of_client = replace(pki.of_client(), pinned=(outdated.certificate_file,))
    with pytest.raises(ValueError, match="valid now"):
        of_relay.check()
    monkeypatch.setattr(credential_files, "_require_valid_now", lambda *_: None)
    with start_relay(tls=of_relay) as relay, pytest.raises(RelayNotTrusted, match=reason):
        connect(relay, of_client)


# one side without TLS, or without an answer


def test_a_relay_that_speaks_tls_is_no_plain_one(relay: Server) -> None:
    began_s = time.monotonic()
    with pytest.raises(TlsRequired, match="speaks TLS at this port"):
        Client.connect(LOOPBACK, relay.port, connect_timeout_s=3.0)
    assert time.monotonic() - began_s < 3


def test_a_plain_relay_speaks_no_tls(pki: Pki) -> None:
    with start_relay() as relay:
        began_s = time.monotonic()
        with pytest.raises(TlsNotSpoken, match=r"without TLS: expected TLS.*3782"):
            Client.connect(LOOPBACK, relay.port, connect_timeout_s=3.0, tls=pki.of_client())
        assert time.monotonic() - began_s < 3


def test_no_relay_at_all_is_said_so(pki: Pki) -> None:
    with socket.create_server((LOOPBACK, 0)) as listener:
        port = listener.getsockname()[1]
    with pytest.raises(ConnectFailed, match="the connection was rejected"):
        Client.connect(LOOPBACK, port, tls=pki.of_client())


def test_a_mute_server_fails_within_the_connect_timeout(pki: Pki) -> None:
    """The library itself would try for ever, and hold a core while it does."""
    with mute_server() as port:
        before = threading.active_count()
        began_s, began_cpu_s = time.monotonic(), time.process_time()
        with pytest.raises(ConnectFailed, match="no answer in time"):
            Client.connect(LOOPBACK, port, connect_timeout_s=0.5, tls=pki.of_client())
        assert time.monotonic() - began_s < 2
        assert time.process_time() - began_cpu_s < 2
        assert eventually(lambda: threading.active_count() == before)


def test_a_relay_frozen_after_the_handshake_is_noticed(pki: Pki, file_root: Path) -> None:
    relay = RelayProcess(file_root, pki.folder)
    try:
        with Client.connect(LOOPBACK, relay.port, request_timeout_s=0.5, tls=pki.of_client()) as client:
            assert reads(client)
            relay.freeze()
            with pytest.raises(ConnectFailed, match="no answer in time"):
                Client.connect(LOOPBACK, relay.port, connect_timeout_s=0.5, tls=pki.of_client())
            relay.thaw()
            assert eventually(lambda: reads(client), 10), "the one connected before was left alone"
    finally:
        relay.end()


def test_a_mute_client_holds_a_server_up_no_longer_than_a_handshake_may_last(pki: Pki) -> None:
    with (
        start_relay(tls=pki.of_relay(), tls_handshake_timeout_s=0.5) as relay,
        socket.create_connection((LOOPBACK, relay.port)) as mute,
    ):
        with Client.connect(LOOPBACK, relay.port, connect_timeout_s=10.0, tls=pki.of_client()) as client:
            assert reads(client)
        assert mute.recv(1) == b"", "cut off"


# the C objects


def test_what_the_library_made_is_destroyed_once(pki: Pki, monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[TlsContext] = []
    destroyed: list[int] = []
    original, free = TlsContext.__init__, library().TLSConfiguration_destroy

    def init(self: TlsContext, *arguments: object) -> None:
        original(self, *arguments)  # type: ignore[arg-type]
        made.append(self)

    def destroy(pointer: int) -> None:
        destroyed.append(pointer)
        free(pointer)

    monkeypatch.setattr(TlsContext, "__init__", init)
    monkeypatch.setattr(library(), "TLSConfiguration_destroy", destroy)
    with start_relay(tls=pki.of_relay()) as relay:
        client = connect(relay, pki.of_client())
        pointers = [context.pointer for context in made]
        client.close()
        client.close()
        assert destroyed == pointers[1:]
        with pytest.raises(CertificateRefused):
            connect(relay, pki.of(pki.alien))
        assert len(destroyed) == 2
    relay.stop()
    assert len(destroyed) == 3
    assert all(context.pointer == 0 for context in made)
