"""Services that a server offers to its clients, and the library's server made with them."""

import ctypes
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from mms.errors import ModelError
from mms.references import FunctionalConstraint

MOST_CONNECTIONS: Final = 5
"""Most clients of one server: a limit compiled into the wheel's library."""

_DENY: Final = 1  # AccessPolicy
_OPTIONAL_FIELDS: Final = 16  # IEC61850_REPORTSETTINGS_OPT_FIELDS
_DATA_SET_MEMBERS: Final = 100


@dataclass(frozen=True, slots=True)
class Identity:
    """What a server answers to the Identify service (ISO 9506-2).

    Parameters
    ----------
    vendor : str
        Name of the vendor.
    model : str
        Name of the model.
    revision : str
        Revision of the firmware.
    """

    vendor: str
    model: str
    revision: str


@dataclass(frozen=True, slots=True)
class Services:
    """What clients may do at a server.

    Parameters
    ----------
    file_root : pathlib.Path or None
        Folder whose files are served. None for no file service.
    max_connections : int
        Most clients at once, up to MOST_CONNECTIONS.
    report_buffer_bytes : int
        Buffer of each report control block [byte].
    dynamic_data_sets : int
        Most data sets of a logical device, those of its model included, and of an association. Clients may
        create so many. 0 for no such service.
    optional_fields_writable : bool
        Whether clients may choose the optional fields of reports (OptFlds).

    Raises
    ------
    ValueError
        The number of connections is out of range.
    """

    file_root: Path | None = None
    max_connections: int = MOST_CONNECTIONS
    report_buffer_bytes: int = 65_536
    dynamic_data_sets: int = 0
    optional_fields_writable: bool = True

    def __post_init__(self) -> None:
        if not 0 < self.max_connections <= MOST_CONNECTIONS:
            raise ValueError(f"max_connections is {self.max_connections}: expected 1 to {MOST_CONNECTIONS}")


def create_server(lib: ctypes.CDLL, model: int, tls: int | None, services: Services) -> int:
    """Create the library's server. Writing services other than controls and control blocks are refused.

    Parameters
    ----------
    lib : ctypes.CDLL
        The library.
    model : int
        Pointer to the IedModel.
    tls : int or None
        Pointer to the TLSConfiguration, None without TLS.
    services : Services
        What clients may do.

    Returns
    -------
    int
        Pointer to the IedServer.

    Raises
    ------
    ModelError
        The library refuses the model.
    """
    off, on = False, True
    config = lib.IedServerConfig_create()
    lib.IedServerConfig_setMaxMmsConnections(config, services.max_connections)
    lib.IedServerConfig_setReportBufferSize(config, services.report_buffer_bytes)
    lib.IedServerConfig_setReportBufferSizeForURCBs(config, services.report_buffer_bytes)
    lib.IedServerConfig_setReportSetting(config, _OPTIONAL_FIELDS, services.optional_fields_writable)
    lib.IedServerConfig_enableFileService(config, services.file_root is not None)
    if services.file_root is not None:
        lib.IedServerConfig_setFileServiceBasePath(config, f"{services.file_root.resolve()}/".encode())
    lib.IedServerConfig_enableDynamicDataSetService(config, services.dynamic_data_sets > 0)
    lib.IedServerConfig_setMaxDomainSpecificDataSets(config, services.dynamic_data_sets)
    lib.IedServerConfig_setMaxAssociationSpecificDataSets(config, services.dynamic_data_sets)
    lib.IedServerConfig_setMaxDataSetEntries(config, _DATA_SET_MEMBERS)
    lib.IedServerConfig_enableLogService(config, on)  # log control blocks are listed; no logs are kept
    lib.IedServerConfig_useIntegratedGoosePublisher(config, off)
    server = lib.IedServer_createWithConfig(model, tls, config)
    lib.IedServerConfig_destroy(config)
    if not server:
        raise ModelError("the model text", "a model the MMS library can serve", "it refuses the model")
    for constraint in (FunctionalConstraint.SP, FunctionalConstraint.SV, FunctionalConstraint.SE):
        lib.IedServer_setWriteAccessPolicy(server, int(constraint), _DENY)
    return int(server)


def name_server(lib: ctypes.CDLL, server: int, address: str, identity: Identity | None) -> None:
    """Tell the library where a server listens, and what it answers to the Identify service.

    Parameters
    ----------
    lib : ctypes.CDLL
        The library.
    server : int
        Pointer to the IedServer.
    address : str
        IP address.
    identity : Identity or None
        The answer; None for the library's own.
    """
    lib.IedServer_setLocalIpAddress(server, address.encode("ascii"))
    if identity is not None:
        names = (identity.vendor, identity.model, identity.revision)
        lib.IedServer_setServerIdentity(server, *(name.encode("ascii", "replace") for name in names))
