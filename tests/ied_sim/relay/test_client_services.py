"""Services of a relay that our own client does not use: Identify, and data sets that clients create."""

import ctypes
import queue
from collections.abc import Sequence
from pathlib import Path

import pytest

from mms import Client, MmsError, Report
from mms.binding.library import shared_library
from testing.relays.simulated import IED, scenario_of, simulated

OWN = f"{IED}Application/LLN0.OwnSet"
MEMBERS = (f"{IED}Mot1/TRIPPTRC1.Tr[ST]", f"{IED}Rec_FaultRecorder/MOTGGIO1.SPCSO03.stVal[ST]")
BLOCK = f"{IED}Application/LLN0.BR.BRep01"
_DATA_SET = 8  # RCB_ELEMENT_DATSET


class _Identity(ctypes.Structure):
    _fields_ = [("vendor", ctypes.c_char_p), ("model", ctypes.c_char_p), ("revision", ctypes.c_char_p)]


def library() -> ctypes.CDLL:
    """The library with the functions that only these tests use."""
    lib = ctypes.CDLL(str(shared_library()))
    pointer, error = ctypes.c_void_p, ctypes.POINTER(ctypes.c_int)
    for name, result, arguments in (
        ("IedConnection_getMmsConnection", pointer, [pointer]),
        ("MmsConnection_identify", ctypes.POINTER(_Identity), [pointer, error]),
        ("MmsServerIdentity_destroy", None, [ctypes.POINTER(_Identity)]),
        ("LinkedList_create", pointer, []),
        ("LinkedList_add", None, [pointer, pointer]),
        ("LinkedList_destroyStatic", None, [pointer]),
        ("IedConnection_createDataSet", None, [pointer, error, ctypes.c_char_p, pointer]),
        ("IedConnection_deleteDataSet", ctypes.c_bool, [pointer, error, ctypes.c_char_p]),
        ("IedConnection_getRCBValues", pointer, [pointer, error, ctypes.c_char_p, pointer]),
        ("ClientReportControlBlock_setDataSetReference", None, [pointer, ctypes.c_char_p]),
        ("ClientReportControlBlock_destroy", None, [pointer]),
        ("IedConnection_setRCBValues", None, [pointer, error, pointer, ctypes.c_uint32, ctypes.c_bool]),
    ):
        function = getattr(lib, name)
        function.restype, function.argtypes = result, arguments
    return lib


LIB = library()


def test_a_relay_identifies_itself(tmp_path: Path) -> None:
    with simulated(tmp_path, scenario_of("rdre")) as served, served.client() as client:
        error = ctypes.c_int(0)
        with client._connection.exclusive("identify") as connection:
            mms = LIB.IedConnection_getMmsConnection(connection)
            told = LIB.MmsConnection_identify(mms, ctypes.byref(error))
        found = told.contents
        assert (found.vendor, found.model, found.revision) == (
            b"StatorWatch",
            b"RDRE_RELAY",
            b"RDRE-SIM-V09.71",
        )
        LIB.MmsServerIdentity_destroy(told)


def test_a_client_creates_a_data_set_has_reports_of_it_and_deletes_it(tmp_path: Path) -> None:
    with simulated(tmp_path, scenario_of("rdre")) as served, served.client() as client:
        assert _create(client, OWN, MEMBERS) == 0
        members = client.read_data_set(OWN)
        assert tuple(each.reference for each in members) == MEMBERS
        assert members[1].value is False
        assert _report_on(client, OWN.replace(".", "$")) == 0
        reports: queue.SimpleQueue[Report] = queue.SimpleQueue()
        client.subscribe(BLOCK, reports)
        client.operate(served.reference("Rec_FaultRecorder/MOTGGIO1.SPCSO03"), value=True)
        report = reports.get(timeout=30)
        assert (report.data_set, report.members[0].index, report.members[0].value) == (
            OWN.replace(".", "$"),
            1,
            True,
        )
        client.unsubscribe(BLOCK)
        assert _report_on(client, f"{IED}Application/LLN0$DSet01") == 0
        assert _delete(client, OWN)
        with served.client() as another, pytest.raises(MmsError):
            another.read_data_set(OWN)


def test_a_relay_without_the_service_refuses_it(tmp_path: Path) -> None:
    with simulated(tmp_path, scenario_of("sel-710-ed2")) as served, served.client() as client:
        assert _create(client, f"{IED}CFG/LLN0.OwnSet", [f"{IED}CON/RBGGIO1.SPCSO01[ST]"]) != 0


def _create(client: Client, name: str, members: Sequence[str]) -> int:
    """Create a data set; return the error of the library, 0 for none."""
    listed, error = LIB.LinkedList_create(), ctypes.c_int(0)
    octets = [ctypes.create_string_buffer(member.encode()) for member in members]
    for each in octets:
        LIB.LinkedList_add(listed, ctypes.addressof(each))
    with client._connection.exclusive("create a data set") as connection:
        LIB.IedConnection_createDataSet(connection, ctypes.byref(error), name.encode(), listed)
    LIB.LinkedList_destroyStatic(listed)
    return error.value


def _delete(client: Client, name: str) -> bool:
    error = ctypes.c_int(0)
    with client._connection.exclusive("delete a data set") as connection:
        return bool(LIB.IedConnection_deleteDataSet(connection, ctypes.byref(error), name.encode()))


def _report_on(client: Client, data_set: str) -> int:
    """Let the block report a data set; return the error of the library, 0 for none."""
    error = ctypes.c_int(0)
    with client._connection.exclusive("set the data set") as connection:
        block = LIB.IedConnection_getRCBValues(connection, ctypes.byref(error), BLOCK.encode(), None)
        LIB.ClientReportControlBlock_setDataSetReference(block, data_set.encode())
        single_request = True
        LIB.IedConnection_setRCBValues(connection, ctypes.byref(error), block, _DATA_SET, single_request)
        LIB.ClientReportControlBlock_destroy(block)
    return error.value
