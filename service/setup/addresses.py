"""Addresses of relays as people write them: HOST, HOST:PORT or [IPv6]:PORT."""

from service.plant.relay_entry import is_host


def is_address(text: str) -> bool:
    """Tell whether a text is an IP address or a host name, perhaps with a port."""
    host, port = _parts(text)
    return is_host(host) and (not port or (port.isdecimal() and 0 < int(port[:6]) < 65536))


def host_and_port(text: str) -> tuple[str, int | None]:
    """Return host and port of an address; None for a port that it does not have."""
    host, port = _parts(text)
    return host, int(port) if port else None


def _parts(text: str) -> tuple[str, str]:
    host, colon, port = text.rpartition(":")
    if not colon or ("]" not in host and ":" in host):
        host, port = text, ""
    return host.removeprefix("[").removesuffix("]"), port
