"""The table [gateways.iec104]."""

from ipaddress import IPv4Address
from typing import Self

from pydantic import BaseModel, ConfigDict, Field, model_validator

from service.configuration.relay_access import AbsolutePath


class Iec104Tls(BaseModel):
    """Files for TLS (IEC 62351-3).

    pinned: certificates of the clients that may connect.  crl: those that are revoked, by an authority in ca.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    certificate: AbsolutePath
    key: AbsolutePath
    ca: AbsolutePath
    pinned: tuple[AbsolutePath, ...] = Field(min_length=1)
    crl: AbsolutePath | None = None


class Iec104Settings(BaseModel):
    """The IEC 60870-5-104 server. It monitors: no command does anything.

    common_address: of the station.  open_to_all: listens beyond loopback without TLS.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    bind_address: IPv4Address = IPv4Address("127.0.0.1")
    port: int = Field(default=2404, ge=1, le=65_535)
    common_address: int = Field(default=1, ge=1, le=65_534)
    max_connections: int = Field(default=10, ge=1, le=100)
    tls: Iec104Tls | None = None
    open_to_all: bool = False

    @model_validator(mode="after")
    def _guarded(self) -> Self:
        if not (self.bind_address.is_loopback or self.tls is not None or self.open_to_all):
            raise ValueError("tls or open_to_all = true, where bind_address is not loopback")
        return self
