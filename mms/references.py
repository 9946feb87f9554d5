"""Object references of IEC 61850-7-2 and the functional constraints, checked before they reach C.

The library copies names into buffers of the standard's sizes and relies on them to fit. A name may come from
a relay or a configuration file, so it is checked here first.
"""

import re
from enum import IntEnum
from typing import Final


class FunctionalConstraint(IntEnum):
    """Functional constraints of IEC 61850-7-2, with the library's numbers."""

    ST = 0
    MX = 1
    SP = 2
    SV = 3
    CF = 4
    DC = 5
    SG = 6
    SE = 7
    SR = 8
    OR = 9
    BL = 10
    EX = 11
    CO = 12
    US = 13
    MS = 14
    RP = 15
    BR = 16
    LG = 17
    GO = 18


_NAME_LIMIT: Final = 64  # an MMS domain or item name (IEC 61850-8-1 clause 8)
# ISO 9506 has no hyphens in names. Relays have: their engineers name devices and nodes.
_LOGICAL_DEVICE = re.compile(r"[A-Za-z0-9_-]{1,64}")
_OBJECT = re.compile(r"([A-Za-z0-9_-]{1,64})/([A-Za-z0-9_-]+(?:[.$][A-Za-z0-9_-]+|\([0-9]{1,5}\))*)")


def logical_device(name: str) -> bytes:
    """Encode the name of a logical device (MMS domain) for C.

    Parameters
    ----------
    name : str
        The name.

    Returns
    -------
    bytes
        The name in ASCII.

    Raises
    ------
    ValueError
        It is no such name.
    """
    if not _LOGICAL_DEVICE.fullmatch(name):
        raise ValueError(
            f"not a logical device name: {name!r} (letters, digits, _ and -, at most {_NAME_LIMIT})"
        )
    return name.encode("ascii")


def object_reference(reference: str, *, names: int = 1, room: int = len("$ST")) -> bytes:
    """Encode an object reference for C.

    Parameters
    ----------
    reference : str
        Reference "LD/LN.DO.DA".
    names : int
        Least number of names after the slash.
    room : int
        Number of characters that the service adds to the item name.

    Returns
    -------
    bytes
        The reference in ASCII.

    Raises
    ------
    ValueError
        It is no reference, or is too long or too short.

    References
    ----------
    IEC 61850-8-1 clause 8, lengths of MMS names.
    """
    match = _OBJECT.fullmatch(reference)
    if not match:
        raise ValueError(f'not an object reference: {reference!r} (expected "LD/LN.DO.DA")')
    item = match.group(2)
    longest = _NAME_LIMIT - room
    if len(item) > longest:
        raise ValueError(
            f"object reference too long: {reference!r} ({len(item)} > {longest} characters after the /)"
        )
    if len(re.split(r"[.$]", item)) < names:
        raise ValueError(f"object reference too short: {reference!r} (expected {names} names after the /)")
    return reference.encode("ascii")


def variable_name(reference: str, constraint: FunctionalConstraint) -> tuple[bytes, bytes]:
    """Name a data object or attribute as MMS does: its domain and its item "LN$FC$DO$DA".

    Parameters
    ----------
    reference : str
        Reference "LD/LN.DO.DA".
    constraint : FunctionalConstraint
        Functional constraint of what is named.

    Returns
    -------
    domain : bytes
        Name of the domain in ASCII.
    item : bytes
        Name of the item in ASCII.

    Raises
    ------
    ValueError
        It is no reference, or is too long.

    References
    ----------
    IEC 61850-8-1 clause 7.3, mapping of names.
    """
    domain, _, item = object_reference(reference).replace(b".", b"$").partition(b"/")
    node, _, names = item.partition(b"$")
    return domain, b"$".join((node, constraint.name.encode("ascii"), *filter(None, (names,))))
