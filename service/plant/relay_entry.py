"""A [[relay]] table of the motors file: where a relay is, its SCL file, and the time zone of its clock."""

import re
from dataclasses import dataclass
from enum import StrEnum
from ipaddress import ip_address
from pathlib import Path

from scl.configuration import HOST_NAME
from service.configuration.time_zones import is_time_zone, nearest_time_zone
from service.plant.tables import PlantTable

MOST_PORT = 65_535

RELAY_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]{0,63}")
"""Relays are named in addresses of the REST API, in variables of the environment and in file names."""


class Reading(StrEnum):
    """How the recordings of a relay are read.

    STRICT: what contradicts itself is refused.
    LENIENT: what can be mended without a guess at values is mended, and told with each diagnosis.
    """

    STRICT = "strict"
    LENIENT = "lenient"


@dataclass(frozen=True, slots=True)
class RelayEntry:
    """What the file says of one relay; None where it says nothing.

    scl: its CID, IID or ICD.
    time_zone: IANA name of the zone in which its clock runs; None for UTC.
    reading: how its recordings are read.
    """

    name: str
    site: str | None = None
    host: str | None = None
    port: int | None = None
    scl: Path | None = None
    time_zone: str | None = None
    manufacturer: str | None = None
    type: str | None = None
    reading: Reading = Reading.STRICT


def relay_entry(table: PlantTable, name: str) -> RelayEntry:
    """Read the table. Relative paths in it start at the folder of its file."""
    if not RELAY_NAME.fullmatch(name):
        table.refuse("name", "at most 64 letters, digits, '_', '-' or '.', a letter or digit first", name)
    scl = table.text("scl", "the path of the relay's CID, IID or ICD file")
    entry = RelayEntry(
        name,
        site=table.text("site", "the name of the site where the relay is"),
        host=_host(table),
        port=_port(table),
        scl=None if scl is None else table.path.absolute().parent / scl,
        time_zone=_time_zone(table),
        manufacturer=table.text("manufacturer", "the name of the relay's manufacturer"),
        type=table.text("type", "the relay's type"),
        reading=_reading(table),
    )
    table.end()
    return entry


def _reading(table: PlantTable) -> Reading:
    value = table.take("reading")
    if value is None:
        return Reading.STRICT
    try:
        return Reading(str(value))
    except ValueError:
        table.refuse("reading", " or ".join(f'"{word}"' for word in Reading), value)
        return Reading.STRICT


def _host(table: PlantTable) -> str | None:
    expected = "an IP address or a host name"
    host = table.text("host", expected)
    if host is None or is_host(host):
        return host
    table.refuse("host", expected, host)
    return None


def is_host(host: str) -> bool:
    """Tell whether a text is an IP address or a host name."""
    try:
        ip_address(host)
    except ValueError:
        return HOST_NAME.fullmatch(host) is not None and not host.replace(".", "").isdecimal()
    return True


def _port(table: PlantTable) -> int | None:
    port = table.take("port")
    if isinstance(port, int) and not isinstance(port, bool) and 1 <= port <= MOST_PORT:
        return port
    if port is not None:
        table.refuse("port", f"a port from 1 to {MOST_PORT}", port)
    return None


def _time_zone(table: PlantTable) -> str | None:
    expected = 'an IANA time zone such as "Europe/Berlin", or "UTC"'
    name = table.text("time_zone", expected)
    if name is None or is_time_zone(name):
        return name
    table.refuse("time_zone", expected, name, nearest_time_zone(name))
    return None
