"""Who reads values of the IEC 61850 server over TLS, and who is told nothing.

One client is ours, the other one is written in Rust, with another implementation of TLS.
"""

import asyncio
import socket
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

import iec61850
import pytest

from mms import AssociationRejected, CertificateRefused, Client, ConnectFailed, TlsRequired, TlsVersion
from service.configuration.gateways.iec61850 import Iec61850Settings
from service.storage import Repository
from testing.ports import LOOPBACK
from testing.relays.certificates import Identity
from testing.relays.pki import Pki
from testing.service.conditions import FAULT, tell
from testing.service.gateways import running_gateways, started_gateways
from testing.waiting import wait_until
from tests.service.gateways.iec61850.test_iec61850 import MEASURED, PUMP
from tests.service.gateways.settings import port_of, settings_of
from tests.service.gateways.tls import A_DAY, ALERT, files_of, pki

__all__ = ["pki"]  # a fixture

VERSIONS = {"1.2": TlsVersion.TLS_1_2, "1.3": TlsVersion.TLS_1_3}
LEVEL = f"{PUMP}/GGIO1.AnIn1.mag.f"
PASSWORD = "open sesame"  # noqa: S105 - of the test
CONNECT_REQUEST = bytes.fromhex("0300001611e00000000100c0010dc2020001c1020000")


@pytest.fixture
def secured(repository: Repository, tmp_path: Path, pki: Pki) -> Iterator[int]:
    """The port of a server that knows of a fault, and knows the client of the plant alone."""
    tell(repository, FAULT)
    chosen = settings_of("iec61850", tmp_path, tls=files_of(pki))
    with running_gateways(chosen):
        yield port_of(chosen)


def level(
    port: int, pki: Pki, own: Identity | None = None, password: str | None = None, *, version: str = "1.2"
) -> object:
    """What our client reads of the pump, with the certificate of the plant's client or another one."""
    tls = replace(pki.of(own or pki.client), version=VERSIONS[version])
    with Client.connect(LOOPBACK, port, connect_timeout_s=15, tls=tls, password=password) as client:
        return client.read(LEVEL, MEASURED)


def level_in_rust(port: int, pki: Pki, own: Identity | None) -> float:
    """What the client in Rust reads, with this certificate or with none."""

    async def read() -> float:
        certificate, key = (None, None) if own is None else (own.certificate_file, own.key_file)
        tls = iec61850.TlsConfig(
            pki.authority.certificate_file.read_bytes(),
            client_cert_pem=None if certificate is None else certificate.read_bytes(),
            client_key_pem=None if key is None else key.read_bytes(),
        )
        client = await iec61850.IedConnection.connect_tls(
            f"{LOOPBACK}:{port}", tls, LOOPBACK, timeout_ms=15_000
        )
        try:
            return float(await client.read_float(LEVEL, iec61850.FC.MX))
        finally:
            await client.disconnect()

    return asyncio.run(read())


def test_a_client_of_the_plant_reads_a_value(repository: Repository, tmp_path: Path, pki: Pki) -> None:
    """With TLS 1.2 the client in Rust offers suites for RSA alone; the plant's keys are of ECDSA."""
    tell(repository, FAULT)
    chosen = settings_of("iec61850", tmp_path, tls={**files_of(pki), "version": "1.3"})
    with running_gateways(chosen):
        assert level(port_of(chosen), pki, version="1.3") == pytest.approx(1.21)
        assert level_in_rust(port_of(chosen), pki, pki.client) == pytest.approx(1.21)


def test_a_stranger_is_told_nothing(repository: Repository, tmp_path: Path, pki: Pki) -> None:
    unpinned = pki.signed("unpinned", -A_DAY, A_DAY)
    tell(repository, FAULT)
    chosen = settings_of("iec61850", tmp_path, tls={**files_of(pki, pki.alien), "version": "1.3"})
    with running_gateways(chosen) as gateways:
        for own in (unpinned, pki.alien):
            with pytest.raises(CertificateRefused):
                level(port_of(chosen), pki, own, version="1.3")
        for stranger in (unpinned, pki.alien, None):
            with pytest.raises(iec61850.IedError):
                level_in_rust(port_of(chosen), pki, stranger)
        assert level_in_rust(port_of(chosen), pki, pki.client) == pytest.approx(1.21)
        assert gateways.status()[0].restarts == 0


def test_a_client_that_speaks_in_clear_is_told_nothing(pki: Pki, secured: int) -> None:
    with pytest.raises(TlsRequired):
        Client.connect(LOOPBACK, secured, connect_timeout_s=15)
    heard = b""
    with socket.create_connection((LOOPBACK, secured), timeout=20) as link, suppress(ConnectionError):
        link.sendall(CONNECT_REQUEST)
        while part := link.recv(4096):
            heard += part
    assert heard[:1] in (b"", ALERT)
    assert level(secured, pki) == pytest.approx(1.21)


def test_clients_that_are_mute_keep_nobody_out_for_long(pki: Pki, secured: int) -> None:
    with socket.create_connection((LOOPBACK, secured), timeout=20) as mute:
        assert level(secured, pki) == pytest.approx(1.21)
        assert mute.recv(1) == b"", "sent away"


def test_the_password_is_asked_for_besides(repository: Repository, tmp_path: Path, pki: Pki) -> None:
    secret = tmp_path / "password"
    secret.write_text(f"{PASSWORD}\n", encoding="ascii")
    secret.chmod(0o600)
    tell(repository, FAULT)
    chosen = settings_of("iec61850", tmp_path, tls=files_of(pki), password_file=secret)
    port = port_of(chosen)
    with running_gateways(chosen):
        assert level(port, pki, password=PASSWORD) == pytest.approx(1.21)
        for wrong in (None, "open barley"):
            with pytest.raises(AssociationRejected):
                level(port, pki, password=wrong)
        with pytest.raises(CertificateRefused):
            level(port, pki, pki.alien, PASSWORD)
        with pytest.raises(ConnectFailed):
            Client.connect(LOOPBACK, port, password=PASSWORD)


def test_the_version_is_that_of_the_settings(repository: Repository, tmp_path: Path, pki: Pki) -> None:
    tell(repository, FAULT)
    chosen = settings_of("iec61850", tmp_path, tls={**files_of(pki), "version": "1.3"})
    with running_gateways(chosen):
        with pytest.raises(ConnectFailed, match=r"TLS 1\.3, not 1\.2"):
            level(port_of(chosen), pki)
        assert level(port_of(chosen), pki, version="1.3") == pytest.approx(1.21)


@pytest.mark.parametrize("secret", ["key", "password"])
def test_a_secret_that_others_may_read_is_named_and_nobody_is_served(
    repository: Repository, tmp_path: Path, pki: Pki, secret: str
) -> None:
    table: dict[str, object] = {}
    file = tmp_path / secret
    if secret == "key":  # noqa: S105 - which file it is
        file.write_bytes(pki.relay.key_file.read_bytes())
        table["tls"] = {**files_of(pki), "key": file}
    else:
        file.write_text(f"{PASSWORD}\n", encoding="ascii")
        table["password_file"] = file
    file.chmod(0o644)
    chosen = settings_of("iec61850", tmp_path, **table)
    with started_gateways(chosen) as gateways:
        wait_until(lambda: str(file) in (gateways.status()[0].problem or ""), "the name of the file")
        with pytest.raises(ConnectionRefusedError):
            socket.create_connection((LOOPBACK, port_of(chosen)))
        file.chmod(0o600)
        wait_until(lambda: gateways.status()[0].problem is None, "the server to begin")


def test_a_certificate_is_enough_beyond_loopback(pki: Pki) -> None:
    beyond = {"bind_address": "10.0.0.1", "tls": files_of(pki)}
    assert Iec61850Settings.model_validate(beyond).tls is not None
    for name in ("certificate", "key", "pinned"):
        files = {one: file for one, file in files_of(pki).items() if one != name}
        with pytest.raises(ValueError, match=name):
            Iec61850Settings.model_validate({**beyond, "tls": files})
