"""A thin, safe layer over libiec61850: MMS clients and servers, and the only place that touches C.

Client      one association with a relay: browse, read, operate, subscribe to reports, fetch files
Server      one simulated IED made from a model text
ServerPump  one thread that drives many servers
"""

from mms.client import Client, DataSetMember
from mms.controls import AddCause, ControlModel
from mms.errors import (
    AccessDenied,
    ConnectFailed,
    ConnectionLost,
    ControlRefused,
    EntryNotFound,
    FileSizeMismatch,
    MmsError,
    ModelError,
    NotFound,
    ProtocolError,
    ReportControlInUse,
    ServerStartFailed,
    TemporarilyUnavailable,
    Timeout,
)
from mms.file_access import FileAnswer, FileOperation, FileRequest
from mms.files import FileEntry
from mms.pump import ServerPump
from mms.references import FunctionalConstraint
from mms.reports import Reason, Report, ReportMember
from mms.server import MOST_CONNECTIONS, ControlAction, Server
from mms.values import GOOD, BitString, DataAccessError, Quality, Timestamp, Validity, Value

__all__ = [
    "GOOD",
    "MOST_CONNECTIONS",
    "AccessDenied",
    "AddCause",
    "BitString",
    "Client",
    "ConnectFailed",
    "ConnectionLost",
    "ControlAction",
    "ControlModel",
    "ControlRefused",
    "DataAccessError",
    "DataSetMember",
    "EntryNotFound",
    "FileAnswer",
    "FileEntry",
    "FileOperation",
    "FileRequest",
    "FileSizeMismatch",
    "FunctionalConstraint",
    "MmsError",
    "ModelError",
    "NotFound",
    "ProtocolError",
    "Quality",
    "Reason",
    "Report",
    "ReportControlInUse",
    "ReportMember",
    "Server",
    "ServerPump",
    "ServerStartFailed",
    "TemporarilyUnavailable",
    "Timeout",
    "Timestamp",
    "Validity",
    "Value",
]
