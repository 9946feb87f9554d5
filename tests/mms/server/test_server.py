"""Building a server from model text, its data, and its life."""

import ctypes
import faulthandler
import threading
from pathlib import Path

import pytest

from mms import (
    BitString,
    Client,
    FunctionalConstraint,
    MmsError,
    ModelError,
    Quality,
    Server,
    ServerStartFailed,
    Timestamp,
    Value,
)
from testing.ports import LOOPBACK, free_port
from testing.relays.model import MODEL_TEXT
from testing.relays.serving import start_relay
from testing.waiting import eventually

ST = FunctionalConstraint.ST
TYPES = "T1PRO/GGIO1.Types"


def test_the_ied_name_can_be_replaced() -> None:
    with Server(MODEL_TEXT, port=free_port(), ied_name="B2_SEL710") as server:
        with Client.connect(LOOPBACK, server.port) as client:
            assert client.logical_devices() == ["B2_SEL710CON", "B2_SEL710PRO"]
        server.update("B2_SEL710PRO/GGIO1.Ind01.stVal", value=True)
        assert server.read("B2_SEL710PRO/GGIO1.Ind01.stVal") is True


@pytest.mark.parametrize(
    ("old", "new", "where", "message"),
    [
        ("LD(PRO){", "", "line 3", "inside MODEL"),
        ("}\n}\n}\n", "}\n", "line", "still open"),
        ("}\n}\n}\n", "}\n}\n}\n}\n", "line", "no more }"),
        ("DE(GGIO1$ST$Ind04);", "DE(GGIO1$ST$Ind05);", "line", "PRO/GGIO1\\$ST\\$Ind05"),
        ("DE(GGIO1$ST$Ind04);", "DE(GGIO1$MX$Ind04);", "line", "member that the model has"),
        ("0 DSet01 1 19", "0 DSet09 1 19", "line", r"PRO/LLN0\.DSet09"),
        ("RC(URep01 URep01 0 DSet01", "RC(URep01 URep01 DSet01", "line", "9 fields"),
        ('="Feeder 1"', '="Feeder "1""', "line", 'without " inside'),
        ('="Feeder 1"', f'="{"x" * 1100}"', "line", "at most 1022 octets"),
        ("DO(Ind01 0){", f"DO({'I' * 62} 0){{", "line", "at most 64 characters"),
        ("DO(Ind01 0){", "DX(Ind01 0){", "line", "one of DO, DS"),
        ("DO(Ind01 0){", "DO(){", "line", "a name for DO"),
        ("DA(stVal 0 0 0 1 0)", "DA(stVal 0 0 77 1 0)", "line", "functional constraint"),
        ("DA(stVal 0 0 0 1 0)", "DA(stVal)", "line", "DA\\(name"),
        ("=7", "=seven", "line", "a number, or a string"),
    ],
)  # fmt: skip
def test_a_fault_in_the_model_text_is_found_with_its_line(
    old: str, new: str, where: str, message: str
) -> None:
    text = MODEL_TEXT.replace(old, new) if old != "}\n}\n}\n" else MODEL_TEXT.removesuffix(old) + new
    assert text != MODEL_TEXT
    with pytest.raises(ModelError, match=message) as fault:
        Server(text, port=free_port())
    assert fault.value.where.startswith(where)


def test_an_empty_text_is_no_model() -> None:
    with pytest.raises(ModelError, match="no data attribute"):
        Server("", port=free_port())


def test_models_may_be_built_by_several_threads_at_once() -> None:
    """The library's parser is not made for that."""
    servers: list[Server] = []
    threads = [
        threading.Thread(target=lambda: servers.append(Server(MODEL_TEXT, port=free_port())))
        for _ in range(8)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(servers) == 8
    for server in servers:
        assert server.read("T1PRO/GGIO1.NamPlt.d") == "Feeder 1"
        server.stop()


@pytest.mark.parametrize("port", [0, -1, 70000])
def test_the_port_must_be_chosen(port: int) -> None:
    with pytest.raises(ValueError, match="not a TCP port"):
        Server(MODEL_TEXT, port=port)


@pytest.mark.parametrize("max_connections", [0, 6])
def test_more_clients_than_the_library_serves_are_not_promised(max_connections: int) -> None:
    with pytest.raises(ValueError, match="expected 1 to 5"):
        Server(MODEL_TEXT, port=free_port(), max_connections=max_connections)


def test_a_taken_port_is_named() -> None:
    with start_relay() as relay:
        second = Server(MODEL_TEXT, port=relay.port)
        with pytest.raises(ServerStartFailed, match=rf"127\.0\.0\.1:{relay.port}: start the server"):
            second.start()


def test_an_address_of_another_machine_is_named() -> None:
    server = Server(MODEL_TEXT, port=free_port(), address="192.0.2.1")
    with pytest.raises(ServerStartFailed, match=r"192\.0\.2\.1"):
        server.start()


def test_a_stopped_server_stays_stopped() -> None:
    server = start_relay()
    states = [server.is_running]
    server.stop()
    server.stop()
    assert [*states, server.is_running] == [True, False]
    assert server.connections == 0
    with pytest.raises(RuntimeError, match="is stopped"):
        server.update("T1PRO/GGIO1.Ind01.stVal", value=True)
    with pytest.raises(ServerStartFailed, match="stopped"):
        server.start()


def test_a_server_never_started_is_freed_without_harm() -> None:
    server = Server(MODEL_TEXT, port=free_port())
    assert not server.is_running
    server.stop()


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("bool", 1), ("int8", 128), ("int8", True), ("int16", -32769), ("int32", 1 << 31), ("int64", 1 << 63),
        ("int32", 1.5), ("uint8", 256), ("uint8", -1), ("uint16", 1 << 16), ("uint32", 1 << 32),
        ("uint32", False), ("float32", "1"), ("float32", True), ("float32", 1e300),
        ("quality", BitString((True,))), ("quality", 3),
        ("octets8", "text"), ("octets64", bytes(65)), ("visible32", "x" * 33), ("visible255", "é"),
        ("visible255", "a\0b"), ("visible255", b"x"), ("unicode255", "é" * 128), ("unicode255", "a\0"),
        ("unicode255", 1), ("time", 0), ("time", Timestamp(-1_000_000_000)), ("time", Timestamp(0, 256)),
        ("time", Timestamp((1 << 32) * 1_000_000_000)), ("entryTime", 5), ("bool", None),
    ],
)  # fmt: skip
def test_a_value_that_does_not_fit_changes_nothing(name: str, value: Value) -> None:
    server = Server(MODEL_TEXT, port=free_port())
    before = server.read(f"{TYPES}.{name}")
    with pytest.raises(ModelError, match=f"Types.{name}: expected"):
        server.update_many({"T1PRO/GGIO1.Ind01.stVal": True, f"{TYPES}.{name}": value})
    assert server.read(f"{TYPES}.{name}") == before
    assert server.read("T1PRO/GGIO1.Ind01.stVal") is False
    server.stop()


def test_a_structure_is_updated_by_its_elements() -> None:
    with start_relay() as server, Client.connect(LOOPBACK, server.port) as client:
        server.update("T1PRO/GGIO1.AnIn1.mag", (2.5,))
        assert client.read("T1PRO/GGIO1.AnIn1.mag.f", FunctionalConstraint.MX) == 2.5
        server.update("T1PRO/GGIO1.AnIn1.mag", (None,))
        assert server.read("T1PRO/GGIO1.AnIn1.mag") == (2.5,)
        with pytest.raises(ModelError, match="a tuple of 1 values"):
            server.update("T1PRO/GGIO1.AnIn1.mag", 2.5)


@pytest.mark.parametrize(
    "reference",
    ["", "T1PRO", "T1PRO/GGIO1", "T1PRO/GGIO1.Ind01", "T1PRO/GGIO1.Ind01.none", "T1PRO/GGIO1.Ind01.stVal.x",
     "T1PRO/" + "x" * 200, "T1PRO/é"],
)  # fmt: skip
def test_only_data_attributes_are_updated(relay: Server, reference: str) -> None:
    with pytest.raises(ModelError):
        relay.update(reference, value=True)


def test_clients_may_not_write_settings(relay: Server, client: Client) -> None:
    lib = client._connection.lib
    value = lib.MmsValue_newOctetString(4, 4)
    write = lib.IedConnection_writeObject
    write.argtypes = [
        ctypes.c_void_p,
        ctypes.POINTER(ctypes.c_int),
        ctypes.c_char_p,
        ctypes.c_int,
        ctypes.c_void_p,
    ]
    write.restype = None
    with pytest.raises(MmsError):
        client._connection.client_request("write", write, b"T1PRO/GGIO1.Setting.setVal", 2, value)
    lib.MmsValue_delete(value)
    assert relay.read("T1PRO/GGIO1.Setting.setVal") == 7


def test_connections_are_counted_and_limited(relay: Server) -> None:
    clients = [Client.connect(LOOPBACK, relay.port) for _ in range(5)]
    assert relay.connections == 5
    with pytest.raises(MmsError):
        Client.connect(LOOPBACK, relay.port, connect_timeout_s=0.5)
    for client in clients:
        client.close()
    assert eventually(lambda: relay.connections == 0)


def test_updates_from_many_threads_and_requests_do_not_disturb_each_other(
    relay: Server, client: Client
) -> None:
    def update(indication: int) -> None:
        for number in range(200):
            relay.update_many({
                f"T1PRO/GGIO1.Ind{indication:02d}.stVal": number % 2 == 0,
                f"T1PRO/GGIO1.Ind{indication:02d}.q": Quality(test=number % 2 == 1),
            })  # fmt: skip

    assert faulthandler.is_enabled()
    threads = [threading.Thread(target=update, args=(indication,)) for indication in range(1, 5)]
    for thread in threads:
        thread.start()
    while any(thread.is_alive() for thread in threads):
        for member in client.read_data_set("T1PRO/LLN0.DSet01"):
            assert isinstance(member.value, tuple)
            state, quality, _ = member.value
            assert isinstance(quality, BitString)
            assert (state is False) == Quality.of(quality).test or quality == Quality().bits
    for thread in threads:
        thread.join()


def test_the_file_root_may_be_anywhere(tmp_path: Path) -> None:
    root = tmp_path / "a folder" / "größe"
    root.mkdir(parents=True)
    (root / "X.CFG").write_bytes(b"1234")
    with start_relay(file_root=root) as relay, Client.connect(LOOPBACK, relay.port) as client:
        assert [entry.size for entry in client.files()] == [4]
