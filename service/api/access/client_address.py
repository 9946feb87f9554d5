"""Where a request comes from: its connection, or what a proxy of the settings says of it."""

from collections.abc import Sequence
from dataclasses import dataclass
from ipaddress import IPv4Address, IPv6Address, ip_address

from starlette.datastructures import Headers
from starlette.types import Scope

from service.configuration.access import ProxySettings

Address = IPv4Address | IPv6Address

FORWARDING = ("forwarded", "x-forwarded-for", "x-forwarded-host", "x-forwarded-proto", "x-real-ip", "via")
"""A request with one of these has come through a proxy, whose machine is not that of who asks."""


@dataclass(frozen=True, slots=True)
class ClientAddress:
    """address: of who asks. is_local: who asks is on this machine. is_named_proxy: its headers count."""

    address: str
    is_local: bool
    is_named_proxy: bool
    is_encrypted: bool


def client_address(scope: Scope, proxy: ProxySettings | None) -> ClientAddress:
    """Return where a request comes from."""
    headers = Headers(scope=scope)
    peer = _address(scope["client"][0]) if scope.get("client") else None
    encrypted = scope.get("scheme") == "https"
    if peer is not None and proxy is not None and _is_of(peer, proxy):
        said = headers.getlist("x-forwarded-proto")
        encrypted = encrypted or (len(said) == 1 and said[0].strip().lower() == "https")
        return ClientAddress(
            str(_farthest_known(peer, ",".join(headers.getlist("x-forwarded-for")).split(","), proxy)),
            is_local=False,
            is_named_proxy=True,
            is_encrypted=encrypted,
        )
    is_local = peer is not None and peer.is_loopback and not any(name in headers for name in FORWARDING)
    return ClientAddress(
        "" if peer is None else str(peer),
        is_local=is_local,
        is_named_proxy=False,
        is_encrypted=encrypted,
    )


def _farthest_known(peer: Address, hops: Sequence[str], proxy: ProxySettings) -> Address:
    """Return the first address before the named proxies, going back from the last hop.

    What stands before that, or before a hop that is no address, may be forged by who asks.
    """
    found = peer
    for hop in reversed(hops):
        before = _address(_without_port(hop.strip()))
        if before is None:
            break
        found = before
        if not _is_of(found, proxy):
            break
    return found


def _without_port(hop: str) -> str:
    """Return the address of a hop such as 192.0.2.1:5678 or [2001:db8::1]:443."""
    if hop.startswith("["):
        return hop[1:].partition("]")[0]
    return hop.partition(":")[0] if hop.count(":") == 1 else hop


def _address(text: str) -> Address | None:
    try:
        found = ip_address(text)
    except ValueError:
        return None
    mapped = found.ipv4_mapped if isinstance(found, IPv6Address) else None
    return found if mapped is None else mapped


def _is_of(address: Address, proxy: ProxySettings) -> bool:
    return any(address in network for network in proxy.addresses)
