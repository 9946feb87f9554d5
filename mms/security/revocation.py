"""Revoked certificates: lists of an authority (CRL, RFC 5280), read and checked."""

import re
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Final

from cryptography import x509

from mms.errors import CredentialFileError
from mms.security.credential_files import read_certificates, read_public

_PEM: Final = re.compile(rb"-----BEGIN X509 CRL-----.*?-----END X509 CRL-----", re.DOTALL)

RevocationLists = Sequence[x509.CertificateRevocationList]


def parse_revocation_lists(content: bytes) -> RevocationLists:
    """Return the lists of a file.

    Parameters
    ----------
    content : bytes
        Any number of lists in PEM, or one in DER.

    Returns
    -------
    sequence of cryptography.x509.CertificateRevocationList
        The lists in order.

    Raises
    ------
    ValueError
        There is none.
    """
    if b"-----BEGIN" not in content:
        return [x509.load_der_x509_crl(content)]
    lists = [x509.load_pem_x509_crl(each) for each in _PEM.findall(content)]
    if not lists:
        raise ValueError("expected BEGIN X509 CRL, found other PEM")
    return lists


def is_signed_by(revoked: x509.CertificateRevocationList, authorities: Iterable[x509.Certificate]) -> bool:
    """Tell whether one of the authorities has made a list.

    Parameters
    ----------
    revoked : cryptography.x509.CertificateRevocationList
        The list.
    authorities : iterable of cryptography.x509.Certificate
        Those whose lists count.

    Returns
    -------
    bool
        Whether the signature is right.
    """
    return any(
        revoked.issuer == authority.subject and revoked.is_signature_valid(authority.public_key())  # type: ignore[arg-type]  # of any kind
        for authority in authorities
    )


def is_revoked(certificate: x509.Certificate, lists: RevocationLists) -> bool:
    """Tell whether a list of the certificate's own authority has it.

    Parameters
    ----------
    certificate : cryptography.x509.Certificate
        The certificate.
    lists : sequence of cryptography.x509.CertificateRevocationList
        Lists whose signatures were checked.

    Returns
    -------
    bool
        Whether it is revoked. An authority that has made no list has revoked none.
    """
    return any(
        each.issuer == certificate.issuer
        and each.get_revoked_certificate_by_serial_number(certificate.serial_number) is not None
        for each in lists
    )


def without_revoked(
    certificates: Sequence[x509.Certificate], crl: Path | None, ca: Path | None
) -> tuple[x509.Certificate, ...]:
    """Return the pinned certificates that are not revoked.

    Parameters
    ----------
    certificates : sequence of cryptography.x509.Certificate
        The pinned ones.
    crl : pathlib.Path, optional
        A file with lists in PEM, or one in DER. None: nothing is revoked.
    ca : pathlib.Path, optional
        The authorities, one of which has signed each list.

    Returns
    -------
    tuple of cryptography.x509.Certificate
        At least one.

    Raises
    ------
    CredentialFileError
        The file cannot be used, or all certificates are revoked.
    """
    if crl is None:
        return tuple(certificates)
    authorities = () if ca is None else read_certificates(ca)
    try:
        lists = parse_revocation_lists(read_public(crl))
    except ValueError as error:
        raise CredentialFileError(crl, "revocation lists (CRL, PEM or DER)", "something else") from error
    if not all(is_signed_by(each, authorities) for each in lists):
        raise CredentialFileError(crl, "lists signed by an authority in ca", "one signed by another")
    left = tuple(each for each in certificates if not is_revoked(each, lists))
    if not left:
        raise CredentialFileError(crl, "a pinned certificate that is not revoked", "all of them are revoked")
    return left
