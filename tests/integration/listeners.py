"""Which addresses processes listen on, read from the kernel."""

from collections.abc import Iterable
from ipaddress import IPv4Address, IPv6Address
from pathlib import Path

LISTEN = "0A"


def listening_addresses(process_ids: Iterable[int]) -> list[IPv4Address | IPv6Address]:
    """Local addresses of the TCP sockets these processes listen on."""
    owned = {inode for process_id in process_ids for inode in _sockets(process_id)}
    found: list[IPv4Address | IPv6Address] = []
    for table in ("tcp", "tcp6"):
        for line in Path("/proc/net", table).read_text().splitlines()[1:]:
            fields = line.split()
            if fields[3] == LISTEN and fields[9] in owned:
                found.append(_address(fields[1].partition(":")[0]))
    return found


def _sockets(process_id: int) -> set[str]:
    """Inodes of a process's sockets."""
    inodes = set()
    for descriptor in Path(f"/proc/{process_id}/fd").iterdir():
        try:
            target = str(descriptor.readlink())
        except OSError:  # closed meanwhile
            continue
        if target.startswith("socket:["):
            inodes.add(target[len("socket:[") : -1])
    return inodes


def _address(words: str) -> IPv4Address | IPv6Address:
    """The kernel prints addresses as 32-bit words in the machine's byte order."""
    octets = b"".join(int(words[i : i + 8], 16).to_bytes(4, "little") for i in range(0, len(words), 8))
    return IPv4Address(octets) if len(octets) == 4 else IPv6Address(octets)
