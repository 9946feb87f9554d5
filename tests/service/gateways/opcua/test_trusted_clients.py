"""The folder of trusted clients, whatever is in it."""

from pathlib import Path

import pytest
from cryptography import x509
from cryptography.hazmat.primitives import serialization

from service.gateways.opcua.certificate import own_certificate
from service.gateways.opcua.trusted_clients import TrustedClients, application_uris
from testing.ports import LOOPBACK
from testing.relays.certificates import Identity, identity, revocation_list

VERSION_3 = b"\xa0\x03\x02\x01\x02"
VERSION_6 = b"\xa0\x03\x02\x01\x05"
ADDRESS = b"\x87\x04\x7f\x00\x00\x01"
X400_ADDRESS = b"\xa3\x04\x7f\x00\x00\x01"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    folder = tmp_path / "trusted"
    folder.mkdir()
    return folder


@pytest.fixture
def client(tmp_path: Path) -> Identity:
    return identity(tmp_path, "client", authority=True)


def der(client: Identity) -> bytes:
    return client.certificate.public_bytes(serialization.Encoding.DER)


def test_what_cannot_be_read_keeps_out_no_other(folder: Path, client: Identity) -> None:
    certificate = der(client)
    (folder / "good.cer").write_bytes(certificate)
    (folder / "garbage.pem").write_bytes(b"-----BEGIN CERTIFICATE-----\nnone\n")
    (folder / "future.der").write_bytes(certificate.replace(VERSION_3, VERSION_6, 1))
    (folder / "gone.crt").symlink_to(folder / "nowhere")
    (folder / "README.txt").write_text("not meant")
    trusted = TrustedClients(folder)
    assert trusted.is_trusted(client.certificate)
    told = trusted.problem() or ""
    assert all(name in told for name in ("garbage.pem", "future.der", "gone.crt"))
    assert "good.cer" not in told
    assert "README" not in told


def test_a_folder_that_comes_later_counts_and_says_what_it_lacks(tmp_path: Path, client: Identity) -> None:
    folder = tmp_path / "later"
    trusted = TrustedClients(folder)
    assert "No such file" in (trusted.problem() or "")
    assert not trusted.is_trusted(client.certificate)
    folder.mkdir()
    assert "no certificate" in (trusted.problem() or "")
    (folder / "client.der").write_bytes(der(client))
    assert trusted.is_trusted(client.certificate)
    assert trusted.problem() is None
    (folder / "client.der").unlink()
    assert not trusted.is_trusted(client.certificate)


def test_several_certificates_may_be_in_one_file(folder: Path, tmp_path: Path, client: Identity) -> None:
    (tmp_path / "other").mkdir()
    other = identity(tmp_path / "other", "other", authority=True)
    pems = [one.certificate.public_bytes(serialization.Encoding.PEM) for one in (client, other)]
    (folder / "both.pem").write_bytes(b"".join(pems))
    trusted = TrustedClients(folder)
    assert all(trusted.is_trusted(one.certificate) for one in (client, other))
    assert isinstance(other.certificate, x509.Certificate)


def test_who_is_on_a_list_of_the_authority_is_let_in_no_more(folder: Path, tmp_path: Path) -> None:
    plant, alien = (identity(tmp_path, name, authority=True) for name in ("plant", "alien"))
    stolen, good = (identity(tmp_path, name, issuer=plant) for name in ("stolen", "good"))
    for one in (plant, stolen, good):
        (folder / f"{one.certificate_file.name}").write_bytes(der(one))
    trusted = TrustedClients(folder)
    assert trusted.is_trusted(stolen.certificate)
    (folder / "forged.crl").write_bytes(revocation_list(alien, good))
    (folder / "plant.crl").write_bytes(revocation_list(plant, stolen))
    assert not trusted.is_trusted(stolen.certificate)
    assert trusted.is_trusted(good.certificate)
    told = trusted.problem() or ""
    assert "forged.crl: none of the certificates here has signed it" in told
    assert "plant.crl" not in told


@pytest.mark.parametrize(
    ("read", "written"),
    [(b"", b""), (ADDRESS, X400_ADDRESS), (VERSION_3, VERSION_6), (b"\x30\x82", b"\x30\x83")],
)
def test_a_certificate_that_names_no_application_is_nobodys(
    client: Identity, read: bytes, written: bytes
) -> None:
    certificate = der(client)
    assert read in certificate
    assert application_uris(certificate.replace(read, written, 1)) == []


def test_a_certificate_names_its_application(tmp_path: Path) -> None:
    certificate, _ = own_certificate(tmp_path, "urn:plant:client", LOOPBACK)
    assert application_uris(certificate.read_bytes()) == ["urn:plant:client"]
