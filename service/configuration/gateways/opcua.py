"""The table [gateways.opcua]."""

from ipaddress import IPv4Address
from typing import Self

from pydantic import BaseModel, ConfigDict, Field, model_validator

from service.configuration.relay_access import AbsolutePath


class OpcUaSettings(BaseModel):
    """The OPC UA server.

    certificate, key: its own; without them it makes some in the data directory.  trusted: folder with the
    certificates of clients; without it any certificate will do, and users show who they are.
    anonymous: whether clients may look without a user.  unencrypted: whether they may do without encryption.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    bind_address: IPv4Address = IPv4Address("127.0.0.1")
    port: int = Field(default=4840, ge=1, le=65_535)
    certificate: AbsolutePath | None = None
    key: AbsolutePath | None = None
    trusted: AbsolutePath | None = None
    anonymous: bool = False
    unencrypted: bool = False
    max_connections: int = Field(default=100, ge=1, le=1000)

    @model_validator(mode="after")
    def _agree(self) -> Self:
        if (self.certificate is None) != (self.key is None):
            raise ValueError("certificate and key together, or neither")
        if self.unencrypted and not self.bind_address.is_loopback:
            raise ValueError("unencrypted = false, where bind_address is not loopback")
        return self
