"""TLS of the station (IEC 62351-3): its files, and the clients that may connect."""

import asyncio
import ssl
from dataclasses import dataclass
from typing import Final, Self

from cryptography import x509
from cryptography.hazmat.primitives.serialization import Encoding

from mms import CredentialFileError, read_secret, without_revoked
from service.configuration.gateways.iec104 import Iec104Tls

HANDSHAKE_S: Final = 5.0


class TlsFileError(ValueError):
    """A file of TLS cannot be used; it says why."""


@dataclass(frozen=True, slots=True)
class Security:
    """The server's side of TLS. pinned: certificates (DER) of the clients that may connect."""

    context: ssl.SSLContext
    pinned: frozenset[bytes]

    @classmethod
    def of(cls, tls: Iec104Tls) -> Self:
        """Return what the files of the settings say. Raises TlsFileError."""
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
        context.minimum_version = ssl.TLSVersion.TLSv1_2
        context.verify_mode = ssl.CERT_REQUIRED
        named = tls.certificate
        try:
            read_secret(tls.key)  # refused where others may use it
            context.load_cert_chain(named, tls.key)
            named = tls.ca
            context.load_verify_locations(named)
            pinned = []
            for named in tls.pinned:
                octets = named.read_bytes()
                is_text = octets.lstrip().startswith(b"-----BEGIN")
                load = x509.load_pem_x509_certificate if is_text else x509.load_der_x509_certificate
                pinned.append(load(octets))
            allowed = without_revoked(pinned, tls.crl, tls.ca)
        except CredentialFileError as error:
            raise TlsFileError(f"gateways.iec104.tls: {error}") from error
        except (OSError, ValueError) as error:  # that of TLS is one of the system, too
            raise TlsFileError(f"gateways.iec104.tls: {named}: {error}") from error
        return cls(context, frozenset(each.public_bytes(Encoding.DER) for each in allowed))

    async def secured(
        self, transport: asyncio.Transport, protocol: asyncio.Protocol
    ) -> asyncio.Transport | None:
        """Return the secured transport of a client that may connect; None where it may not, or went away.

        The protocol may be given what the client has sent before this returns.
        """
        if transport.is_closing():
            return None
        try:
            found = await asyncio.get_running_loop().start_tls(
                transport, protocol, self.context, server_side=True, ssl_handshake_timeout=HANDSHAKE_S
            )
        except OSError:  # those of TLS, of the connection and of the time are all of the system
            return None
        if found is None or found.is_closing():
            return None
        if found.get_extra_info("ssl_object").getpeercert(binary_form=True) in self.pinned:
            return found
        found.abort()
        return None
