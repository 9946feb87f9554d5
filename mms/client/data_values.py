"""Reading of data (IEC 61850-7-2 GetDataValues and GetDataSetValues)."""

import re
from dataclasses import dataclass
from typing import Final

from mms import errors
from mms.binding.value_conversion import decode
from mms.client.connection import Connection
from mms.references import FunctionalConstraint, object_reference, variable_name
from mms.values import DataAccessError, Value

_ACCESS_ERRORS: Final[dict[DataAccessError, type[errors.MmsError]]] = {
    DataAccessError.ACCESS_DENIED: errors.AccessDenied,
    DataAccessError.ACCESS_UNSUPPORTED: errors.AccessDenied,
    DataAccessError.TEMPORARILY_UNAVAILABLE: errors.TemporarilyUnavailable,
    DataAccessError.OBJECT_INVALIDATED: errors.NotFound,
    DataAccessError.UNDEFINED: errors.NotFound,
    DataAccessError.NON_EXISTENT: errors.NotFound,
}
_ARRAY_ELEMENT: Final = re.compile(rb"([^(]+)\(([0-9]+)\)(?:\$(.+))?")


@dataclass(frozen=True, slots=True)
class DataSetMember:
    """One member of a data set and its value.

    Parameters
    ----------
    reference : str
        Reference of the member, "LD/LN.DO.DA[FC]".
    value : Value
        The member's value; a DataAccessError where the relay gave none.
    """

    reference: str
    value: Value


def read_value(connection: Connection, reference: str, constraint: FunctionalConstraint) -> Value:
    """Read a data object or attribute.

    Parameters
    ----------
    connection : Connection
        The association with the relay.
    reference : str
        Reference "LD/LN.DO" or "LD/LN.DO.DA".
    constraint : FunctionalConstraint
        Functional constraint of what is read.

    Returns
    -------
    Value
        The value. A structure is a tuple in the order of the model.

    Raises
    ------
    AccessDenied, NotFound, TemporarilyUnavailable, ServiceFailed
        The relay answers that it gives no value.
    ProtocolError
        The relay answers with something that is no value.
    """
    operation = f"read {reference}[{constraint.name}]"
    lib = connection.lib
    pointer = request_value(connection, operation, reference, constraint)
    try:
        value = _decode(connection, operation, pointer)
    finally:
        lib.MmsValue_delete(pointer)
    if isinstance(value, DataAccessError):
        kind = _ACCESS_ERRORS.get(value, errors.ValueRefused)
        raise kind(connection.host, operation, value.value, value.name.lower().replace("_", " "))
    return value


def read_data_set(
    connection: Connection, reference: str, members: tuple[str, ...]
) -> tuple[DataSetMember, ...]:
    """Read the values of all members of a data set in one request.

    Parameters
    ----------
    connection : Connection
        The association with the relay.
    reference : str
        Reference "LD/LN.name".
    members : tuple of str
        References of the members, from the directory of the data set.

    Returns
    -------
    tuple of DataSetMember
        The members in order. One that the relay cannot give has a DataAccessError for its value.

    Raises
    ------
    ProtocolError
        The values do not match the directory.
    """
    operation = f"read data set {reference}"
    lib = connection.lib
    domain, _, item = object_reference(reference, names=2).replace(b".", b"$").partition(b"/")
    specification_with_result = False
    pointer = connection.request(
        operation, lib.MmsConnection_readNamedVariableListValues, domain, item, specification_with_result
    )
    if pointer is None:
        raise errors.ProtocolError(connection.host, operation, 0, "no values came")
    try:
        values = _decode(connection, operation, pointer)
    finally:
        lib.MmsValue_delete(pointer)
    if not isinstance(values, tuple) or len(values) != len(members):
        raise errors.ProtocolError(
            connection.host, operation, 0, f"expected {len(members)} values, found {values!r:.80}"
        )
    return tuple(DataSetMember(name, value) for name, value in zip(members, values, strict=True))


def request_value(
    connection: Connection, operation: str, reference: str, constraint: FunctionalConstraint
) -> int | None:
    """Read a data object, an attribute or an element of an array "LD/LN.DO(3).DA".

    Parameters
    ----------
    connection : Connection
        The association with the relay.
    operation : str
        The service and its object, for messages.
    reference : str
        Reference of what is read.
    constraint : FunctionalConstraint
        Functional constraint of what is read.

    Returns
    -------
    int or None
        Pointer to the library's MmsValue, which the caller deletes.

    Raises
    ------
    MmsError
        The relay gave no answer that is a value.
    """
    lib = connection.lib
    domain, item = variable_name(reference, constraint)
    element = _ARRAY_ELEMENT.fullmatch(item)
    if element is None:
        return connection.request(operation, lib.MmsConnection_readVariable, domain, item)
    array, index, component = element.groups()
    return connection.request(
        operation, lib.MmsConnection_readSingleArrayElementWithComponent, domain, array, int(index), component
    )


def _decode(connection: Connection, operation: str, pointer: int | None) -> Value:
    try:
        return decode(connection.lib, pointer)
    except ValueError as error:
        raise errors.ProtocolError(connection.host, operation, 0, str(error)) from error
