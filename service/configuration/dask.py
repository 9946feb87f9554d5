"""The table [dask]: certificates for the scheduler of a Dask cluster, and which addresses need them."""

import ipaddress
from typing import Final
from urllib.parse import urlsplit

from pydantic import BaseModel, ConfigDict

from mms import CredentialFileError, read_certificates, read_secret
from service.configuration.relay_access import AbsolutePath

EXAMPLE: Final = "tls://scheduler.plant.example:8786"


class DaskTls(BaseModel):
    """Files for TLS with a scheduler (PEM): our certificate and key, and who signs all of the cluster's."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    ca: AbsolutePath
    certificate: AbsolutePath
    key: AbsolutePath


class SchedulerAddressError(ValueError):
    """A scheduler cannot be used at this address, or not with these settings; it says what to do."""


def require_guarded(address: str, tls: DaskTls | None) -> None:
    """Raise SchedulerAddressError where others could listen to a scheduler or take its place."""
    try:
        parts = urlsplit(address)
        host, port = parts.hostname, parts.port
    except ValueError as error:
        raise SchedulerAddressError(f"expected tls://HOST:PORT, found {address}: {error}") from error
    if parts.scheme not in {"tcp", "tls"} or not host or port is None or parts.path or "@" in parts.netloc:
        raise SchedulerAddressError(
            f"expected {EXAMPLE}, or tcp://127.0.0.1:8786 on this host, found {address}"
        )
    if parts.scheme == "tcp":
        if not _is_loopback(host):
            raise SchedulerAddressError(
                f"expected tls:// for a scheduler beyond this host, found {address}: start scheduler and "
                "workers with --tls-ca-file, --tls-cert and --tls-key, and write the table [dask] with ca, "
                "certificate and key into the settings"
            )
        return
    if tls is None:
        raise SchedulerAddressError(
            f"{address}: expected the table [dask] with ca, certificate and key in the settings, found none"
        )
    try:
        read_secret(tls.key)  # refused where others may use it
        for file in (tls.ca, tls.certificate):
            read_certificates(file)
    except CredentialFileError as error:
        raise SchedulerAddressError(f"dask: {error}") from error


def _is_loopback(host: str) -> bool:
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"
