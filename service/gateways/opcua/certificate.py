"""The server's own certificate: that of the settings, or one that it makes for itself."""

import ipaddress
import socket
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Final

from cryptography import x509
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import rsa
from cryptography.x509.oid import ExtendedKeyUsageOID, NameOID

from service.gateways.kept_file import replace_file

CERTIFICATE: Final = "opcua-certificate.der"
KEY: Final = "opcua-key.pem"
VALID_DAYS: Final = 3650
KEY_BITS: Final = 2048


def own_certificate(data_directory: Path, application_uri: str, host: str) -> tuple[Path, Path]:
    """Return certificate and key of this installation, made at the first call.

    Raises OSError where they cannot be written.
    """
    certificate, key = data_directory / CERTIFICATE, data_directory / KEY
    if not (certificate.exists() and key.exists()):
        private = rsa.generate_private_key(public_exponent=65_537, key_size=KEY_BITS)
        pem = private.private_bytes(
            serialization.Encoding.PEM,
            serialization.PrivateFormat.PKCS8,
            serialization.NoEncryption(),
        )
        replace_file(key, pem)
        signed = _signed(private, application_uri, host)
        replace_file(certificate, signed.public_bytes(serialization.Encoding.DER))
    return certificate, key


def _signed(private: rsa.RSAPrivateKey, application_uri: str, host: str) -> x509.Certificate:
    """Return a self-signed certificate of an application (OPC UA part 6, 6.2.2)."""
    name = x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, "StatorWatch")])
    now = datetime.now(UTC)
    names: list[x509.GeneralName] = [
        x509.UniformResourceIdentifier(application_uri),
        *(x509.DNSName(one) for one in dict.fromkeys(("localhost", socket.gethostname())) if one.isascii()),
        x509.IPAddress(ipaddress.ip_address(host)),
    ]
    usage = x509.KeyUsage(
        digital_signature=True,
        content_commitment=True,
        key_encipherment=True,
        data_encipherment=True,
        key_agreement=False,
        key_cert_sign=True,
        crl_sign=False,
        encipher_only=False,
        decipher_only=False,
    )
    return (
        x509.CertificateBuilder()
        .subject_name(name)
        .issuer_name(name)
        .public_key(private.public_key())
        .serial_number(x509.random_serial_number())
        .not_valid_before(now - timedelta(hours=1))
        .not_valid_after(now + timedelta(days=VALID_DAYS))
        .add_extension(x509.SubjectAlternativeName(names), critical=False)
        .add_extension(x509.BasicConstraints(ca=False, path_length=None), critical=True)
        .add_extension(usage, critical=True)
        .add_extension(
            x509.ExtendedKeyUsage([ExtendedKeyUsageOID.SERVER_AUTH, ExtendedKeyUsageOID.CLIENT_AUTH]),
            critical=False,
        )
        .add_extension(x509.SubjectKeyIdentifier.from_public_key(private.public_key()), critical=False)
        .sign(private, hashes.SHA256())
    )
