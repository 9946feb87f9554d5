"""mosquitto_sub hears the state of the plant, and loses nothing that happened."""

import json
import os
import re
import signal
import socket
import subprocess
from collections.abc import Sequence
from dataclasses import fields, replace
from pathlib import Path

from core.time_stamps import rfc3339
from core.units import NANOSECONDS_PER_HOUR
from service.gateways.mqtt.position import POSITION
from service.gateways.plant_state.figures import MotorFigures
from service.storage import Repository
from service.storage.records.actors import SERVICE
from service.storage.states import AlarmKind, LinkState
from testing.ports import LOOPBACK, free_port
from testing.relays.certificates import identity
from testing.service.conditions import FAULT, HEALTHY, tell
from testing.service.gateways import running_gateways, started_gateways
from testing.service.links import set_link_state
from testing.service.mosquitto import Heard, Mosquitto, program, running_mosquitto
from testing.service.plants import NOW_NS
from testing.waiting import eventually, wait_until
from tests.service.gateways.mqtt.conftest import settings_of

STATUS = "statorwatch/status"
PAGE = Path("docs/reference/mqtt.md")
PUMP = "statorwatch/motors/FACTORY_A/PUMP-A1/state"


def last(heard: Sequence[Heard], topic: str) -> dict[str, object]:
    """The latest document of a topic."""
    found = [one.payload for one in heard if one.topic.endswith(topic)]
    return dict(json.loads(found[-1])) if found and found[-1] else {}


def documents(heard: Sequence[Heard], topic: str) -> list[dict[str, object]]:
    return [json.loads(one.payload) for one in list(heard) if one.topic == topic and one.payload]


def documented(topic: str) -> set[str]:
    """The fields that the page of the topics names for this one."""
    section = PAGE.read_text(encoding="utf-8").split(f"## `statorwatch/{topic}`")[1].split("## ")[0]
    return {name for line in section.splitlines() for name in re.findall(r"`(\w+)`", line.split(" | ")[0])}


def test_the_state_of_motors_relays_and_alarms_is_kept_by_the_broker(
    repository: Repository, broker: Mosquitto, tmp_path: Path
) -> None:
    tell(repository, HEALTHY)
    with running_gateways(settings_of(tmp_path, broker.port)):
        with broker.listening("statorwatch/#") as heard:
            wait_until(lambda: last(heard, "/PUMP-A1/state").get("state") == "healthy")
            tell(repository, FAULT)
            wait_until(lambda: last(heard, "/PUMP-A1/state").get("state") == "fault")
            assert eventually(lambda: last(heard, STATUS)["state"] == "online")
            # What happens once is told after the states, and not kept.
            wait_until(lambda: last(heard, "changes/conditions").get("state") == "fault", "the change")
            wait_until(lambda: last(heard, "changes/alarms"), "the alarm")
        with broker.listening("statorwatch/#") as later:
            wait_until(lambda: last(later, "/A1_SEL710/state"))
            pump = last(later, "/PUMP-A1/state")
            assert all(one.is_retained for one in later)
            assert last(later, "/FAN-A2/state")["quality"] == "bad"
            alarms = [one for one in later if one.topic.startswith("statorwatch/alarms/")]
            assert [json.loads(one.payload)["kind"] for one in alarms] == ["condition-fault"]
        assert documented("status") == last(heard, STATUS).keys()
        assert documented("motors/SITE/MOTOR/state") == pump.keys()
        assert documented("relays/SITE/RELAY/state") == last(later, "/A1_SEL710/state").keys()
        assert documented("alarms/ID/state") == json.loads(alarms[0].payload).keys()
        change = last(heard, "changes/conditions")
        assert documented("changes/conditions") == change.keys()
        assert documented("changes/alarms") == last(heard, "changes/alarms").keys()
    assert (change["mu_f"], change["mu_f_ci95"]) == (0.0121, [0.009, 0.0225])
    assert (pump["mu_f"], pump["mu_f_ci95"], pump["phase"]) == (0.0121, [0.009, 0.0225], "b")
    assert (pump["quality"], pump["device_health"]) == ("good", "failure")
    assert pump["as_of"] == rfc3339(NOW_NS)
    assert (pump["running"], pump["running_as_of"]) == ("unknown", None)
    assert len(pump) == len(fields(MotorFigures)), "no field takes another's name"


def test_what_is_over_is_taken_from_the_broker_even_if_it_ended_while_the_gateway_was_away(
    repository: Repository, broker: Mosquitto, tmp_path: Path
) -> None:
    alarm = repository.raise_alarm("A1_SEL710", AlarmKind.LINK_DOWN, "", "no answer", now_ns=NOW_NS)
    topic = f"statorwatch/alarms/{alarm.id}/state"
    settings = settings_of(tmp_path, broker.port)
    with broker.listening("statorwatch/#") as heard:
        with running_gateways(settings):
            wait_until(lambda: last(heard, topic))
        wait_until(lambda: last(heard, STATUS) == {"state": "offline"})
        repository.clear_alarms_of("A1_SEL710", AlarmKind.LINK_DOWN, now_ns=NOW_NS + 1)
        repository.acknowledge_alarms([alarm.id], by=SERVICE, comment=None, now_ns=NOW_NS + 2)
        with running_gateways(settings):
            wait_until(lambda: [one for one in heard if one.topic == topic][-1].payload == b"")


def test_a_broker_that_was_away_for_an_hour_is_told_all_that_happened_though_the_gateway_was_killed(
    repository: Repository, broker: Mosquitto, tmp_path: Path
) -> None:
    tell(repository, HEALTHY)
    with running_gateways(settings_of(tmp_path, broker.port)) as gateways:
        wait_until((tmp_path / POSITION).exists)
        broker.stop()
        wait_until(lambda: gateways.status()[0].problem)
        first = gateways.status()[0].process_id
        assert first is not None
        times = [NOW_NS + minute * NANOSECONDS_PER_HOUR // 60 for minute in range(5, 65, 5)]
        for number, time_ns in enumerate(times):
            condition = FAULT if number % 2 == 0 else HEALTHY
            tell(repository, replace(condition, as_of_ns=time_ns), now_ns=time_ns)
            if number == 5:
                os.kill(first, signal.SIGKILL)
        set_link_state(repository, "A2_SEL710", LinkState.DOWN, now_ns=times[-1], reason="no answer")
        sequences = list(repository.alarm_sequences(0, limit=1000))
        broker.start()
        with broker.listening("statorwatch/#") as heard:
            wait_until(lambda: len(documents(heard, "statorwatch/changes/conditions")) >= len(times))
            wait_until(lambda: last(heard, "/PUMP-A1/state").get("state") == "healthy")
            wait_until(lambda: len(documents(heard, "statorwatch/changes/alarms")) >= len(sequences))
            conditions = documents(heard, "statorwatch/changes/conditions")
            alarms = documents(heard, "statorwatch/changes/alarms")
    assert [one["state"] for one in conditions] == ["fault", "healthy"] * 6
    assert [str(one["time"])[11:16] for one in conditions] == sorted(
        str(one["time"])[11:16] for one in conditions
    )
    assert [one["sequence"] for one in alarms] == sequences
    assert len(sequences) >= 12


def test_what_has_been_told_is_not_told_again(
    repository: Repository, broker: Mosquitto, tmp_path: Path
) -> None:
    settings = settings_of(tmp_path, broker.port)
    with broker.listening("statorwatch/changes/#") as heard:
        with running_gateways(settings):
            wait_until((tmp_path / POSITION).exists)
            tell(repository, FAULT)
            wait_until(lambda: len(documents(heard, "statorwatch/changes/conditions")) == 1)
        told = len(heard)
        with running_gateways(settings):
            tell(repository, replace(HEALTHY, as_of_ns=NOW_NS + 1), now_ns=NOW_NS + 1)
            wait_until(lambda: len(documents(heard, "statorwatch/changes/conditions")) == 2)
        assert [
            json.loads(one.payload).get("state") for one in heard[told:] if "conditions" in one.topic
        ] == ["healthy"]


def test_a_gateway_that_is_killed_is_offline_and_then_back_with_the_right_values(
    repository: Repository, broker: Mosquitto, tmp_path: Path
) -> None:
    with (
        running_gateways(settings_of(tmp_path, broker.port)) as gateways,
        broker.listening("statorwatch/#") as heard,
    ):
        wait_until(lambda: last(heard, STATUS).get("state") == "online")
        first = gateways.status()[0].process_id
        assert first is not None
        os.kill(first, signal.SIGKILL)
        tell(repository, FAULT)
        wait_until(lambda: last(heard, "/PUMP-A1/state").get("state") == "fault")
        wait_until(lambda: last(heard, STATUS).get("state") == "online")
        assert {"state": "offline"} in documents(heard, STATUS)


def test_certificates_and_passwords(repository: Repository, tmp_path: Path) -> None:
    authority = identity(tmp_path, "authority", authority=True)
    server = identity(tmp_path, "broker", issuer=authority)
    passwords, secret = tmp_path / "passwords", tmp_path / "password"
    secret.touch(mode=0o600)
    secret.write_text("wrong\n", encoding="utf-8")
    subprocess.run([program("mosquitto_passwd"), "-b", "-c", passwords, "mcc", "p\u00e4ss word"], check=True)
    options = ["--cafile", str(authority.certificate_file), "-u", "mcc", "-P", "p\u00e4ss word"]
    lines = [
        "allow_anonymous false",
        f"password_file {passwords}",
        f"cafile {authority.certificate_file}",
        f"certfile {server.certificate_file}",
        f"keyfile {server.key_file}",
    ]
    with running_mosquitto(tmp_path, *lines, client_options=options) as broker:
        settings = settings_of(
            tmp_path,
            broker.port,
            tls=True,
            ca=authority.certificate_file,
            user="mcc",
            password_file=secret,
            protocol="3.1.1",
        )
        with started_gateways(settings) as gateways:
            wait_until(lambda: "uthori" in str(gateways.status()[0].problem))
            secret.write_text("p\u00e4ss word\n", encoding="utf-8")
            wait_until(lambda: gateways.status()[0].problem is None)
            with broker.listening(PUMP) as heard:
                wait_until(lambda: last(heard, PUMP))


def test_a_broker_that_refuses_what_is_published_is_told(repository: Repository, tmp_path: Path) -> None:
    rules = tmp_path / "rules"
    rules.write_text("topic write statorwatch/status\ntopic read #\n", encoding="utf-8")
    with (
        running_mosquitto(tmp_path, "allow_anonymous true", f"acl_file {rules}") as broker,
        started_gateways(settings_of(tmp_path, broker.port)) as gateways,
    ):
        wait_until(lambda: "refuses what is published: Not authorized" in str(gateways.status()[0].problem))


def test_a_broker_that_says_nothing_is_told_and_left(repository: Repository, tmp_path: Path) -> None:
    with (
        socket.create_server((LOOPBACK, 0)) as silent,
        started_gateways(settings_of(tmp_path, silent.getsockname()[1], timeout_s=0.5)) as gateways,
    ):
        silent.settimeout(30)
        first, _ = silent.accept()
        wait_until(lambda: "timed out" in str(gateways.status()[0].problem))
        second, _ = silent.accept()
        first.close()
        second.close()


def test_a_broker_that_hangs_for_a_while_is_told_all_that_happened(
    repository: Repository, broker: Mosquitto, tmp_path: Path
) -> None:
    tell(repository, HEALTHY)
    settings = settings_of(tmp_path, broker.port, timeout_s=1.0)
    with broker.listening("statorwatch/#") as heard, running_gateways(settings) as gateways:
        wait_until(lambda: last(heard, STATUS).get("state") == "online")
        wait_until((tmp_path / POSITION).exists)
        with broker.hanging():
            tell(repository, FAULT)
            tell(repository, replace(HEALTHY, as_of_ns=NOW_NS + 1), now_ns=NOW_NS + 1)
            wait_until(lambda: "timed out" in str(gateways.status()[0].problem))
        wait_until(lambda: gateways.status()[0].problem is None)
        wait_until(
            lambda: (
                [one["state"] for one in documents(heard, "statorwatch/changes/conditions")][-2:]
                == ["fault", "healthy"]
            )
        )


def test_without_a_broker_the_service_is_told(repository: Repository, tmp_path: Path) -> None:
    with started_gateways(settings_of(tmp_path, free_port())) as gateways:
        wait_until(lambda: "refused" in str(gateways.status()[0].problem))


def test_a_file_that_is_something_else_is_told_and_kept(
    repository: Repository, broker: Mosquitto, tmp_path: Path
) -> None:
    (tmp_path / POSITION).write_text('{"alarms": {}}', encoding="utf-8")
    with started_gateways(settings_of(tmp_path, broker.port)) as gateways:
        wait_until(lambda: "expected what was told to the broker" in str(gateways.status()[0].problem))
    assert (tmp_path / POSITION).read_text(encoding="utf-8") == '{"alarms": {}}'


def test_nothing_good_is_left_with_the_broker_while_the_database_is_silent(
    repository: Repository, broker: Mosquitto, tmp_path: Path
) -> None:
    """As long as it is silent at the start: within the 30 s, which a test of the follower has for later."""
    (tmp_path / "statorwatch.sqlite").rename(tmp_path / "away.sqlite")
    (tmp_path / "statorwatch.sqlite").mkdir()
    # What a broker keeps that went down with the gateway, and so never told its will.
    broker.publish(STATUS, b'{"state": "online", "database": "answers"}', retain=True)
    with broker.listening(STATUS) as heard:
        wait_until(lambda: last(heard, STATUS).get("state") == "online")
        with started_gateways(settings_of(tmp_path, broker.port)) as gateways:
            wait_until(lambda: "database" in str(gateways.status()[0].problem))
            assert eventually(lambda: last(heard, STATUS) == {"state": "offline"})
