"""Where a request comes from: its connection, or what a proxy of the settings says of it."""

from dataclasses import dataclass
from ipaddress import IPv4Address, IPv6Address, ip_address

from starlette.datastructures import Headers
from starlette.types import Scope

from service.configuration.access import ProxySettings

FORWARDING = ("forwarded", "x-forwarded-for", "x-forwarded-host", "x-forwarded-proto", "x-real-ip", "via")
"""A request with one of these has come through a proxy, whose machine is not that of who asks."""

IPV6_OF_A_CUSTOMER = 64


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
        hops = [_address(hop.strip()) for hop in ",".join(headers.getlist("x-forwarded-for")).split(",")]
        others = [hop for hop in hops if hop is not None and not _is_of(hop, proxy)]
        said = headers.getlist("x-forwarded-proto")
        encrypted = encrypted or (len(said) == 1 and said[0].strip().lower() == "https")
        return ClientAddress(
            str(others[-1] if others else peer),
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


def counted_address(address: str) -> str:
    """Return what failed logins are counted by: an IPv6 network of one customer counts as one address."""
    found = _address(address)
    if isinstance(found, IPv6Address):
        return str(IPv6Address(int(found) >> IPV6_OF_A_CUSTOMER << IPV6_OF_A_CUSTOMER)) + "/64"
    return address


def _address(text: str) -> IPv4Address | IPv6Address | None:
    try:
        found = ip_address(text)
    except ValueError:
        return None
    mapped = found.ipv4_mapped if isinstance(found, IPv6Address) else None
    return found if mapped is None else mapped


def _is_of(address: IPv4Address | IPv6Address, proxy: ProxySettings) -> bool:
    return any(address in network for network in proxy.addresses)
