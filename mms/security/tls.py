"""TLS for MMS associations (IEC 62351-3, IEC 62351-4 T-profile): both sides show a certificate, and pin.

The library's Mbed TLS does the work. This module holds the configuration, which is checked before anything
connects, and the owner of the C object made of it.
"""

import ctypes
import os
import ssl
import threading
from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum
from pathlib import Path
from typing import Final

from cryptography import x509
from cryptography.hazmat.primitives import serialization

from mms.binding.callbacks import guarded
from mms.binding.prototypes import TlsEventHandler
from mms.errors import CredentialFileError
from mms.security.credential_files import (
    PrivateKey,
    describe_certificate,
    is_self_signed,
    read_certificates,
    read_identity,
)
from mms.security.revocation import without_revoked

TLS_PORT: Final = 3782
"""Port at which servers speak TLS by default (IEC 62351-3)."""

_INCIDENT: Final = 2  # TLSEventLevel
_ESTABLISHED: Final = 16  # TLS_EVENT_CODE_INF_SESSION_ESTABLISHED
_UNTRUSTED: Final = {
    6: "it is not valid, or not yet: compare the clocks",
    11: "it has expired",
    12: "it has been revoked",
    13: "it is none of the pinned ones",
    14: "no known authority (ca) has signed it",
}
"""The library's event codes for what is wrong with the peer's certificate."""

_count_lock: Final = threading.Lock()
"""Guards the library's own count of its configurations, which tells it when to end its cryptography."""


class TlsVersion(IntEnum):
    """TLS versions, with the numbers of the library's TLSConfigVersion."""

    TLS_1_2 = 6
    TLS_1_3 = 7

    def __str__(self) -> str:
        return {6: "1.2", 7: "1.3"}[self]


CIPHER_SUITES: Final = {
    TlsVersion.TLS_1_2: (
        0xC02B,  # TLS_ECDHE_ECDSA_WITH_AES_128_GCM_SHA256
        0xC02C,  # TLS_ECDHE_ECDSA_WITH_AES_256_GCM_SHA384
        0xC02F,  # TLS_ECDHE_RSA_WITH_AES_128_GCM_SHA256
        0xC030,  # TLS_ECDHE_RSA_WITH_AES_256_GCM_SHA384
        0x009E,  # TLS_DHE_RSA_WITH_AES_128_GCM_SHA256
        0x009F,  # TLS_DHE_RSA_WITH_AES_256_GCM_SHA384
    ),
    TlsVersion.TLS_1_3: (
        0x1301,  # TLS_AES_128_GCM_SHA256
        0x1302,  # TLS_AES_256_GCM_SHA384
        0x1303,  # TLS_CHACHA20_POLY1305_SHA256
        0x1304,  # TLS_AES_128_CCM_SHA256
    ),
}
"""Cipher suites of each version, by their numbers of IANA, the preferred first.

All have forward secrecy: a recorded connection stays secret when a private key becomes known. The library's
own list begins with TLS_RSA_WITH_AES_128_CBC_SHA256, which has not.
"""

_SSL_CIPHERS: Final = "ECDHE+AESGCM:DHE+AESGCM"
"""Those of TLS 1.2 for the ssl module, whose list for TLS 1.3 cannot be changed."""

_SSL_VERSIONS: Final = {
    TlsVersion.TLS_1_2: ssl.TLSVersion.TLSv1_2,
    TlsVersion.TLS_1_3: ssl.TLSVersion.TLSv1_3,
}


@dataclass(frozen=True, slots=True)
class TlsConfiguration:
    """Our certificate, and the certificates we trust. Files are PEM or DER.

    Parameters
    ----------
    certificate : pathlib.Path
        Our certificate.
    key : pathlib.Path
        Its private key. The file must be its owner's alone (mode 600).
    pinned : tuple of pathlib.Path
        Certificates of those we speak with, at least one; more while one is being exchanged.
    ca : pathlib.Path, optional
        Authorities that sign the pinned certificates. None where those are self-signed.
    crl : pathlib.Path, optional
        Their lists of revoked certificates (CRL), read for each connection or server.
    version : TlsVersion, default TLS_1_2
        The one version to speak. Clients of Mbed TLS before 3.6.8 that offer 1.2 and 1.3 both have a flaw
        (CVE-2026-115490), so none offers both.

    References
    ----------
    IEC 62351-3, profiles including TCP/IP; IEC 62351-4, profiles including MMS.
    """

    certificate: Path
    key: Path
    pinned: tuple[Path, ...]
    ca: Path | None = None
    crl: Path | None = None
    version: TlsVersion = TlsVersion.TLS_1_2

    def check(self) -> None:
        """Read all files and check them.

        Raises
        ------
        CredentialFileError
            A file cannot be used; the error says which, what was expected and what was found.
        """
        _Credentials.read(self)


@dataclass(frozen=True, slots=True)
class _Credentials:
    """Contents of the files of a TlsConfiguration."""

    chain: tuple[x509.Certificate, ...]
    key: PrivateKey
    pinned: tuple[x509.Certificate, ...]
    authorities: tuple[x509.Certificate, ...]

    @classmethod
    def read(cls, configuration: TlsConfiguration) -> "_Credentials":
        if not configuration.pinned:
            raise ValueError("pinned: expected the certificate of the other side, found none")
        chain, key = read_identity(configuration.certificate, configuration.key)
        pinned: list[x509.Certificate] = []
        for path in configuration.pinned:
            certificates = read_certificates(path)
            if configuration.ca is None and not all(map(is_self_signed, certificates)):
                raise CredentialFileError(
                    path, "a self-signed certificate, or its authority's given as ca", "one signed by another"
                )
            pinned.extend(certificates)
        authorities = tuple(pinned) if configuration.ca is None else read_certificates(configuration.ca)
        pinned_still = without_revoked(pinned, configuration.crl, configuration.ca)
        return cls(chain, key, pinned_still, authorities)


def unverified_context(version: TlsVersion) -> ssl.SSLContext:
    """Make a context of the ssl module that offers what we offer, for a look at what answers.

    Parameters
    ----------
    version : TlsVersion
        The version to offer, with our cipher suites.

    Returns
    -------
    ssl.SSLContext
        The context. It verifies nothing.
    """
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.check_hostname = False
    context.verify_mode = ssl.CERT_NONE
    context.minimum_version = context.maximum_version = _SSL_VERSIONS[version]
    context.set_ciphers(_SSL_CIPHERS)
    return context


class TlsContext:
    """The library's TLSConfiguration of one client connection or one server, destroyed after it.

    Parameters
    ----------
    lib : ctypes.CDLL
        The library.
    configuration : TlsConfiguration
        Our certificate and those we trust.

    Raises
    ------
    CredentialFileError
        A file cannot be used; the error says which, what was expected and what was found.
    """

    def __init__(self, lib: ctypes.CDLL, configuration: TlsConfiguration) -> None:
        self._lib = lib
        self._configuration = configuration
        self._incidents: list[int] = []
        self._established: TlsVersion | None = None
        self._credentials_read = material = _Credentials.read(configuration)
        self.trusted: Final = tuple(describe_certificate(certificate) for certificate in material.pinned)
        self.version: Final = configuration.version
        self._handler = TlsEventHandler(guarded(self._on_event, None))
        with _count_lock:
            self.pointer = int(lib.TLSConfiguration_create() or 0)
        if not self.pointer:
            raise MemoryError("the MMS library has no memory for a TLS configuration")
        try:
            self._fill(material)
        except BaseException:
            self.destroy()
            raise

    def _fill(self, material: _Credentials) -> None:
        lib, given = self._lib, self._configuration
        lib.TLSConfiguration_setEventHandler(self.pointer, self._handler, None)
        yes, no = True, False
        lib.TLSConfiguration_setChainValidation(self.pointer, yes)
        lib.TLSConfiguration_setTimeValidation(self.pointer, yes)
        lib.TLSConfiguration_setAllowOnlyKnownCertificates(self.pointer, yes)
        lib.TLSConfiguration_enableSessionResumption(self.pointer, no)  # it would skip the certificates
        lib.TLSConfiguration_setMinTlsVersion(self.pointer, int(given.version))
        lib.TLSConfiguration_setMaxTlsVersion(self.pointer, int(given.version))
        lib.TLSConfiguration_clearCipherSuiteList(self.pointer)
        for suite in CIPHER_SUITES[given.version]:
            lib.TLSConfiguration_addCipherSuite(self.pointer, suite)
        key = material.key.private_bytes(
            serialization.Encoding.DER, serialization.PrivateFormat.PKCS8, serialization.NoEncryption()
        )
        if not lib.TLSConfiguration_setOwnKey(self.pointer, key, len(key), None):
            raise self._unsupported_algorithm(given.key)
        for certificate in material.chain:
            self._give(lib.TLSConfiguration_setOwnCertificate, certificate, given.certificate)
        for certificate in material.pinned:
            self._give(lib.TLSConfiguration_addAllowedCertificate, certificate, given.pinned[0])
        for certificate in material.authorities:
            self._give(lib.TLSConfiguration_addCACertificate, certificate, given.ca or given.pinned[0])

    def _give(
        self, take: Callable[[int, bytes, int], bool], certificate: x509.Certificate, path: Path
    ) -> None:
        content = certificate.public_bytes(serialization.Encoding.DER)
        if not take(self.pointer, content, len(content)):
            raise self._unsupported_algorithm(path)

    def _unsupported_algorithm(self, path: Path) -> CredentialFileError:
        expected = "RSA, or an elliptic curve of NIST or Brainpool (IEC 62351-3)"
        return CredentialFileError(path, expected, "an algorithm the MMS library does not know")

    def _on_event(
        self, _parameter: int | None, level: int, code: int, _message: bytes | None, connection: int | None
    ) -> None:
        if level == _INCIDENT:
            self._incidents.append(code)
        elif code == _ESTABLISHED:
            self._established = TlsVersion(self._lib.TLSConnection_getTLSVersion(connection))

    def certificate_fault(self) -> str | None:
        """Tell what is wrong with the certificate that the peer showed.

        Returns
        -------
        str or None
            The fault in words; None where the library found none.
        """
        return next((_UNTRUSTED[code] for code in self._incidents if code in _UNTRUSTED), None)

    @property
    def established_version(self) -> TlsVersion | None:
        """Version of a handshake that succeeded, if nothing has gone wrong since; else None.

        With TLS 1.2 the peer has accepted our certificate by then. With 1.3 it says so, or not, only
        afterwards.
        """
        return None if self._incidents else self._established

    def ssl_context(self) -> ssl.SSLContext:
        """Make a context of the ssl module for a handshake with the same certificate.

        The context verifies nothing: compare the peer's certificate by `is_pinned`.

        Returns
        -------
        ssl.SSLContext
            The context.
        """
        context = unverified_context(self.version)
        identity = b"".join(
            each.public_bytes(serialization.Encoding.PEM) for each in self._credentials_read.chain
        )
        identity += self._credentials_read.key.private_bytes(
            serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8, serialization.NoEncryption()
        )
        memory = os.memfd_create(
            "identity"
        )  # the ssl module takes files only, and no file on disk may hold the key
        try:
            os.write(memory, identity)
            context.load_cert_chain(f"/proc/self/fd/{memory}")
        finally:
            os.close(memory)
        return context

    def is_pinned(self, certificate: bytes | None) -> bool:
        """Tell whether a certificate is one of those we trust.

        Parameters
        ----------
        certificate : bytes or None
            The certificate in DER; None for none.

        Returns
        -------
        bool
            True if it is pinned.
        """
        pinned = (each.public_bytes(serialization.Encoding.DER) for each in self._credentials_read.pinned)
        return certificate is not None and certificate in pinned

    def reset(self) -> None:
        """Forget what happened in an earlier attempt."""
        self._incidents.clear()
        self._established = None

    def destroy(self) -> None:
        """Free the library's object once its owner has been destroyed; a second call does nothing."""
        pointer, self.pointer = self.pointer, 0
        if pointer:
            with _count_lock:
                self._lib.TLSConfiguration_destroy(pointer)
