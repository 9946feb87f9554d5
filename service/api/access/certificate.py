"""The API's own certificate: read at the start, and again when its files have changed."""

import ssl
from pathlib import Path

import structlog
from structlog.typing import FilteringBoundLogger

from mms import CredentialFileError, read_secret

log: FilteringBoundLogger = structlog.get_logger(__name__)

Stamp = tuple[tuple[int, int, int], ...]


class CertificateError(Exception):
    """The certificate or its key cannot be used; it says which file, what was expected and what was found."""


class ServerCertificate:
    """A certificate with its intermediates, and its private key, for TLS 1.2 and 1.3."""

    def __init__(self, certificate: Path, key: Path) -> None:
        """Read the files. Raises CertificateError."""
        self._certificate = certificate
        self._key = key
        self._stamp = self._present_stamp()
        self.context = self._loaded()

    def renew(self) -> None:
        """Take the certificate anew for new connections where its files have changed.

        One that cannot be used changes nothing: half of the two files may have come so far.
        """
        stamp = self._present_stamp()
        if stamp == self._stamp:
            return
        self._stamp = stamp
        try:
            self._loaded()
            self.context.load_cert_chain(self._certificate, self._key, password=_no_passphrase)
        except (CertificateError, OSError) as error:
            log.warning("the new certificate of the API cannot be used, the old one stays", error=str(error))
        else:
            log.info("the API has another certificate", certificate=str(self._certificate))

    def _loaded(self) -> ssl.SSLContext:
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
        context.minimum_version = ssl.TLSVersion.TLSv1_2
        context.options |= ssl.OP_NO_RENEGOTIATION
        context.set_alpn_protocols(["http/1.1"])
        try:
            read_secret(self._key)
            context.load_cert_chain(self._certificate, self._key, password=_no_passphrase)
        except CredentialFileError as error:
            raise CertificateError(f"tls_key: {error}") from error
        except (OSError, ValueError) as error:  # ssl.SSLError is one
            raise CertificateError(
                f"{self._certificate}, {self._key}: expected a certificate and its private key in PEM, "
                f"without passphrase (settings tls_certificate, tls_key), found: {error}"
            ) from error
        return context

    def _present_stamp(self) -> Stamp:
        return tuple(map(_stamp, (self._certificate, self._key)))


def _stamp(path: Path) -> tuple[int, int, int]:
    try:
        status = path.stat()
    except OSError:
        return (0, 0, 0)
    return status.st_ino, status.st_mtime_ns, status.st_size


def _no_passphrase() -> str:
    """Ask nobody: OpenSSL would ask at the terminal."""
    raise ValueError("the key has a passphrase")
