"""OPC UA clients see motors and relays, their history and their alarms, as far as their users may."""

import asyncio
import json
import os
import signal
import socket
import subprocess
import sys
import time
from contextlib import ExitStack, suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import pytest
from asyncua import Client, ua

from service.configuration.gateways.opcua import OpcUaSettings
from service.configuration.settings import Settings
from service.gateways.opcua.certificate import own_certificate
from service.gateways.opcua.transport import LARGEST_UNFINISHED, SILENT_S
from service.gateways.supervision import PlantGateways
from service.recording_store.folder import FolderStore
from service.storage import Repository
from service.storage.records import Role
from service.storage.states import AlarmKind, AlarmState, LinkState
from testing.ports import LOOPBACK
from testing.service.conditions import FAULT, HEALTHY, tell
from testing.service.diagnosed import add_diagnosed
from testing.service.gateways import running_gateways
from testing.service.job_runner import register_runner
from testing.service.links import set_link_state
from testing.service.observations import observation
from testing.service.plants import NOW_NS, SECOND_NS, fault
from testing.waiting import eventually
from tests.service.gateways.opcua.clients import (
    PASSWORD,
    PEER,
    PUMP,
    add_user,
    address_of,
    done,
    encrypted,
    looking,
    node,
    require_open62541,
    value,
)
from tests.service.gateways.settings import port_of, settings_of


def test_a_fault_is_a_failure_with_the_time_of_its_record(repository: Repository, settings: Settings) -> None:
    before = value(settings, f"{PUMP}/State")
    assert before.StatusCode.value == ua.StatusCodes.BadWaitingForInitialData
    assert value(settings, f"{PUMP}/DeviceHealth").Value.Value == 2
    tell(repository, FAULT)
    assert eventually(lambda: value(settings, f"{PUMP}/State").Value.Value == "fault")
    level = value(settings, f"{PUMP}/FaultLevel")
    assert (level.Value.Value, level.StatusCode.value) == (0.0121, ua.StatusCodes.Good)
    assert level.SourceTimestamp.timestamp() * 10**9 == NOW_NS
    assert value(settings, f"{PUMP}/DeviceHealth").Value.Value == 1
    assert value(settings, f"{PUMP}/Load").StatusCode.value == ua.StatusCodes.BadNoData
    assert value(settings, f"{PUMP}/Phase").Value.Value == "b"


def test_the_state_of_a_machine_follows_its_relay_and_its_records(
    repository: Repository, settings: Settings
) -> None:
    path = f"{PUMP}/MachineryItemState/CurrentState"

    def told() -> tuple[str, int] | int:
        state, node_id = (value(settings, one) for one in (path, f"{path}/Id"))
        for one in (state, node_id):  # the state may change between the two
            if one.StatusCode.value != ua.StatusCodes.Good:
                return int(one.StatusCode.value)
        return state.Value.Value.Text, node_id.Value.Value.Identifier

    assert told() == ua.StatusCodes.BadNoCommunication
    tell(repository, HEALTHY)
    set_link_state(repository, "A1_SEL710", LinkState.UP, now_ns=NOW_NS, reason=None)
    assert eventually(lambda: told() == ("Executing", 5006))
    assert value(settings, path).SourceTimestamp.timestamp() * 10**9 == NOW_NS
    later_ns = NOW_NS + 10**9
    assert repository.skip_recording("PUMP-A1", "it stands", due_ns=later_ns, now_ns=later_ns)
    assert eventually(lambda: told() == ("NotExecuting", 5007))
    set_link_state(repository, "A1_SEL710", LinkState.DOWN, now_ns=NOW_NS, reason="no answer")
    assert eventually(lambda: told() == ua.StatusCodes.BadNoCommunication)


def test_an_old_condition_is_uncertain(repository: Repository, tmp_path: Path) -> None:
    tell(repository, HEALTHY)
    chosen = settings_of("opcua", tmp_path, anonymous=True, unencrypted=True)
    chosen = chosen.model_copy(update={"stale_after_days": 0.01})
    with running_gateways(chosen):
        found = value(chosen, f"{PUMP}/FaultLevel")
    assert (found.Value.Value, found.StatusCode.value) == (0.0004, ua.StatusCodes.UncertainLastUsableValue)


def test_only_what_changes_is_sent_to_a_subscription(repository: Repository, settings: Settings) -> None:
    tell(repository, HEALTHY)
    assert eventually(lambda: value(settings, f"{PUMP}/State").Value.Value == "healthy")
    sent: list[tuple[str, object]] = []

    class Seen:
        def datachange_notification(self, which: Any, said: object, _data: object) -> None:
            sent.append((which.nodeid.Identifier, said))

    async def subscribe(client: Client) -> None:
        subscription = await client.create_subscription(100, Seen())
        names = [f"{PUMP}/State", f"{PUMP}/DeviceHealth", "motor/FAN-A2/State", "relay/A1_SEL710/Link"]
        await subscription.subscribe_data_change([node(client, name) for name in names])
        while len(sent) < len(names):
            await asyncio.sleep(0.05)
        sent.clear()
        await asyncio.to_thread(tell, repository, FAULT)
        await asyncio.to_thread(
            set_link_state, repository, "A1_SEL710", LinkState.UP, now_ns=NOW_NS, reason=None
        )
        while len(sent) < 3:
            await asyncio.sleep(0.05)

    looking(settings, lambda client: asyncio.wait_for(subscribe(client), 30))
    assert sorted(sent) == [
        (f"{PUMP}/DeviceHealth", 1),
        (f"{PUMP}/State", "fault"),
        ("relay/A1_SEL710/Link", "up"),
    ]


def test_an_alarm_is_an_event(repository: Repository, settings: Settings) -> None:
    seen: list[Any] = []

    class Seen:
        def event_notification(self, event: Any) -> None:
            seen.append(event)

    async def subscribe(client: Client) -> None:
        kind = await client.nodes.base_event_type.get_child("2:MotorAlarmEventType")
        subscription = await client.create_subscription(100, Seen())
        await subscription.subscribe_events(evtypes=kind)
        await asyncio.to_thread(
            repository.raise_alarm, "A1_SEL710", AlarmKind.FILE_REFUSED, "E1.CEV", "cut off", now_ns=NOW_NS
        )
        while not seen:
            await asyncio.sleep(0.05)

    looking(settings, lambda client: asyncio.wait_for(subscribe(client), 30))
    (event, *_) = seen
    assert (event.Kind, event.SourceName, event.Message.Text) == ("file-refused", "A1_SEL710", "cut off")
    assert event.SourceNode.Identifier == "relay/A1_SEL710"
    assert event.Severity in (300, 500, 700, 900)


def test_nobody_comes_in_without_encryption_or_a_user_unless_told(
    repository: Repository, tmp_path: Path
) -> None:
    chosen = settings_of("opcua", tmp_path)

    async def nobody() -> None:
        async with await encrypted(chosen):
            pass

    with running_gateways(chosen):
        with pytest.raises(ua.uaerrors.BadSecurityPolicyRejected):
            value(chosen, f"{PUMP}/State")
        with pytest.raises(ua.uaerrors.BadIdentityTokenRejected):
            asyncio.run(nobody())


def test_users_may_what_their_roles_allow(repository: Repository, tmp_path: Path) -> None:
    add_user(repository, "vera", Role.VIEWER)
    add_user(repository, "otto", Role.OPERATOR)
    add_user(repository, "sam", Role.SECADM)
    chosen = settings_of("opcua", tmp_path)

    async def trigger(user: str, password: str = PASSWORD) -> str:
        client = await encrypted(chosen, user, password)
        try:
            async with client:
                service = node(client, "service")
                return str(await service.call_method("2:TriggerRecording", "PUMP-A1"))
        except (TimeoutError, ua.UaStatusCodeError, ConnectionError) as refused:
            return type(refused).__name__

    with running_gateways(chosen):
        assert asyncio.run(trigger("vera")) == "BadUserAccessDenied"
        assert asyncio.run(trigger("sam")) == "BadUserAccessDenied"
        assert asyncio.run(trigger("otto", "wrong")) == "BadUserAccessDenied"
        request = asyncio.run(trigger("otto"))
    assert repository.recording_request(request).motor == "PUMP-A1"
    assert ("recording-requested", "otto", f"opcua {LOOPBACK}") in done(repository)
    assert ("logged-in", "otto", f"opcua {LOOPBACK}") in done(repository)
    assert repository.user("otto").last_login_origin == f"opcua {LOOPBACK}"


def test_an_alarm_is_acknowledged_by_who_may(repository: Repository, tmp_path: Path) -> None:
    add_user(repository, "vera", Role.VIEWER)
    add_user(repository, "otto", Role.OPERATOR)
    repository.raise_alarm("A1_SEL710", AlarmKind.FILE_REFUSED, "E1.CEV", "cut off", now_ns=NOW_NS)
    (alarm,) = repository.open_alarms(limit=5).items
    chosen = settings_of("opcua", tmp_path)

    async def acknowledge(user: str, alarm_id: str) -> str:
        try:
            async with await encrypted(chosen, user) as client:
                await node(client, "service").call_method("2:Acknowledge", alarm_id, "seen")
        except ua.UaStatusCodeError as refused:
            return type(refused).__name__
        return "done"

    with running_gateways(chosen):
        assert asyncio.run(acknowledge("vera", alarm.id)) == "BadUserAccessDenied"
        assert repository.alarm(alarm.id).state is AlarmState.UNACKNOWLEDGED
        assert asyncio.run(acknowledge("otto", "no such alarm")) == "BadNotFound"
        assert asyncio.run(acknowledge("otto", alarm.id)) == "done"
        assert asyncio.run(acknowledge("otto", alarm.id)) == "BadInvalidState"
    seen = repository.alarm(alarm.id)
    assert (seen.state, seen.changed_by, seen.comment) == (AlarmState.ACKNOWLEDGED, "otto", "seen")
    assert ("alarm-acknowledged", "otto", f"opcua {LOOPBACK}") in done(repository)


def test_open62541_reads_encrypted_with_history_and_has_a_motor_recorded(
    repository: Repository, tmp_path: Path
) -> None:
    require_open62541()
    add_user(repository, "otto", Role.OPERATOR)
    store = FolderStore(tmp_path / "recordings")
    register_runner(repository)
    for number in range(3):
        seen_then = observation(number - 3.0)
        add_diagnosed(repository, store, fault(), seen_then.time_ns, name=f"E{number}", observed=seen_then)
    tell(repository, FAULT)
    chosen = settings_of("opcua", tmp_path)
    folder = tmp_path / "client"
    folder.mkdir()
    certificate, key = own_certificate(folder, "urn:statorwatch:test-client", LOOPBACK)
    script = Path(__file__).with_name("open62541_client.py")
    command = [sys.executable, str(script), str(PEER), address_of(chosen), str(certificate), str(key), "otto"]
    with running_gateways(chosen):
        peer = subprocess.run(
            command, input=f"{PASSWORD}\n", capture_output=True, text=True, timeout=100, check=False
        )
    assert peer.returncode == 0, peer.stdout[-2000:] + peer.stderr[-2000:]
    seen = json.loads(peer.stdout.splitlines()[-1])
    assert (seen["state"], seen["level"], seen["health"]) == ("fault", 0.0121, 1)
    status, time_said = seen["told"]["PUMP-A1"]
    assert status == ua.StatusCodes.Good
    assert datetime.fromisoformat(time_said) == datetime.fromtimestamp(NOW_NS // SECOND_NS, UTC)
    assert seen["told"]["FAN-A2"][0] == ua.StatusCodes.BadNoData
    assert seen["history"] == [0.0121] * 3
    assert ("recording-requested", "otto", f"opcua {LOOPBACK}") in done(repository)
    assert repository.recording_requests(motor="PUMP-A1", limit=1).items


def test_more_silent_and_garbled_clients_than_places_keep_nobody_out_and_put_nobody_out(
    repository: Repository, settings: Settings
) -> None:
    tell(repository, HEALTHY)
    assert eventually(lambda: value(settings, f"{PUMP}/State").Value.Value == "healthy")
    assert settings.gateways.opcua is not None
    crowds = 3 * settings.gateways.opcua.max_connections // 2
    with ExitStack() as crowd:

        async def work() -> float:
            async with Client(address_of(settings)) as before:
                for number in range(crowds):
                    one = socket.create_connection((LOOPBACK, port_of(settings)))
                    crowd.enter_context(one)
                    if number % 3 == 1:
                        one.sendall(b"HELF\xff\xff\xff\x7f" + b"x" * 50)
                    if number % 3 == 2:
                        one.sendall(bytes([number]) * number)
                begun_s = time.monotonic()
                async with Client(address_of(settings)) as after:
                    assert await node(after, f"{PUMP}/State").read_value() == "healthy"
                took_s = time.monotonic() - begun_s
                assert await node(before, f"{PUMP}/State").read_value() == "healthy"
                return took_s

        assert asyncio.run(work()) < SILENT_S


def test_a_client_that_never_logs_in_is_sent_away(repository: Repository, settings: Settings) -> None:
    with socket.create_connection((LOOPBACK, port_of(settings)), timeout=6 * SILENT_S) as silent:
        assert silent.recv(1) == b""


def test_a_chunk_without_an_end_is_cut_off(repository: Repository, settings: Settings) -> None:
    tell(repository, HEALTHY)
    sent = 0
    with socket.create_connection((LOOPBACK, port_of(settings)), timeout=20) as client:
        client.sendall(b"MSGF\xff\xff\xff\x7f")
        with suppress(ConnectionError):
            while sent < 64 * LARGEST_UNFINISHED:
                sent += client.send(b"x" * LARGEST_UNFINISHED)
    assert sent < 64 * LARGEST_UNFINISHED
    assert eventually(lambda: value(settings, f"{PUMP}/State").Value.Value == "healthy")


def test_a_gateway_that_is_killed_is_back_with_the_right_values(
    repository: Repository, tmp_path: Path
) -> None:
    tell(repository, HEALTHY)
    chosen = settings_of("opcua", tmp_path, anonymous=True, unencrypted=True)

    def state() -> object:
        try:
            return value(chosen, f"{PUMP}/State").Value.Value
        except (TimeoutError, OSError, ua.UaError):
            return None

    with running_gateways(chosen) as gateways:
        assert state() == "healthy"
        first = gateways.status()[0].process_id
        assert first is not None
        os.kill(first, signal.SIGKILL)
        tell(repository, FAULT)
        assert eventually(lambda: state() == "fault")


def test_a_port_that_is_taken_is_told_and_tried_again(repository: Repository, tmp_path: Path) -> None:
    chosen = settings_of("opcua", tmp_path, anonymous=True, unencrypted=True)
    assert chosen.gateways.opcua is not None
    port = chosen.gateways.opcua.port
    gateways = PlantGateways(chosen)
    with socket.create_server((LOOPBACK, port)):
        gateways.start()
        told = f"{LOOPBACK}:{port}: Address already in use"
        assert eventually(lambda: gateways.status()[0].problem == told)
        process = gateways.status()[0].process_id
    try:
        assert eventually(lambda: gateways.status()[0].problem is None)
        assert gateways.status()[0].process_id == process
    finally:
        gateways.stop()


def test_nothing_goes_in_clear_beyond_loopback() -> None:
    with pytest.raises(ValueError, match="unencrypted"):
        OpcUaSettings.model_validate({"bind_address": "10.0.0.1", "unencrypted": True})
    with pytest.raises(ValueError, match="together"):
        OpcUaSettings.model_validate({"certificate": "mcc.der"})
