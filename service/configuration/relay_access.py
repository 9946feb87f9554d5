"""The credentials that the service shows to a relay: certificates, a password.

Settings hold paths only. Secrets are read at each connect, from files that only their owner can read or from
the environment. So nothing that prints settings or hands them on can reveal a secret.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Final, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, SecretStr

from mms import PASSWORD_RULE, CredentialFileError, TlsConfiguration, TlsVersion, is_password, read_secret
from service.configuration.environment import VARIABLES

AbsolutePath = Annotated[Path, AfterValidator(Path.absolute)]

PASSWORD_VARIABLE: Final = "MCC_RELAY_PASSWORD_"  # noqa: S105 - the name of one
"""Followed by the relay's name as the SCD has it; wins over the file."""

_VERSIONS: Final = {"1.2": TlsVersion.TLS_1_2, "1.3": TlsVersion.TLS_1_3}


class RelayTls(BaseModel):
    """Files for TLS with one relay (PEM or DER). crl: revoked certificates, of the authorities in ca.

    version: the one that is offered.  port: for TLS, where it is not the port of the SCD.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    certificate: AbsolutePath
    key: AbsolutePath
    pinned: tuple[AbsolutePath, ...] = Field(min_length=1)
    ca: AbsolutePath | None = None
    crl: AbsolutePath | None = None
    version: Literal["1.2", "1.3"] = "1.2"
    port: int | None = Field(default=None, ge=1, le=65535)

    def configuration(self) -> TlsConfiguration:
        return TlsConfiguration(
            certificate=self.certificate,
            key=self.key,
            pinned=self.pinned,
            ca=self.ca,
            crl=self.crl,
            version=_VERSIONS[self.version],
        )


class RelayAccess(BaseModel):
    """One relay's table of the setting `relays`."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    tls: RelayTls | None = None
    password_file: AbsolutePath | None = None


class AccessError(ValueError):
    """A password in the environment cannot be used. The message does not show it."""


@dataclass(frozen=True, slots=True)
class Credentials:
    """What is shown to a relay in one connect."""

    tls: TlsConfiguration | None
    password: SecretStr | None

    @property
    def spoken_password(self) -> str | None:
        """The password in clear. Hand it on at once and keep it nowhere."""
        return None if self.password is None else self.password.get_secret_value()


def credentials(relays: Mapping[str, RelayAccess], name: str) -> Credentials:
    """Return what the settings and the environment have for the relay `name`; nothing if they do not name it.

    Raises CredentialFileError, AccessError.
    """
    access = relays.get(name, RelayAccess())
    return Credentials(
        tls=None if access.tls is None else access.tls.configuration(), password=_password(access, name)
    )


def clear_passwords(relays: Mapping[str, RelayAccess], names: Iterable[str]) -> tuple[str, ...]:
    """Return the relays whose password is sent without TLS, so that others on the network can read it."""
    found = []
    for name in names:
        access = relays.get(name, RelayAccess())
        given = access.password_file is not None or f"{PASSWORD_VARIABLE}{name}" in VARIABLES
        if given and access.tls is None:
            found.append(name)
    return tuple(found)


def named_in_environment() -> tuple[str, ...]:
    """Return the relays whose password is in the environment."""
    return tuple(
        variable.removeprefix(PASSWORD_VARIABLE)
        for variable in VARIABLES
        if variable.startswith(PASSWORD_VARIABLE)
    )


def _password(access: RelayAccess, name: str) -> SecretStr | None:
    variable = f"{PASSWORD_VARIABLE}{name}"
    spoken = VARIABLES.get(variable)
    if spoken is not None:
        if not is_password(spoken):
            raise AccessError(f"environment: {variable}: expected {PASSWORD_RULE}, found something else")
        return SecretStr(spoken)
    if access.password_file is None:
        return None
    content = read_secret(access.password_file).decode("latin-1").removesuffix("\n").removesuffix("\r")
    if not is_password(content):
        raise CredentialFileError(access.password_file, f"{PASSWORD_RULE} on its one line", "something else")
    return SecretStr(content)
