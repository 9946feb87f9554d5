"""The API with a certificate of its own."""

import shutil
import socket
import ssl
from datetime import timedelta
from pathlib import Path

import httpx
import pytest
from fastapi import FastAPI

from service.api import ApiContext
from service.api.access.certificate import CertificateError, ServerCertificate
from service.api.limits.connections import ConnectionLimits
from service.api.server import CERTIFICATE_PERIOD_S, connection_limits
from service.cli import main
from service.client.credentials import remember
from service.storage import Repository
from testing.relays.certificates import Identity, identity
from testing.service.accounts import token_of
from testing.waiting import wait_until
from tests.service.api.serving import LONGEST_S, listening

PASSWORD = "correct horse battery"  # noqa: S105 - of nobody


@pytest.fixture(scope="module")
def authority(tmp_path_factory: pytest.TempPathFactory) -> Identity:
    return identity(tmp_path_factory.mktemp("pki"), "authority", authority=True)


@pytest.fixture
def own(tmp_path: Path, authority: Identity) -> Identity:
    return identity(tmp_path, "mcc", issuer=authority)


def served_serial(port: int) -> int:
    """The serial number of the certificate that is shown to a new connection."""
    from cryptography import x509

    shown = ssl.get_server_certificate(("127.0.0.1", port), timeout=LONGEST_S)
    return x509.load_pem_x509_certificate(shown.encode()).serial_number


def test_a_client_that_knows_the_authority_is_answered_over_tls(
    app: FastAPI, context: ApiContext, own: Identity, authority: Identity
) -> None:
    certificate = ServerCertificate(own.certificate_file, own.key_file)
    trusting = ssl.create_default_context(cafile=authority.certificate_file)
    with listening(app, connection_limits(context.settings), certificate) as port:
        url = f"https://127.0.0.1:{port}"
        with httpx.Client(base_url=url, verify=trusting, trust_env=False, timeout=LONGEST_S) as client:
            assert client.get("/api/v1/motors").status_code == 200
        with pytest.raises(httpx.ConnectError, match="CERTIFICATE_VERIFY_FAILED"):
            httpx.get(f"{url}/healthz", trust_env=False)
        with pytest.raises(httpx.TransportError):
            httpx.get(f"http://127.0.0.1:{port}/healthz", trust_env=False)
        old = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
        old.check_hostname, old.verify_mode = False, ssl.CERT_NONE
        old.set_ciphers("ALL:@SECLEVEL=0")
        with pytest.warns(DeprecationWarning, match="TLSv1_1"):
            old.maximum_version = ssl.TLSVersion.TLSv1_1
        with (
            socket.create_connection(("127.0.0.1", port), timeout=LONGEST_S) as plain,
            pytest.raises(ssl.SSLError),
        ):
            old.wrap_socket(plain)


def test_the_cookie_of_a_session_goes_over_tls_alone(
    app: FastAPI, context: ApiContext, repository: Repository, own: Identity, authority: Identity
) -> None:
    from service.access.passwords import hashed
    from service.storage.records import Role
    from testing.service.accounts import TESTS

    repository.add_user("anna", [Role.VIEWER], password=hashed(PASSWORD), by=TESTS, now_ns=1)
    certificate = ServerCertificate(own.certificate_file, own.key_file)
    trusting = ssl.create_default_context(cafile=authority.certificate_file)
    with (
        listening(app, connection_limits(context.settings), certificate) as port,
        httpx.Client(
            base_url=f"https://127.0.0.1:{port}", verify=trusting, trust_env=False, timeout=LONGEST_S
        ) as client,
    ):
        answer = client.post("/api/v1/login", json={"name": "anna", "password": PASSWORD})
        cookie = answer.headers["set-cookie"]
        assert cookie.startswith("__Host-statorwatch_session=")
        for part in ("Secure", "HttpOnly", "SameSite=strict", "Path=/"):
            assert part in cookie
        assert client.get("/api/v1/motors").status_code == 200


def test_commands_verify_the_certificate(
    app: FastAPI,
    context: ApiContext,
    repository: Repository,
    own: Identity,
    authority: Identity,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    certificate = ServerCertificate(own.certificate_file, own.key_file)
    with listening(app, connection_limits(context.settings), certificate) as port:
        url = f"https://127.0.0.1:{port}"
        remember(url, token=token_of(repository))
        assert main(["motors", "--url", url]) == 1
        assert "CERTIFICATE_VERIFY_FAILED" in capsys.readouterr().err
        monkeypatch.setenv("MCC_CA", str(authority.certificate_file))
        assert main(["motors", "--url", url]) == 0
        monkeypatch.setenv("MCC_CA", "/nowhere.pem")
        assert main(["motors", "--url", url]) == 1
        assert "/nowhere.pem: expected certificates" in capsys.readouterr().err


def test_another_certificate_is_taken_while_it_runs(
    app: FastAPI,
    context: ApiContext,
    own: Identity,
    authority: Identity,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("service.api.server.CERTIFICATE_PERIOD_S", 0.05)
    assert CERTIFICATE_PERIOD_S <= 10.0, "the page says ten seconds"
    certificate = ServerCertificate(own.certificate_file, own.key_file)
    new = identity(tmp_path, "new", issuer=authority, until=timedelta(days=90))
    with listening(app, connection_limits(context.settings), certificate) as port:
        assert served_serial(port) == own.certificate.serial_number
        Path(shutil.copy(new.certificate_file, tmp_path / "half")).replace(own.certificate_file)
        certificate.renew()
        assert served_serial(port) == own.certificate.serial_number, "its key has not come yet"
        Path(shutil.copy(new.key_file, tmp_path / "key")).replace(own.key_file)
        wait_until(lambda: served_serial(port) == new.certificate.serial_number, "the new one")


def test_what_cannot_be_used_is_named(own: Identity, authority: Identity, tmp_path: Path) -> None:
    with pytest.raises(CertificateError, match=r"authority.*expected a certificate and its private key"):
        ServerCertificate(authority.certificate_file, own.key_file)
    with pytest.raises(CertificateError, match="gone"):
        ServerCertificate(own.certificate_file, tmp_path / "gone.key")
    own.key_file.chmod(0o644)
    with pytest.raises(CertificateError, match=r"chmod 600|mode"):
        ServerCertificate(own.certificate_file, own.key_file)


def test_who_begins_no_tls_is_closed(app: FastAPI, own: Identity) -> None:
    certificate = ServerCertificate(own.certificate_file, own.key_file)
    limits = ConnectionLimits(
        most=20, waiting=20, header_timeout_s=0.3, transfer_timeout_s=5.0, idle_timeout_s=5.0
    )
    with (
        listening(app, limits, certificate) as port,
        socket.create_connection(("127.0.0.1", port), timeout=LONGEST_S) as silent,
    ):
        assert silent.recv(1) == b""
