"""Members of a data set (IEC 61850-7-2 GetDataSetDirectory, ISO 9506-2 GetNamedVariableListAttributes).

The library's own client function for this follows a null pointer when a relay names a member without a
functional constraint.
"""

import ctypes
import re

from mms import errors
from mms.binding.linked_lists import elements
from mms.binding.prototypes import VariableAccessSpecification
from mms.client.connection import Connection
from mms.references import object_reference

_ITEM = re.compile(r"([^$]+)\$([A-Z]{2})\$([^$]+(?:\$[^$]+)*)")


def data_set_members(connection: Connection, reference: str) -> tuple[str, ...]:
    """List the members of a data set.

    Parameters
    ----------
    connection : Connection
        The association with the relay.
    reference : str
        Reference "LD/LN.name".

    Returns
    -------
    tuple of str
        References of the members, "LD/LN.DO.DA[FC]".

    Raises
    ------
    NotFound
        There is no such data set.
    ProtocolError
        The relay names a member that is none.
    """
    operation = f"directory of data set {reference}"
    lib = connection.lib
    domain, _, item = object_reference(reference, names=2).partition(b"/")
    deletable = ctypes.c_bool(False)  # noqa: FBT003 (a C cell)
    found = connection.request(
        operation,
        lib.MmsConnection_readNamedVariableListDirectory,
        domain,
        item.replace(b".", b"$"),
        ctypes.byref(deletable),
    )
    if found is None:
        raise errors.ProtocolError(connection.host, operation, 0, "no members came")
    try:
        members = tuple(_reference(data) for data in elements(lib, found))
    finally:
        for data in elements(lib, found):
            lib.MmsVariableAccessSpecification_destroy(data)
        lib.LinkedList_destroyStatic(found)
    for member, told in members:
        if member is None:
            raise errors.ProtocolError(
                connection.host, operation, 0, f"not a member of a data set: {told!r:.80}"
            )
    return tuple(member for member, _ in members if member is not None)


def _reference(data: int) -> tuple[str | None, bytes]:
    """Return a member's reference, None if it is none, and the item name as the relay sent it."""
    specification = VariableAccessSpecification.from_address(data)
    domain, item = specification.domain or b"", specification.item or b""
    match = _ITEM.fullmatch(item.decode("latin-1"))
    if match is None or not domain:
        return None, item
    node, constraint, names = match.groups()
    index = f"({specification.index})" if specification.index > -1 else ""
    component = specification.component
    part = "" if component is None else "." + component.decode("latin-1").replace("$", ".")
    return f"{domain.decode('latin-1')}/{node}.{names.replace('$', '.')}{index}{part}[{constraint}]", item
