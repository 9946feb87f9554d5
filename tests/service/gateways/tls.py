"""What the tests of gateways with TLS share: the plant's certificates, and who may connect."""

from datetime import timedelta

import pytest

from testing.relays.certificates import Identity
from testing.relays.pki import Pki

A_DAY = timedelta(days=1)
ALERT = b"\x15"
"""First octet of what TLS says of a handshake that fails."""


@pytest.fixture(scope="module")
def pki(tmp_path_factory: pytest.TempPathFactory) -> Pki:
    return Pki.make(tmp_path_factory.mktemp("pki"))


def files_of(pki: Pki, *pinned: Identity) -> dict[str, object]:
    """The table `tls`: the client of the plant may connect, and who else is named."""
    return {
        "certificate": pki.relay.certificate_file,
        "key": pki.relay.key_file,
        "ca": pki.authority.certificate_file,
        "pinned": [one.certificate_file for one in (pki.client, *pinned)],
    }
