"""Files with certificates, keys and passwords: read, checked, and refused with the reason."""

import os
import stat
from datetime import UTC, datetime
from pathlib import Path
from typing import Final

from cryptography import x509
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import ec, rsa

from mms.errors import CredentialFileError

PrivateKey = rsa.RSAPrivateKey | ec.EllipticCurvePrivateKey

_LARGEST: Final = 1_000_000
_OTHERS: Final = stat.S_IRWXG | stat.S_IRWXO
_FROM_SYSTEMD: Final = Path("/run/credentials")
"""Credentials of units lie below. Their access list lets the unit in; the bits of the group are its mask."""


def read_secret(path: Path) -> bytes:
    """Read a file that only its owner may use.

    Parameters
    ----------
    path : pathlib.Path
        The file.

    Returns
    -------
    bytes
        Its content.

    Raises
    ------
    CredentialFileError
        The file cannot be read, is empty or too large, or others may use it.
    """
    return _read(path, secret=True)


def read_public(path: Path) -> bytes:
    """Read a file that everybody may read.

    Parameters
    ----------
    path : pathlib.Path
        The file.

    Returns
    -------
    bytes
        Its content.

    Raises
    ------
    CredentialFileError
        The file cannot be read, is empty or too large.
    """
    return _read(path, secret=False)


def read_certificates(path: Path) -> tuple[x509.Certificate, ...]:
    """Read the certificates of a file.

    Parameters
    ----------
    path : pathlib.Path
        A PEM file with any number of certificates, or a DER file with one.

    Returns
    -------
    tuple of cryptography.x509.Certificate
        The certificates in order.

    Raises
    ------
    CredentialFileError
        The file holds no certificates or cannot be read.
    """
    content = _read(path, secret=False)
    try:
        if b"-----BEGIN" in content:
            return tuple(x509.load_pem_x509_certificates(content))
        return (x509.load_der_x509_certificate(content),)
    except ValueError as error:
        raise CredentialFileError(path, "a certificate (X.509, PEM or DER)", "something else") from error


def read_identity(certificate: Path, key: Path) -> tuple[tuple[x509.Certificate, ...], PrivateKey]:
    """Read a certificate and its private key.

    Parameters
    ----------
    certificate : pathlib.Path
        The certificate, valid at present, followed by its intermediates if it has any.
    key : pathlib.Path
        The private key, its owner's alone.

    Returns
    -------
    chain : tuple of cryptography.x509.Certificate
        The certificate and its intermediates.
    private_key : PrivateKey
        The key.

    Raises
    ------
    CredentialFileError
        A file cannot be used, or the key is of another certificate.
    """
    chain = read_certificates(certificate)
    _require_valid_now(certificate, chain[0])
    private_key = _read_key(key)
    if private_key.public_key() != chain[0].public_key():
        raise CredentialFileError(key, f"the private key of {certificate}", "the key of another certificate")
    return chain, private_key


def is_self_signed(certificate: x509.Certificate) -> bool:
    """Tell whether a certificate is signed by its own key, so that it needs no authority.

    Parameters
    ----------
    certificate : cryptography.x509.Certificate
        The certificate.

    Returns
    -------
    bool
        True if issuer and subject are the same.
    """
    return certificate.issuer == certificate.subject


def describe_certificate(certificate: x509.Certificate) -> str:
    """Describe a certificate for people.

    Parameters
    ----------
    certificate : cryptography.x509.Certificate
        The certificate.

    Returns
    -------
    str
        Subject and SHA-256 fingerprint, as `openssl x509 -noout -subject -fingerprint -sha256` shows them.
    """
    fingerprint = certificate.fingerprint(hashes.SHA256()).hex(":").upper()
    return f"{certificate.subject.rfc4514_string()} (SHA-256 {fingerprint})"


def _require_valid_now(path: Path, certificate: x509.Certificate) -> None:
    now, begin, end = datetime.now(UTC), certificate.not_valid_before_utc, certificate.not_valid_after_utc
    if not begin <= now <= end:
        raise CredentialFileError(
            path,
            "a certificate that is valid now",
            f"{describe_certificate(certificate)}, valid from {_day(begin)} to {_day(end)}: "
            "make a new one, or set this machine's clock",
        )


def _read_key(path: Path) -> PrivateKey:
    content = _read(path, secret=True)
    load = (
        serialization.load_pem_private_key if b"-----BEGIN" in content else serialization.load_der_private_key
    )
    try:
        key = load(content, password=None)
    except TypeError as error:
        expected = f"a key without passphrase (openssl pkey -in {path} -out NEW)"
        raise CredentialFileError(path, expected, "one with a passphrase") from error
    except ValueError as error:
        raise CredentialFileError(path, "a private key (PEM or DER)", "something else") from error
    if not isinstance(key, PrivateKey):
        raise CredentialFileError(path, "an RSA or elliptic curve key (IEC 62351-3)", "another kind of key")
    return key


def _read(path: Path, *, secret: bool) -> bytes:
    try:
        with path.open("rb") as file:
            mode = stat.S_IMODE(os.fstat(file.fileno()).st_mode)
            others = stat.S_IRWXO if _FROM_SYSTEMD in path.resolve().parents else _OTHERS
            if secret and mode & others:
                raise CredentialFileError(
                    path, f"a file of mode 600, its owner's alone (chmod 600 {path})", f"mode {mode:03o}"
                )
            content = file.read(_LARGEST + 1)
    except OSError as error:
        raise CredentialFileError(path, "a readable file", error.strerror or str(error)) from error
    if not content or len(content) > _LARGEST:
        raise CredentialFileError(path, f"1 to {_LARGEST} bytes", "none" if not content else "more")
    return content


def _day(time: datetime) -> str:
    return time.strftime("%Y-%m-%d %H:%M UTC")
