"""Reading of data (IEC 61850-7-2 GetDataValues and GetDataSetValues)."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from mms import errors
from mms.binding.linked_lists import list_of_names
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
# A request of as many of the longest names fits into the smallest usual PDU of 8 kB.
_MOST_TOGETHER: Final = 64
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
        raise _refusal(connection, operation, value)
    return value


def read_together(
    connection: Connection, references: Sequence[str], constraint: FunctionalConstraint
) -> tuple[Value | errors.MmsError, ...]:
    """Read several data attributes of one logical device in one request.

    Parameters
    ----------
    connection : Connection
        The association with the relay.
    references : sequence of str
        References "LD/LN.DO.DA", all of one logical device, one at least.
    constraint : FunctionalConstraint
        Functional constraint of what is read.

    Returns
    -------
    tuple of Value or MmsError
        The values in order; the error, not raised, of each that the relay does not give.

    Raises
    ------
    MmsError
        The relay does not answer, or refuses the request as a whole.
    ProtocolError
        The relay answers with something else than so many values.
    ValueError
        The references are of several logical devices, or there are none, or more than 64.

    References
    ----------
    ISO 9506-2, Read with a listOfVariable.
    """
    names = [variable_name(reference, constraint) for reference in references]
    domains = sorted({domain for domain, _ in names})
    if len(domains) != 1:
        raise ValueError(f"expected references of one logical device, found those of {len(domains)}")
    if len(names) > _MOST_TOGETHER:
        raise ValueError(f"expected at most {_MOST_TOGETHER} references, found {len(names)}")
    operation = f"read {len(names)} values of {domains[0].decode('latin-1')}[{constraint.name}]"
    lib = connection.lib
    with list_of_names(lib, [item for _, item in names]) as items:
        pointer = connection.request(operation, lib.MmsConnection_readMultipleVariables, domains[0], items)
    try:
        values = _decode(connection, operation, pointer)
    finally:
        lib.MmsValue_delete(pointer)
    if not isinstance(values, tuple) or len(values) != len(names):
        raise errors.ProtocolError(
            connection.host, operation, 0, f"expected {len(names)} values, found {values!r:.80}"
        )
    return tuple(
        _refusal(connection, f"read {reference}[{constraint.name}]", value)
        if isinstance(value, DataAccessError)
        else value
        for reference, value in zip(references, values, strict=True)
    )


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


def _refusal(connection: Connection, operation: str, error: DataAccessError) -> errors.MmsError:
    kind = _ACCESS_ERRORS.get(error, errors.ValueRefused)
    return kind(connection.host, operation, error.value, error.name.lower().replace("_", " "))


def _decode(connection: Connection, operation: str, pointer: int | None) -> Value:
    try:
        return decode(connection.lib, pointer)
    except ValueError as error:
        raise errors.ProtocolError(connection.host, operation, 0, str(error)) from error
