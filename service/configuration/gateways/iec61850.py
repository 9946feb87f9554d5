"""The table [gateways.iec61850]."""

from ipaddress import IPv4Address
from typing import Annotated, Self

from pydantic import BaseModel, ConfigDict, Field, StringConstraints, model_validator

from mms import MOST_CONNECTIONS
from service.configuration.relay_access import AbsolutePath, RelayTls

IedName = Annotated[str, StringConstraints(pattern=r"^[A-Za-z][A-Za-z0-9_]*$", max_length=20)]


class Iec61850Settings(BaseModel):
    """The IEC 61850 server. It can only be read.

    ied_name: of the service as an IED.  tls: its certificate, and those of the clients.  password_file: the
    password that clients show.  open_to_all: listens beyond loopback without TLS.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    bind_address: IPv4Address = IPv4Address("127.0.0.1")
    port: int = Field(default=10102, ge=1, le=65_535)
    ied_name: IedName = "MCC"
    max_connections: int = Field(default=MOST_CONNECTIONS, ge=1, le=MOST_CONNECTIONS)
    report_buffer_bytes: int = Field(default=16_384, ge=1024, le=1_048_576)
    tls: RelayTls | None = None
    password_file: AbsolutePath | None = None
    open_to_all: bool = False

    @model_validator(mode="after")
    def _guarded(self) -> Self:
        if not (self.bind_address.is_loopback or self.tls is not None or self.open_to_all):
            raise ValueError("tls or open_to_all = true, where bind_address is not loopback")
        if self.tls is not None and self.tls.port is not None:
            raise ValueError("no tls.port: the server listens on port")
        return self
