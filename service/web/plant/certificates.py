"""All certificates that the settings name, each with what uses it and when it ends."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from service.configuration.certificate_files import certificate_files
from service.configuration.settings import Settings
from service.web.relays.certificates import CertificateEnd, certificate_end, first_to_end

MOST_USERS: Final = 5


@dataclass(frozen=True, slots=True)
class UsedCertificate:
    """A file with certificates. users: the first of what uses it; further: how many there are besides."""

    end: CertificateEnd
    users: Sequence[str]
    further: int


def used_certificates(settings: Settings) -> Sequence[UsedCertificate]:
    """Return the files, the first to end, or not to be read, first."""
    found = [
        UsedCertificate(certificate_end(path), users[:MOST_USERS], max(len(users) - MOST_USERS, 0))
        for path, users in certificate_files(settings).items()
    ]
    return sorted(found, key=lambda one: first_to_end(one.end))
