"""Thin, safe layer over libiec61850: MMS clients and servers, and the only package that touches C.

Client      one association with a relay: browse, read, operate, subscribe to reports, fetch files
Server      one simulated IED made from a model text
ServerPump  one thread that drives many servers
"""

from mms.binding.library import mbed_tls_version
from mms.binding.stderr_filter import filter_tls_log_from_stderr
from mms.client.client import Client
from mms.client.data_values import DataSetMember
from mms.client.files import FileEntry
from mms.client.limits import ClientLimits
from mms.client.reports import Reason, Report, ReportMember
from mms.control_model import AddCause, ControlModel
from mms.errors import (
    AccessDenied,
    AssociationBroken,
    AssociationRejected,
    CertificateRefused,
    ConnectFailed,
    ConnectionLost,
    ControlRefused,
    CredentialFileError,
    EntryNotFound,
    FileSizeMismatch,
    MmsError,
    ModelError,
    NotFound,
    ProtocolError,
    RelayNotTrusted,
    ReportControlInUse,
    RequestRejected,
    ServerStartFailed,
    ServiceFailed,
    TemporarilyUnavailable,
    Timeout,
    TlsNotSpoken,
    TlsRequired,
    ValueRefused,
)
from mms.references import FunctionalConstraint
from mms.security.credential_files import read_certificates, read_secret
from mms.security.passwords import PASSWORD_RULE, is_password
from mms.security.revocation import is_revoked, is_signed_by, parse_revocation_lists, without_revoked
from mms.security.tls import TlsConfiguration, TlsVersion
from mms.server.controls import ControlAction
from mms.server.file_access import FileAnswer, FileOperation, FileRequest
from mms.server.pump import ServerPump
from mms.server.server import Server
from mms.server.services import MOST_CONNECTIONS, Identity
from mms.values import GOOD, BitString, DataAccessError, Quality, Timestamp, Validity, Value

__all__ = [
    "GOOD",
    "MOST_CONNECTIONS",
    "PASSWORD_RULE",
    "AccessDenied",
    "AddCause",
    "AssociationBroken",
    "AssociationRejected",
    "BitString",
    "CertificateRefused",
    "Client",
    "ClientLimits",
    "ConnectFailed",
    "ConnectionLost",
    "ControlAction",
    "ControlModel",
    "ControlRefused",
    "CredentialFileError",
    "DataAccessError",
    "DataSetMember",
    "EntryNotFound",
    "FileAnswer",
    "FileEntry",
    "FileOperation",
    "FileRequest",
    "FileSizeMismatch",
    "FunctionalConstraint",
    "Identity",
    "MmsError",
    "ModelError",
    "NotFound",
    "ProtocolError",
    "Quality",
    "Reason",
    "RelayNotTrusted",
    "Report",
    "ReportControlInUse",
    "ReportMember",
    "RequestRejected",
    "Server",
    "ServerPump",
    "ServerStartFailed",
    "ServiceFailed",
    "TemporarilyUnavailable",
    "Timeout",
    "Timestamp",
    "TlsConfiguration",
    "TlsNotSpoken",
    "TlsRequired",
    "TlsVersion",
    "Validity",
    "Value",
    "ValueRefused",
    "filter_tls_log_from_stderr",
    "is_password",
    "is_revoked",
    "is_signed_by",
    "mbed_tls_version",
    "parse_revocation_lists",
    "read_certificates",
    "read_secret",
    "without_revoked",
]
