"""Files of certificates and keys that cannot be used: said before anything connects, with file and reason."""

from collections.abc import Callable
from dataclasses import replace
from datetime import timedelta
from pathlib import Path

import pytest
from cryptography.hazmat.primitives import serialization
from cryptography.hazmat.primitives.asymmetric import ed25519
from hypothesis import given
from hypothesis import strategies as st

from mms import Client, CredentialFileError, TlsConfiguration
from mms.security.credential_files import read_certificates, read_secret
from testing.ports import LOOPBACK, free_port
from testing.relays.pki import Pki

PEM = serialization.Encoding.PEM
PKCS8 = serialization.PrivateFormat.PKCS8
A_DAY = timedelta(days=1)


@pytest.fixture
def pki(tmp_path: Path) -> Pki:
    return Pki.make(tmp_path)


def with_key(pki: Pki, content: bytes, mode: int = 0o600) -> TlsConfiguration:
    path = pki.folder / "changed.key"
    path.write_bytes(content)
    path.chmod(mode)
    return replace(pki.of_client(), key=path)


def _with_passphrase(pki: Pki) -> TlsConfiguration:
    encryption = serialization.BestAvailableEncryption(b"passphrase")
    return with_key(pki, pki.client.private_key.private_bytes(PEM, PKCS8, encryption))


def _of_another_kind(pki: Pki) -> TlsConfiguration:
    key = ed25519.Ed25519PrivateKey.generate()
    return with_key(pki, key.private_bytes(PEM, PKCS8, serialization.NoEncryption()))


def _of_another(pki: Pki) -> TlsConfiguration:
    return replace(pki.of_client(), key=pki.alien.key_file)


def _for_others_to_read(pki: Pki) -> TlsConfiguration:
    return with_key(pki, pki.client.key_file.read_bytes(), mode=0o640)


def _garbage(pki: Pki) -> TlsConfiguration:
    return with_key(pki, b"no key")


def _empty(pki: Pki) -> TlsConfiguration:
    return with_key(pki, b"")


def _expired(pki: Pki) -> TlsConfiguration:
    return pki.of(pki.signed("expired", -2 * A_DAY, -A_DAY))


def _missing(pki: Pki) -> TlsConfiguration:
    return replace(pki.of_client(), ca=pki.folder / "missing.pem")


def _no_certificate(pki: Pki) -> TlsConfiguration:
    return replace(pki.of_client(), certificate=pki.client.key_file)


def _signed_by_nobody_known(pki: Pki) -> TlsConfiguration:
    return replace(pki.of_client(), ca=None)


@pytest.mark.parametrize(
    ("spoil", "message"),
    [
        (_with_passphrase, r"changed\.key: expected a key without passphrase \(openssl pkey"),
        (_of_another_kind, r"changed\.key: expected an RSA or elliptic curve key"),
        (_of_another, r"alien\.key: expected the private key of .*client\.pem, found the key of another"),
        (_for_others_to_read, r"changed\.key: expected a file of mode 600, .*chmod 600 .*, found mode 640"),
        (_garbage, r"changed\.key: expected a private key"),
        (_empty, r"changed\.key: expected 1 to"),
        (
            _expired,
            r"expired\.pem: expected a certificate that is valid now, found CN=expired \(SHA-256 .*clock",
        ),
        (_missing, r"missing\.pem: expected a readable file, found No such file"),
        (_no_certificate, r"client\.key: expected a certificate"),
        (_signed_by_nobody_known, r"relay\.pem: expected a self-signed certificate, or its authority's"),
    ],
)
def test_what_is_wrong_is_named_before_connecting(
    pki: Pki, spoil: Callable[[Pki], TlsConfiguration], message: str
) -> None:
    tls = spoil(pki)
    with pytest.raises(CredentialFileError, match=message):
        tls.check()
    with pytest.raises(CredentialFileError, match=message):
        Client.connect(LOOPBACK, free_port(), tls=tls)


def test_somebody_must_be_pinned(pki: Pki) -> None:
    with pytest.raises(ValueError, match="pinned: expected the certificate of the other side"):
        replace(pki.of_client(), pinned=()).check()


def test_der_and_whole_chains_are_read(pki: Pki, tmp_path: Path) -> None:
    der = tmp_path / "relay.der"
    der.write_bytes(pki.relay.certificate.public_bytes(serialization.Encoding.DER))
    assert read_certificates(der) == (pki.relay.certificate,)
    chain = tmp_path / "chain.pem"
    chain.write_bytes(pki.relay.certificate_file.read_bytes() + pki.authority.certificate_file.read_bytes())
    assert read_certificates(chain) == (pki.relay.certificate, pki.authority.certificate)


@given(st.binary(min_size=1, max_size=400), st.booleans())
def test_no_content_is_more_than_a_refusal(
    tmp_path_factory: pytest.TempPathFactory, content: bytes, in_pem: bool
) -> None:
    path = tmp_path_factory.getbasetemp() / "garbage.pem"
    path.write_bytes(b"-----BEGIN CERTIFICATE-----\n" + content if in_pem else content)
    with pytest.raises(CredentialFileError, match=r"garbage\.pem: expected a certificate"):
        read_certificates(path)


@pytest.mark.parametrize("mode", [0o644, 0o604, 0o660, 0o601])
def test_a_secret_is_its_owners_alone(tmp_path: Path, mode: int) -> None:
    path = tmp_path / "secret"
    path.write_text("hidden")
    path.chmod(mode)
    with pytest.raises(CredentialFileError, match=rf"chmod 600 {path}\), found mode {mode:03o}"):
        read_secret(path)
    path.chmod(0o400)
    assert read_secret(path) == b"hidden"


def test_a_credential_of_a_unit_shows_its_mask_as_the_group(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("mms.security.credential_files._FROM_SYSTEMD", tmp_path / "credentials")
    unit = tmp_path / "credentials" / "statorwatch.service"
    unit.mkdir(parents=True)
    for path, refused in (
        (unit / "A1_SEL710", False),
        (tmp_path / "A1_SEL710", True),
        (unit / ".." / ".." / "A1_SEL710", True),
    ):
        path.unlink(missing_ok=True)
        path.write_text("hidden")
        path.chmod(0o440)
        if refused:
            with pytest.raises(CredentialFileError, match="found mode 440"):
                read_secret(path)
        else:
            assert read_secret(path) == b"hidden"
    (unit / "A1_SEL710").chmod(0o444)
    with pytest.raises(CredentialFileError, match="found mode 444"):
        read_secret(unit / "A1_SEL710")
