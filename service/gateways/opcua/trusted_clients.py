"""The clients that may connect: their certificates, or their authorities', are in the folder `trusted`.

Lists of revoked certificates (CRL) of these authorities lie there, too.
"""

from pathlib import Path
from typing import Final

import structlog
from asyncua.crypto.truststore import TrustStore
from cryptography import x509
from cryptography.x509.verification import Store

from mms import is_revoked, is_signed_by, parse_revocation_lists

log = structlog.get_logger(__name__)

CERTIFICATES: Final = (".der", ".pem", ".crt", ".cer")
REVOCATION_LISTS: Final = (".crl",)

UNREADABLE: Final = (
    ValueError,
    x509.InvalidVersion,
    x509.ExtensionNotFound,
    x509.DuplicateExtension,
    x509.UnsupportedGeneralNameType,
)
"""What a strange certificate may raise where it is asked for its names."""

Stamp = tuple[int, ...]
"""Times, size and number of a file."""


class TrustedClients(TrustStore):  # type: ignore[misc]  # asyncua has no types
    """The certificates of a folder, read again when its files change; without any, nobody is trusted."""

    def __init__(self, folder: Path) -> None:
        super().__init__([folder], [])
        self._problem: str | None = None
        self._folder = folder
        self._revocation_lists: list[x509.CertificateRevocationList] = []
        self._seen: tuple[dict[Path, Stamp], list[str]] | None = None

    def is_trusted(self, certificate: x509.Certificate) -> bool:
        """Tell whether a client with this certificate may connect."""
        self._refresh()
        return bool(super().is_trusted(certificate)) and not is_revoked(certificate, self._revocation_lists)

    def problem(self) -> str | None:
        """Return why a file, or the folder, cannot be used; None while all can. The other files count."""
        self._refresh()
        return self._problem

    def _refresh(self) -> None:
        """Read the certificates, if a file has changed since."""
        stamps, troubles = self._files()
        if (stamps, troubles) == self._seen:
            return
        self._seen = (stamps, list(troubles))
        found: list[x509.Certificate] = []
        lists: list[tuple[Path, x509.CertificateRevocationList]] = []
        for path in stamps:
            try:
                content = path.read_bytes()
                if path.suffix.lower() in REVOCATION_LISTS:
                    lists += [(path, each) for each in parse_revocation_lists(content)]
                else:
                    found += _certificates(content)
            except (OSError, ValueError, x509.InvalidVersion) as error:
                troubles.append(f"{path}: no certificate or list in DER or PEM can be read from it: {error}")
        signed = [(path, each, is_signed_by(each, found)) for path, each in lists]
        troubles += [
            f"{path}: none of the certificates here has signed it"
            for path, _, is_ours in signed
            if not is_ours
        ]
        self._revocation_lists = [each for _, each, is_ours in signed if is_ours]
        self._trust_store = Store(found) if found else None
        self._problem = f"clients are not let in: {'; '.join(troubles)}" if troubles else None
        log.info("OPC UA clients that are trusted", folder=str(self._folder), certificates=len(found))

    def _files(self) -> tuple[dict[Path, Stamp], list[str]]:
        """Return the files that may have certificates, with what changes when they do, and what is wrong."""
        stamps: dict[Path, Stamp] = {}
        troubles: list[str] = []
        try:
            names = sorted(
                path
                for path in self._folder.iterdir()
                if path.suffix.lower() in (*CERTIFICATES, *REVOCATION_LISTS)
            )
        except OSError as error:
            return stamps, [f"{self._folder}: {error.strerror}"]
        for path in names:
            try:
                status = path.stat()
            except OSError as error:
                troubles.append(f"{path}: {error.strerror}")
            else:
                stamps[path] = (status.st_mtime_ns, status.st_ctime_ns, status.st_size, status.st_ino)
        if not names:
            troubles.append(f"{self._folder}: no certificate ({', '.join(CERTIFICATES)}) is in it")
        return stamps, troubles


def application_uris(certificate: bytes) -> list[str]:
    """Return the URIs of the application whose certificate (DER) it is. OPC 10000-6 (6.2.2) wants one."""
    try:
        extensions = x509.load_der_x509_certificate(certificate).extensions
        names = extensions.get_extension_for_class(x509.SubjectAlternativeName).value
    except UNREADABLE:
        return []
    return names.get_values_for_type(x509.UniformResourceIdentifier)


def _certificates(content: bytes) -> list[x509.Certificate]:
    """Return the certificates of a file: any number in PEM, one in DER. Raises ValueError, InvalidVersion."""
    if b"-----BEGIN" in content:
        return x509.load_pem_x509_certificates(content)
    return [x509.load_der_x509_certificate(content)]
