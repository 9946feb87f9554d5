"""The table [gateways.modbus]."""

from ipaddress import IPv4Address, IPv4Network, IPv6Address, IPv6Network
from typing import Self

from pydantic import BaseModel, ConfigDict, Field, model_validator


class ModbusSettings(BaseModel):
    """The Modbus server. Modbus knows neither users nor encryption: it only reads, and clients are named.

    clients: networks that may connect; empty for all where it listens on loopback.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    bind_address: IPv4Address | IPv6Address = IPv4Address("127.0.0.1")
    port: int = Field(default=1502, ge=1, le=65_535)
    clients: tuple[IPv4Network | IPv6Network, ...] = ()
    max_connections: int = Field(default=32, ge=1, le=1000)
    idle_timeout_s: float = Field(default=60.0, ge=0.1, le=3600)

    @model_validator(mode="after")
    def _named_clients(self) -> Self:
        if not self.bind_address.is_loopback and not self.clients:
            raise ValueError("clients, where bind_address is not loopback: Modbus knows no passwords")
        return self

    def allows(self, address: IPv4Address | IPv6Address) -> bool:
        """Tell whether a client at this address may connect."""
        mapped = address.ipv4_mapped if isinstance(address, IPv6Address) else None
        return not self.clients or any((mapped or address) in network for network in self.clients)
