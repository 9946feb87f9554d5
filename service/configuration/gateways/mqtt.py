"""The table [gateways.mqtt]."""

from ipaddress import ip_address
from typing import Annotated, Literal, Self

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, StringConstraints, model_validator

from service.configuration.channels import Host, Port
from service.configuration.relay_access import AbsolutePath

PORT, TLS_PORT = 1883, 8883


def _prefix(text: str) -> str:
    levels = text.split("/")
    if text.startswith("$") or not all(levels) or any(not _is_plain(level) for level in levels):
        raise ValueError("levels of a topic such as plant/statorwatch, without +, #, $ and empty levels")
    return text


def _identifier(text: str) -> str:
    if not _is_plain(text) or "/" in text:
        raise ValueError("a name without /, + and #")
    return text


def _is_plain(level: str) -> bool:
    return level.isprintable() and not set(level) & {"+", "#"}


Identifier = Annotated[str, Field(min_length=1, max_length=100), AfterValidator(_identifier)]


class SparkplugSettings(BaseModel):
    """The Sparkplug edge node: its group, and its own name in it.

    primary_host: identifier of the host application without which it is not born; None for no such host.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    group: Identifier = "StatorWatch"
    edge_node: Identifier = "statorwatch"
    primary_host: Identifier | None = None


class MqttSettings(BaseModel):
    """The broker that is told. The password is in a file.

    tls: None for where the broker is not on loopback.  protocol: version of MQTT.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    host: Host = "127.0.0.1"
    port: Port | None = None
    tls: bool | None = None
    ca: AbsolutePath | None = None
    certificate: AbsolutePath | None = None
    key: AbsolutePath | None = None
    user: str | None = Field(default=None, min_length=1, max_length=200)
    password_file: AbsolutePath | None = None
    client_id: Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9_-]{1,60}$")] = "statorwatch"
    protocol: Literal["5", "3.1.1"] = "5"
    prefix: Annotated[str, Field(min_length=1, max_length=200), AfterValidator(_prefix)] = "statorwatch"
    keepalive_s: int = Field(default=30, ge=5, le=3600)
    timeout_s: float = Field(default=10.0, ge=0.1, le=300)
    sparkplug: SparkplugSettings | None = None

    @property
    def uses_tls(self) -> bool:
        """Tell whether the connection is encrypted."""
        return not self._is_loopback() if self.tls is None else self.tls

    @property
    def broker_port(self) -> int:
        """Return the port, which follows from `tls` where it is not given."""
        return self.port or (TLS_PORT if self.uses_tls else PORT)

    def _is_loopback(self) -> bool:
        try:
            return ip_address(self.host).is_loopback
        except ValueError:
            return self.host == "localhost"

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        if (self.certificate is None) != (self.key is None):
            raise ValueError("certificate and key together, found one alone")
        if not self.uses_tls and (self.certificate or self.ca):
            raise ValueError("ca, certificate and key only with tls")
        if self.password_file is not None and self.user is None:
            raise ValueError("user, where there is a password_file")
        if self.password_file is not None and not self.uses_tls and not self._is_loopback():
            raise ValueError("tls, where a password goes to another machine")
        return self
