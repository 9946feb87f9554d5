"""Clients that do not stand on libiec61850 see the motors' health at the service's own IED."""

import asyncio
import math
import os
import signal
import socket
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import replace
from functools import partial
from pathlib import Path

import iec61850
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from open61850 import data as open_data
from open61850 import mms as open_mms

from core.rotor.finding import RotorState
from mms import GOOD, Client, FunctionalConstraint, MmsError, Timestamp, Validity
from mms import Quality as MmsQuality
from mms.values import BitString
from service.configuration.gateways.iec61850 import Iec61850Settings
from service.gateways.iec61850.gateway import PlantIed
from service.gateways.iec61850.logical_devices import LONGEST, logical_devices
from service.gateways.plant_state.figures import PlantChange, PlantState
from service.gateways.plant_state.reading import read_plant_state
from service.recording_store.folder import FolderStore
from service.storage import Repository
from service.storage.states import LinkState
from testing.ports import LOOPBACK, free_port
from testing.service.conditions import DRIFTING, FAULT, HEALTHY, UNKNOWN, tell
from testing.service.gateways import running_gateways
from testing.service.job_runner import register_runner
from testing.service.links import set_link_state
from testing.service.plants import NOW_NS, SECOND_NS, two_motor_plant
from testing.service.rotor_and_supply import BROKEN_ROTOR, SUPPLY, ExaminedRecordings
from testing.waiting import eventually
from tests.service.gateways.settings import port_of, settings_of

PUMP, FAN = "MCCPUMP_A1", "MCCFAN_A2"
STATUS, MEASURED = FunctionalConstraint.ST, FunctionalConstraint.MX


@pytest.fixture
def port(repository: Repository, tmp_path: Path) -> Iterator[int]:
    chosen = settings_of("iec61850", tmp_path)
    with running_gateways(chosen):
        yield port_of(chosen)


@pytest.fixture
def client(port: int) -> Iterator[Client]:
    with Client.connect(LOOPBACK, port) as client:
        yield client


def quality(client: Client, reference: str, constraint: FunctionalConstraint = STATUS) -> MmsQuality:
    bits = client.read(f"{reference}.q", constraint)
    assert isinstance(bits, BitString)
    return MmsQuality.of(bits)


def test_a_fault_is_seen_with_its_phase_time_and_quality(repository: Repository, client: Client) -> None:
    assert quality(client, f"{PUMP}/ZMOT1.EEHealth").validity is Validity.INVALID
    unknown = client.read(f"{PUMP}/ZMOT1.EEHealth.t", STATUS)
    assert isinstance(unknown, Timestamp)
    assert unknown.clock_failure
    tell(repository, FAULT)
    assert eventually(lambda: client.read(f"{PUMP}/ZMOT1.EEHealth.stVal", STATUS) == 3)
    assert quality(client, f"{PUMP}/ZMOT1.EEHealth").validity is Validity.GOOD
    time = client.read(f"{PUMP}/ZMOT1.EEHealth.t", STATUS)
    assert isinstance(time, Timestamp)
    assert time.ns == pytest.approx(NOW_NS, abs=100)
    assert not time.clock_failure
    for name in ("GAPC1.Str", "GAPC1.Op"):
        phases = [client.read(f"{PUMP}/{name}.{one}", STATUS) for one in ("general", "phsA", "phsB", "phsC")]
        assert phases == [True, False, True, False]
    assert client.read(f"{PUMP}/GGIO1.AnIn1.mag.f", MEASURED) == pytest.approx(1.21)
    assert client.read(f"{PUMP}/GGIO1.AnIn3.mag.f", MEASURED) == pytest.approx(2.25)
    load = client.read(f"{PUMP}/GGIO1.AnIn5.mag.f", MEASURED)
    assert isinstance(load, float)
    assert math.isnan(load)
    assert quality(client, f"{PUMP}/GGIO1.AnIn5", MEASURED).validity is Validity.INVALID
    assert client.read(f"{PUMP}/LPHD1.Proxy.stVal", STATUS) is True
    assert client.read("MCCPLANT/CALH1.GrAlm.stVal", STATUS) is True


def test_the_unbalance_is_that_of_the_latest_record_and_old_where_a_later_one_has_none(
    repository: Repository, client: Client, tmp_path: Path
) -> None:
    register_runner(repository)
    examined = ExaminedRecordings(repository, FolderStore(tmp_path / "recordings"))
    examined.add(None, replace(SUPPLY, voltage_unbalance_iec=0.05), at_ns=NOW_NS - SECOND_NS)
    examined.add(None, replace(SUPPLY, current_unbalance=None), at_ns=NOW_NS)
    tell(repository, HEALTHY)
    voltage = f"{PUMP}/MSQI1.ImbNgV"
    assert eventually(lambda: client.read(f"{voltage}.mag.f", MEASURED) == pytest.approx(0.71))
    assert eventually(lambda: quality(client, voltage, MEASURED) == GOOD)
    time = client.read(f"{voltage}.t", MEASURED)
    assert isinstance(time, Timestamp)
    assert time.ns == pytest.approx(NOW_NS, abs=100)
    assert quality(client, f"{PUMP}/MSQI1.ImbNgA", MEASURED).validity is Validity.INVALID
    tell(repository, replace(HEALTHY, as_of_ns=NOW_NS + SECOND_NS), now_ns=NOW_NS + SECOND_NS)
    assert eventually(lambda: quality(client, voltage, MEASURED).old_data)


def test_a_relay_that_does_not_answer_is_no_good_physical_device(
    repository: Repository, client: Client
) -> None:
    set_link_state(repository, "A1_SEL710", LinkState.DOWN, now_ns=NOW_NS, reason="no answer")
    assert eventually(lambda: client.read(f"{PUMP}/LPHD1.PhyHealth.stVal", STATUS) == 3)
    assert client.read(f"{FAN}/LPHD1.PhyHealth.stVal", STATUS) == 2


def test_old_figures_are_questionable(repository: Repository, tmp_path: Path) -> None:
    tell(repository, HEALTHY)
    chosen = settings_of("iec61850", tmp_path).model_copy(update={"stale_after_days": 0.01})
    with running_gateways(chosen), Client.connect(LOOPBACK, port_of(chosen)) as client:
        found = quality(client, f"{PUMP}/ZMOT1.EEHealth")
        assert (found.validity, found.old_data) == (Validity.QUESTIONABLE, True)
        assert client.read(f"{PUMP}/ZMOT1.EEHealth.stVal", STATUS) == 2


def test_figures_that_records_do_not_tell_are_questionable_and_not_old(
    repository: Repository, client: Client
) -> None:
    tell(repository, replace(UNKNOWN, as_of_ns=NOW_NS))
    health, level = f"{PUMP}/ZMOT1.EEHealth", f"{PUMP}/GGIO1.AnIn1"
    assert eventually(lambda: quality(client, health) == MmsQuality(Validity.QUESTIONABLE))
    assert client.read(f"{health}.stVal", STATUS) == 2
    assert quality(client, level, MEASURED) == MmsQuality(Validity.INVALID)


def test_kind_rotor_and_warning_are_numbered_as_the_page_says(
    repository: Repository, client: Client, tmp_path: Path
) -> None:
    kind, rotor = f"{PUMP}/GGIO1.IntIn1.stVal", f"{PUMP}/GGIO1.IntIn2.stVal"
    warning, alarm = "MCCPLANT/CALH1.GrWrn.stVal", "MCCPLANT/CALH1.GrAlm.stVal"

    def is_told(reference: str, value: object) -> bool:
        return client.read(reference, STATUS) == value

    tell(repository, HEALTHY)
    tell(repository, replace(HEALTHY, motor="FAN-A2"))
    assert eventually(lambda: client.read(warning, STATUS) is False)
    assert [client.read(one, STATUS) for one in (kind, rotor, alarm)] == [0, 0, False]
    times = [warning.replace("stVal", "t"), alarm.replace("stVal", "t")]
    warned, alarmed = (client.read(one, STATUS) for one in times)
    tell(repository, DRIFTING)
    assert eventually(lambda: client.read(warning, STATUS) is True)
    assert [client.read(one, STATUS) for one in (kind, rotor, alarm)] == [8, 0, False]
    assert client.read(times[0], STATUS) != warned, "the time of a group is that of its own change"
    assert client.read(times[1], STATUS) == alarmed
    register_runner(repository)
    records = ExaminedRecordings(repository, FolderStore(tmp_path / "recordings"))
    for number, state, of_kind in ((1, RotorState.WATCH, 8), (2, RotorState.FAULT, 7)):
        for _ in range(3):
            records.add(replace(BROKEN_ROTOR, state=state))
        repository.settle_motor_condition("PUMP-A1", now_ns=NOW_NS)
        assert eventually(partial(is_told, rotor, number))
        assert client.read(kind, STATUS) == of_kind
    assert eventually(lambda: client.read(alarm, STATUS) is True)
    assert client.read(warning, STATUS) is False


def test_open61850_browses_and_reads(repository: Repository, port: int) -> None:
    tell(repository, HEALTHY)
    with open_mms.MmsClient.connect(LOOPBACK, port=port) as client:
        model = open_mms.discover(client)
        devices = {str(one).partition("/")[0] for one in model.references()}
        assert devices == {PUMP, FAN, "MCCPLANT"}
        assert eventually(lambda: client.read(f"{PUMP}/ZMOT1.EEHealth.stVal[ST]") == open_data.IntData(1))


def test_the_client_in_rust_reads_the_level(repository: Repository, port: int) -> None:
    tell(repository, FAULT)

    async def level() -> float:
        client = await iec61850.IedConnection.connect(f"{LOOPBACK}:{port}")
        try:
            return float(await client.read_float(f"{PUMP}/GGIO1.AnIn1.mag.f", iec61850.FC.MX))
        finally:
            await client.disconnect()

    assert eventually(lambda: asyncio.run(level()) == pytest.approx(1.21))


def test_nobody_writes(port: int) -> None:
    with open_mms.MmsClient.connect(LOOPBACK, port=port) as client:
        for name in ("GGIO1$MX$AnIn1$mag$f", "ZMOT1$ST$EEHealth$stVal"):
            value = client.read(
                f"{PUMP}/{name.replace('$MX', '').replace('$ST', '').replace('$', '.')}"
                f"[{'MX' if 'MX' in name else 'ST'}]"
            )
            with pytest.raises(open_mms.MmsError):
                client.write(open_mms.ObjectName(name, PUMP), value)


def test_a_hundred_silent_clients_keep_nobody_out(port: int) -> None:
    with ExitStack() as open_sockets:
        crowd = [
            open_sockets.enter_context(socket.create_connection((LOOPBACK, port), timeout=60))
            for _ in range(100)
        ]
        _wait_for_service(port)
        assert crowd[0].recv(1) == b"", "the first one has been sent away"


def test_clients_that_come_and_go_keep_nobody_out(port: int) -> None:
    for one in [socket.create_connection((LOOPBACK, port)) for _ in range(20)]:
        one.close()
    _wait_for_service(port)


def _wait_for_service(port: int) -> None:

    def is_served() -> bool:
        try:
            with Client.connect(LOOPBACK, port) as client:
                return client.read(f"{PUMP}/LPHD1.Proxy.stVal", STATUS) is True
        except MmsError:
            return False

    assert eventually(is_served, within_s=120)


@settings(max_examples=40, deadline=None)
@given(st.lists(st.binary(min_size=1, max_size=400), min_size=1, max_size=4))
def garbled_messages(port: int, messages: list[bytes]) -> None:
    """Bytes as they come, and as the contents of TPKT packets, which the stack takes apart."""
    for framed in (False, True):
        with socket.create_connection((LOOPBACK, port)) as link:
            for message in messages:
                head = b"\x03\x00" + (len(message) + 4).to_bytes(2, "big") if framed else b""
                with suppress(OSError):
                    link.sendall(head + message)
    with Client.connect(LOOPBACK, port) as client:
        assert client.read(f"{PUMP}/LPHD1.Proxy.stVal", FunctionalConstraint.ST) is True


def test_garbled_messages_bring_nothing_down(port: int) -> None:
    garbled_messages(port)


def test_a_gateway_that_is_killed_is_back_with_the_right_values(
    repository: Repository, tmp_path: Path
) -> None:
    tell(repository, HEALTHY)
    chosen = settings_of("iec61850", tmp_path)

    def health() -> object:
        try:
            with Client.connect(LOOPBACK, port_of(chosen)) as client:
                return client.read(f"{PUMP}/ZMOT1.EEHealth.stVal", STATUS)
        except MmsError:
            return None

    with running_gateways(chosen) as gateways:
        assert health() == 1
        first = gateways.status()[0].process_id
        assert first is not None
        os.kill(first, signal.SIGKILL)
        tell(repository, FAULT)
        assert eventually(lambda: health() == 3)


def test_a_motor_that_gets_another_relay_has_its_name_plate(repository: Repository, tmp_path: Path) -> None:
    plant = two_motor_plant()
    other = replace(plant.relays[1], manufacturer="ACME", type="M1")
    motors = [replace(one, relay=other.name) for one in plant.motors]
    before = read_plant_state(repository, now_ns=NOW_NS, stale_after_days=None)
    repository.sync_plant(replace(plant, relays=(plant.relays[0], other), motors=tuple(motors)))
    now = read_plant_state(repository, now_ns=NOW_NS, stale_after_days=None)
    settings = Iec61850Settings(port=free_port())
    with closing_ied(PlantIed(settings, tmp_path)) as ied:
        ied.tell(PlantChange(PlantState(), before))
        with Client.connect(LOOPBACK, settings.port) as client:
            plate = f"{PUMP}/LPHD1.PhyNam.vendor"
            assert client.read(plate, FunctionalConstraint.DC) == plant.relays[0].manufacturer
            ied.tell(PlantChange(before, now))
            assert client.read(plate, FunctionalConstraint.DC) == "ACME"


@contextmanager
def closing_ied(ied: PlantIed) -> Iterator[PlantIed]:
    try:
        yield ied
    finally:
        ied.stop()


def test_a_password_is_asked_for(repository: Repository, tmp_path: Path) -> None:
    secret = tmp_path / "password"
    secret.write_text("open sesame\n", encoding="ascii")
    secret.chmod(0o600)
    chosen = settings_of("iec61850", tmp_path, password_file=secret)
    with running_gateways(chosen):
        with pytest.raises(MmsError), Client.connect(LOOPBACK, port_of(chosen)):
            pass
        with Client.connect(LOOPBACK, port_of(chosen), password="open sesame") as client:  # noqa: S106
            assert client.read(f"{PUMP}/LPHD1.Proxy.stVal", STATUS) is True


def test_beyond_loopback_somebody_decides_who_may_read() -> None:
    with pytest.raises(ValueError, match="open_to_all"):
        Iec61850Settings.model_validate({"bind_address": "0.0.0.0"})  # noqa: S104 - refused
    with pytest.raises(ValueError, match="open_to_all"):  # a password alone can be read on its way
        Iec61850Settings.model_validate({"bind_address": "0.0.0.0", "password_file": "/etc/password"})  # noqa: S104
    assert Iec61850Settings.model_validate({"bind_address": "0.0.0.0", "open_to_all": True})  # noqa: S104


def test_names_of_logical_devices_are_those_of_motors_and_never_two_the_same() -> None:
    motors = ["PUMP-A1", "PUMP A1", "1-FAN", "Plant", "Лифт", "x" * 100, "x" * 101]
    found = logical_devices(motors)
    assert found["1-FAN"] == "M_1_FAN"
    assert len({device.upper() for device in found.values()} | {"PLANT"}) == len(motors) + 1
    assert all(len(device) <= LONGEST and device.isascii() for device in found.values())
    assert logical_devices(["PUMP-A1"]) == {"PUMP-A1": "PUMP_A1"}
    assert found == logical_devices(reversed(motors))


def test_texts_of_a_relay_cannot_break_the_model(repository: Repository, tmp_path: Path) -> None:
    hostile = 'SEL" <&> {\n} ' + "é" * 300
    plant = two_motor_plant()
    relays = tuple(replace(one, manufacturer=hostile) for one in plant.relays)
    repository.sync_plant(replace(plant, relays=relays))
    chosen = settings_of("iec61850", tmp_path)
    with running_gateways(chosen), Client.connect(LOOPBACK, port_of(chosen)) as client:
        vendor = client.read(f"{PUMP}/LPHD1.PhyNam.vendor", FunctionalConstraint.DC)
    assert isinstance(vendor, str)
    assert vendor.startswith('SEL" <&> {?} ??')
    assert len(vendor) == 255
