"""Access to a simulated relay in a scenario: a pinned certificate, a password, both, or neither."""

from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field

from ied_sim.relay.configuration import Access
from ied_sim.toml_tables import Table
from mms import PASSWORD_RULE, CredentialFileError, TlsConfiguration, TlsVersion, is_password, read_secret


class TlsTable(Table):
    """Certificates and key, as files relative to the scenario."""

    certificate: str
    key: str
    pinned: Annotated[tuple[str, ...], Field(min_length=1)]
    ca: str | None = None
    version: Literal["1.2", "1.3"] = "1.2"


class AccessTable(Table):
    """The table [motor.access] of a scenario."""

    tls: TlsTable | None = None
    password_file: str | None = None

    def access(self, folder: Path) -> Access:
        """Read and check the files. Raise CredentialFileError where one cannot be used."""
        tls = None
        if self.tls is not None:
            version = {"1.2": TlsVersion.TLS_1_2, "1.3": TlsVersion.TLS_1_3}[self.tls.version]
            tls = TlsConfiguration(
                certificate=folder / self.tls.certificate,
                key=folder / self.tls.key,
                pinned=tuple(folder / path for path in self.tls.pinned),
                ca=None if self.tls.ca is None else folder / self.tls.ca,
                version=version,
            )
            tls.check()
        passwords = () if self.password_file is None else _passwords(folder / self.password_file)
        return Access(tls, passwords)


def _passwords(path: Path) -> tuple[str, ...]:
    """Read one password a line."""
    lines = tuple(read_secret(path).decode("latin-1").splitlines())
    if not lines or not all(map(is_password, lines)):
        raise CredentialFileError(path, f"on each line {PASSWORD_RULE}", "something else")
    return lines
