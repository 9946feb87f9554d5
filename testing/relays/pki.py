"""A plant's certificates, and both sides' configurations made of them."""

from dataclasses import dataclass, replace
from datetime import timedelta
from pathlib import Path

from mms import TlsConfiguration, TlsVersion
from testing.relays.certificates import Identity, identity


@dataclass(frozen=True, slots=True)
class Pki:
    """An authority, a relay and a client of it, and a client of another authority."""

    folder: Path
    authority: Identity
    relay: Identity
    client: Identity
    alien: Identity

    @classmethod
    def make(cls, folder: Path) -> "Pki":
        authority = identity(folder, "authority", authority=True)
        other = identity(folder, "other-authority", authority=True)
        return cls(
            folder,
            authority,
            identity(folder, "relay", issuer=authority),
            identity(folder, "client", issuer=authority),
            identity(folder, "alien", issuer=other),
        )

    def signed(self, name: str, since: timedelta, until: timedelta) -> Identity:
        """One more of the authority, valid from and to, from now."""
        return identity(self.folder, name, issuer=self.authority, since=since, until=until)

    def of_relay(self, *pinned: Identity, version: TlsVersion = TlsVersion.TLS_1_2) -> TlsConfiguration:
        """The relay's side; it knows the client, and who else is named."""
        return replace(self._configuration(self.relay, self.client, *pinned), version=version)

    def of_client(self, *, version: TlsVersion = TlsVersion.TLS_1_2) -> TlsConfiguration:
        """The client's side."""
        return replace(self._configuration(self.client, self.relay), version=version)

    def of(self, owner: Identity) -> TlsConfiguration:
        """The client's side with another certificate."""
        return self._configuration(owner, self.relay)

    def _configuration(self, own: Identity, *pinned: Identity) -> TlsConfiguration:
        return TlsConfiguration(
            certificate=own.certificate_file,
            key=own.key_file,
            pinned=tuple(each.certificate_file for each in pinned),
            ca=self.authority.certificate_file,
        )
