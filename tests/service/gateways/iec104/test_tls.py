"""Who reads values of the IEC 60870-5-104 server over TLS, and who is told nothing.

Both sides use OpenSSL.
"""

import socket
import ssl
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import pytest

from service.configuration.gateways.iec104 import Iec104Settings
from service.configuration.settings import Settings
from service.storage import Repository
from testing.ports import LOOPBACK
from testing.relays.certificates import Identity, revocation_list
from testing.relays.pki import Pki
from testing.service.conditions import FAULT, tell
from testing.service.gateways import running_gateways, started_gateways
from testing.service.iec104_master import Master
from testing.waiting import wait_until
from tests.service.gateways.iec104.test_iec104 import PUMP
from tests.service.gateways.iec104.test_spoiled_telegrams import START_DATA_TRANSFER, UNITS, telegram
from tests.service.gateways.settings import port_of, settings_of
from tests.service.gateways.tls import A_DAY, ALERT, files_of, pki

__all__ = ["pki"]  # a fixture


@pytest.fixture
def secured(repository: Repository, tmp_path: Path, pki: Pki) -> Iterator[int]:
    """The port of a server that knows of a fault, and knows the client of the plant alone."""
    tell(repository, FAULT)
    chosen = settings_of("iec104", tmp_path, tls=files_of(pki))
    with running_gateways(chosen):
        yield port_of(chosen)


def linked(port: int, pki: Pki, own: Identity | None) -> ssl.SSLSocket:
    """A connection with this certificate, or with none. The server has to show one of the plant."""
    context = ssl.create_default_context(cafile=pki.authority.certificate_file)
    if own is not None:
        context.load_cert_chain(own.certificate_file, own.key_file)
    plain = socket.create_connection((LOOPBACK, port), timeout=20)
    try:
        return context.wrap_socket(plain, server_hostname=LOOPBACK)
    except BaseException:
        plain.close()
        raise


def fault(port: int, pki: Pki, own: Identity | None) -> float:
    """What a client with this certificate is told of the pump: 1 for a fault."""
    with linked(port, pki, own) as link:
        master = Master(LOOPBACK, port, link)
        master.interrogate()
        return master.told[PUMP + 1].value


def test_a_client_of_the_plant_reads_a_value(pki: Pki, secured: int) -> None:
    assert fault(secured, pki, pki.client) == 1
    with linked(secured, pki, pki.client) as link:
        assert link.version() in ("TLSv1.2", "TLSv1.3")


def test_a_stranger_is_told_nothing(repository: Repository, tmp_path: Path, pki: Pki) -> None:
    outdated = pki.signed("outdated", -2 * A_DAY, -A_DAY)
    strangers = {
        "no certificate": None,
        "of the plant, but not pinned": pki.signed("unpinned", -A_DAY, A_DAY),
        "pinned, but of another authority": pki.alien,
        "pinned, but out of date": outdated,
    }
    tell(repository, FAULT)
    chosen = settings_of("iec104", tmp_path, tls=files_of(pki, pki.alien, outdated))
    with running_gateways(chosen) as gateways:
        for who, own in strangers.items():
            try:
                told = fault(port_of(chosen), pki, own)
            except (ssl.SSLError, ConnectionError):
                continue
            pytest.fail(f"{who}: the client was told {told}")
        assert fault(port_of(chosen), pki, pki.client) == 1
        assert gateways.status()[0].restarts == 0


def test_a_client_whose_certificate_is_revoked_is_told_nothing(
    repository: Repository, tmp_path: Path, pki: Pki
) -> None:
    stolen = pki.signed("stolen", -A_DAY, A_DAY)
    crl = tmp_path / "revoked.pem"
    crl.write_bytes(revocation_list(pki.authority, stolen))
    tell(repository, FAULT)
    chosen = settings_of("iec104", tmp_path, tls={**files_of(pki, stolen), "crl": crl})
    with running_gateways(chosen):
        with pytest.raises((ssl.SSLError, ConnectionError)):
            fault(port_of(chosen), pki, stolen)
        assert fault(port_of(chosen), pki, pki.client) == 1


def test_a_client_that_speaks_in_clear_is_told_nothing(pki: Pki, secured: int) -> None:
    heard = b""
    with socket.create_connection((LOOPBACK, secured), timeout=20) as link, suppress(ConnectionError):
        link.sendall(START_DATA_TRANSFER + telegram(0, UNITS[0]))
        while part := link.recv(4096):
            heard += part
    assert heard[:1] in (b"", ALERT)
    assert fault(secured, pki, pki.client) == 1


def test_a_station_without_tls_knows_no_handshake(repository: Repository, tmp_path: Path, pki: Pki) -> None:
    chosen = settings_of("iec104", tmp_path)
    with running_gateways(chosen), pytest.raises((ssl.SSLError, ConnectionError)):
        linked(port_of(chosen), pki, pki.client)


def test_a_file_that_is_missing_is_named_and_nobody_is_served(
    repository: Repository, tmp_path: Path, pki: Pki
) -> None:
    away = tmp_path / "away.pem"
    chosen = settings_of("iec104", tmp_path, tls={**files_of(pki), "certificate": away})
    with started_gateways(chosen) as gateways:
        wait_until(lambda: str(away) in (gateways.status()[0].problem or ""), "the name of the file")
        with pytest.raises(ConnectionRefusedError):
            socket.create_connection((LOOPBACK, port_of(chosen)))


def test_a_key_that_others_may_read_is_refused_until_it_is_its_owners_alone(
    repository: Repository, tmp_path: Path, pki: Pki
) -> None:
    key = tmp_path / "shared.pem"
    key.write_bytes(pki.relay.key_file.read_bytes())
    key.chmod(0o640)
    chosen = settings_of("iec104", tmp_path, tls={**files_of(pki), "key": key})
    told = f"{key}: expected a file of mode 600, its owner's alone (chmod 600 {key}), found mode 640"
    with started_gateways(chosen) as gateways:
        wait_until(lambda: told in (gateways.status()[0].problem or ""), "the mode of the file")
        with pytest.raises(ConnectionRefusedError):
            socket.create_connection((LOOPBACK, port_of(chosen)))
        key.chmod(0o600)
        wait_until(lambda: gateways.status()[0].problem is None, "the gateway to work")
        with linked(port_of(chosen), pki, pki.client) as link:
            Master(LOOPBACK, port_of(chosen), link).interrogate()


def test_all_files_are_needed_and_are_enough_beyond_loopback(pki: Pki, tmp_path: Path) -> None:
    files = files_of(pki)
    beyond = {"bind_address": "10.0.0.1", "tls": files}
    assert Iec104Settings.model_validate(beyond).tls is not None
    for name in files:
        with pytest.raises(ValueError, match=name):
            Iec104Settings.model_validate(
                {**beyond, "tls": {one: files[one] for one in files if one != name}}
            )
    with pytest.raises(ValueError, match="pinned"):
        Iec104Settings.model_validate({**beyond, "tls": {**files, "pinned": []}})
    assert Settings(data_directory=tmp_path).gateways.iec104 is None


def test_clients_that_begin_no_handshake_keep_nobody_out(pki: Pki, secured: int) -> None:
    mute = [socket.create_connection((LOOPBACK, secured), timeout=20) for _ in range(30)]
    assert fault(secured, pki, pki.client) == 1
    assert mute[0].recv(1) == b"", "it has been sent away"
    for one in mute:
        one.close()
