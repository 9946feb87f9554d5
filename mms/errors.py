# ruff: noqa: N818 (these names are what went wrong, in the words of the field)
"""Errors of the MMS layer: what failed, at which relay, why, and the service code behind it.

Service errors are those of ISO 9506-2 as IEC 61850-8-1 maps them. The numbers kept in `code` are
libiec61850's.
"""

from pathlib import Path


class MmsError(Exception):
    """An MMS service did not do what was asked.

    Parameters
    ----------
    host : str
        The peer as "address:port".
    operation : str
        The service and its object.
    code : int
        The library's error number; 0 where the failure was found on our side.
    message : str
        The reason in words.
    """

    def __init__(self, host: str, operation: str, code: int, message: str) -> None:
        super().__init__(host, operation, code, message)
        self.host = host
        self.operation = operation
        self.code = code
        self.message = message

    def __str__(self) -> str:
        return f"{self.host}: {self.operation}: {self.message}"


class ConnectFailed(MmsError):
    """No association came about: name unknown, port refused, no answer, or no session left in the relay."""


class RelayNotTrusted(ConnectFailed):
    """The relay's certificate is not a pinned one, of no known authority, expired or revoked."""


class CertificateRefused(ConnectFailed):
    """The relay speaks TLS and ended the handshake: it does not accept our certificate."""


class TlsNotSpoken(ConnectFailed):
    """TLS is configured for the relay, and it answers without TLS."""


class TlsRequired(ConnectFailed):
    """No TLS is configured for the relay, and it speaks nothing else there."""


class AssociationRejected(ConnectFailed):
    """The relay answers and rejects the association (ACSE): the password is wrong or missing."""


class ConnectionLost(MmsError):
    """The association ended; this client can make no more requests."""


class Timeout(MmsError):
    """The peer did not answer in time. The TCP connection may still stand: a frozen relay looks like this."""


class AccessDenied(MmsError):
    """The peer refuses this access."""


class NotFound(MmsError):
    """The peer has no such object or file."""


class TemporarilyUnavailable(MmsError):
    """The object or file is busy; a later attempt may succeed."""


class ServiceFailed(MmsError):
    """The peer answers that it cannot carry out this request (ISO 9506-2, ServiceError).

    The answer is a proper one: the link is in order, and other requests are not affected.
    """


class ValueRefused(ServiceFailed):
    """The peer answers that it gives or takes no value of this one object.

    The cause may be a hardware fault or a type that does not fit (ISO 9506-2, DataAccessError). Other objects
    are not affected.
    """


class ProtocolError(MmsError):
    """The peer answered with something the service does not allow, or rejected the request."""


class RequestRejected(ProtocolError):
    """The peer rejects the request (ISO 9506-2, Reject): it knows no such service or form of it."""


class ControlRefused(MmsError):
    """The relay refused to select, operate or complete a control.

    Parameters
    ----------
    host : str
        The peer as "address:port".
    operation : str
        The service and its object.
    code : int
        The library's error number.
    message : str
        The reason in words.
    add_cause : str
        The relay's add cause in words.

    References
    ----------
    IEC 61850-7-2, AddCause of the control class model.
    """

    def __init__(self, host: str, operation: str, code: int, message: str, add_cause: str) -> None:
        super().__init__(host, operation, code, message)
        self.args = (host, operation, code, message, add_cause)
        self.add_cause = add_cause


class ReportControlInUse(MmsError):
    """The report control block is reserved or enabled by another client; a block serves one client."""


class EntryNotFound(MmsError):
    """The relay no longer holds the report entry asked for: reports were lost; start from the present."""


class FileSizeMismatch(MmsError):
    """A transfer ended with another number of bytes than announced.

    Parameters
    ----------
    host : str
        The peer as "address:port".
    operation : str
        The service and its object.
    code : int
        The library's error number.
    message : str
        The reason in words.
    expected : int
        Number of bytes announced.
    received : int
        Number of bytes received.
    """

    def __init__(
        self, host: str, operation: str, code: int, message: str, expected: int, received: int
    ) -> None:
        super().__init__(host, operation, code, message)
        self.args = (host, operation, code, message, expected, received)
        self.expected = expected
        self.received = received


class ServerStartFailed(MmsError):
    """The server cannot listen on its address and port."""


class AssociationBroken(ConnectFailed, ProtocolError):
    """The relay associates, and answers the first request with something the service does not allow."""


class CredentialFileError(ValueError):
    """A file with a certificate, a key or a password cannot be used.

    Parameters
    ----------
    path : pathlib.Path
        The file.
    expected : str
        What the file should be.
    found : str
        What it is; never its content.
    """

    def __init__(self, path: Path, expected: str, found: str) -> None:
        super().__init__(path, expected, found)
        self.path = path
        self.expected = expected
        self.found = found

    def __str__(self) -> str:
        return f"{self.path}: expected {self.expected}, found {self.found}"


class ModelError(ValueError):
    """A data model text, a reference into it, or a value for one of its attributes is wrong.

    Parameters
    ----------
    where : str
        The line or the reference.
    expected : str
        What should be there.
    found : str
        What is there.
    """

    def __init__(self, where: str, expected: str, found: str) -> None:
        super().__init__(where, expected, found)
        self.where = where
        self.expected = expected
        self.found = found

    def __str__(self) -> str:
        return f"{self.where}: expected {self.expected}, found {self.found}"


_CLIENT_ERRORS: dict[int, tuple[type[MmsError], str]] = {
    1: (ConnectionLost, "not connected"),
    2: (ProtocolError, "already connected"),
    3: (ConnectionLost, "the connection was lost"),
    4: (RequestRejected, "service not supported"),
    5: (ConnectFailed, "the connection was rejected"),
    6: (ServiceFailed, "too many outstanding requests"),
    11: (ProtocolError, "data set mismatch"),
    12: (NotFound, "no object of this reference"),
    13: (ProtocolError, "a value of an unexpected type was received"),
    20: (Timeout, "no answer in time"),
    21: (AccessDenied, "access denied"),
    22: (NotFound, "no such object"),
    23: (ServiceFailed, "the object exists already"),
    24: (AccessDenied, "this kind of access is not supported"),
    25: (ValueRefused, "type inconsistent"),
    26: (TemporarilyUnavailable, "temporarily unavailable"),
    27: (NotFound, "the object is not defined"),
    28: (NotFound, "invalid address"),
    29: (ValueRefused, "hardware fault"),
    30: (ValueRefused, "the data type is not supported"),
    31: (ValueRefused, "the object's attributes are inconsistent"),
    32: (ValueRefused, "the value is invalid"),
    33: (NotFound, "the object was invalidated"),
    34: (ProtocolError, "malformed message"),
    35: (ServiceFailed, "object constraint conflict"),
    98: (RequestRejected, "service not implemented"),
}

_MMS_ERRORS: dict[int, tuple[type[MmsError], str]] = {
    1: (ConnectFailed, "the connection was rejected"),
    2: (ConnectionLost, "the connection was lost"),
    3: (Timeout, "no answer in time"),
    4: (ProtocolError, "malformed message"),
    5: (ValueRefused, "hardware fault"),
    6: (ProtocolError, "the end of the association was rejected"),
    7: (ProtocolError, "invalid arguments"),
    8: (ServiceFailed, "too many outstanding requests"),
    10: (TemporarilyUnavailable, "the relay is not in a state for this"),
    31: (NotFound, "invalid address"),
    32: (ValueRefused, "the data type is not supported"),
    33: (ValueRefused, "type inconsistent"),
    34: (NotFound, "the object is not defined"),
    36: (ValueRefused, "the object's attributes are inconsistent"),
    40: (TemporarilyUnavailable, "the relay is busy: its resources are used up"),
    60: (TemporarilyUnavailable, "the service was preempted"),
    81: (NotFound, "no such object"),
    82: (AccessDenied, "this kind of access is not supported"),
    83: (AccessDenied, "access denied"),
    84: (NotFound, "the object was invalidated"),
    85: (ValueRefused, "the value is invalid"),
    86: (TemporarilyUnavailable, "temporarily unavailable"),
    92: (TemporarilyUnavailable, "the file is busy"),
    93: (NotFound, "not a file name"),
    96: (AccessDenied, "file access denied"),
    97: (NotFound, "no such file"),
    100: (RequestRejected, "the request was rejected"),
    101: (RequestRejected, "the request was rejected: unknown kind of PDU"),
    102: (RequestRejected, "the request was rejected: invalid PDU"),
    103: (RequestRejected, "service not supported"),
    104: (RequestRejected, "the request was rejected: modifier not supported"),
    105: (RequestRejected, "the request was rejected: invalid argument"),
}

_OF_FILES: dict[int, tuple[type[MmsError], str]] = {
    5: (ServiceFailed, "hardware fault"),
    40: (TemporarilyUnavailable, "the file is busy, or too many files are open"),
    81: (NotFound, "no such file"),
    84: (ServiceFailed, "the file was invalidated"),
    **dict.fromkeys((31, 32, 33, 34, 36, 85), (ServiceFailed, "the file service failed")),
}

_HARDWARE_FAULT = 5
_SERVICE_ERRORS = range(9, 100)
"""MmsError numbers of the relay's ServiceErrors. Higher ones are rejects, lower ones are of our side."""


def client_error(host: str, operation: str, code: int) -> MmsError:
    """Make the error for a number of the library's client functions.

    These functions give one number (99) for every ServiceError without a number of its own and for a Reject.
    The client uses functions that pass on the MmsError (`mms_error`) wherever there are such.

    Parameters
    ----------
    host : str
        The peer as "address:port".
    operation : str
        The service and its object.
    code : int
        The library's IedClientError.

    Returns
    -------
    MmsError
        The kind of error that belongs to the number.
    """
    kind, message = _CLIENT_ERRORS.get(code, (ServiceFailed, f"the service failed (client error {code})"))
    return kind(host, operation, code, message)


def mms_error(host: str, operation: str, code: int) -> MmsError:
    """Make the error for a number of the library's MMS services.

    Parameters
    ----------
    host : str
        The peer as "address:port".
    operation : str
        The service and its object.
    code : int
        The library's MmsError.

    Returns
    -------
    MmsError
        The kind of error that belongs to the number.

    References
    ----------
    ISO 9506-2, ServiceError and Reject.
    """
    other = ServiceFailed if code in _SERVICE_ERRORS else ProtocolError
    kind, message = _MMS_ERRORS.get(code, (other, f"the service failed (MMS error {code})"))
    return kind(host, operation, code, message)


def file_error(host: str, operation: str, code: int) -> MmsError:
    """Make the error for a number of the library's file services.

    Parameters
    ----------
    host : str
        The peer as "address:port".
    operation : str
        The service and its object.
    code : int
        The library's MmsError.

    Returns
    -------
    MmsError
        The kind of error that belongs to the number. Errors that speak of a value speak of the file here.

    References
    ----------
    ISO 9506-2, ServiceError.
    """
    if code in _OF_FILES:
        kind, message = _OF_FILES[code]
        return kind(host, operation, code, message)
    return mms_error(host, operation, code)


def is_answered(code: int) -> bool:
    """Tell whether the peer carried out the request, or answered properly that it cannot.

    Parameters
    ----------
    code : int
        The library's MmsError.

    Returns
    -------
    bool
        False for a lost connection, no answer, a malformed answer and a reject.

    References
    ----------
    ISO 9506-2, ServiceError.
    """
    return code in (0, _HARDWARE_FAULT) or code in _SERVICE_ERRORS
