"""The gateway hears real frames, and what it makes of them is in the database."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from service.alarms.kinds import AlarmKind
from service.configuration.gateways.goose import GooseSettings
from service.configuration.gateways.settings import GatewaysSettings
from service.configuration.settings import Settings
from service.gateways.supervision import PlantGateways
from service.plant import read_plant
from service.storage import Repository, connect
from testing.service.database import make_database
from testing.service.gateways import started_gateways
from testing.waiting import wait_until
from tests.mms.goose.network_namespace import IN_NAMESPACE, require_network_namespace
from tests.service.gateways.goose.plant import MOTORS, SCD
from tests.service.gateways.goose.two_interfaces import MISSED


def test_a_trip_is_an_alarm_and_a_signal_asks_for_a_recording(tmp_path: Path) -> None:
    """Trip, killed gateway, silence, what does not count (revision, quality, tests, replays), and its end."""
    require_network_namespace()
    command = [*IN_NAMESPACE, sys.executable, "-m", "tests.service.gateways.goose.two_interfaces"]
    done = subprocess.run([*command, str(tmp_path)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-4000:]
    found = json.loads(done.stdout.splitlines()[-1])
    silent, capabilities = found.pop("silent"), found.pop("capabilities")
    net_raw = 1 << 13
    assert int(capabilities["goose"], 16) == net_raw
    assert not (int(capabilities["modbus"], 16) | int(capabilities["worker"], 16)) & net_raw
    assert silent.startswith("6 of 6 GOOSE control blocks are not heard: A1_SEL710CFG/LLN0$GO$GPub01, ")
    assert found == {
        "alarm": ["PUMP-A1", "high", "A1_SEL710PRO/TRIPPTRC1.Tr.general is on"],
        "requests": [["FAN-A2", "request"]],
        "raises after the kill": [1],
        "requests after the kill": 1,
        "after a wrong revision": ["another confRev than configured", 1],
        "after a bad quality": True,
        "after the truth": ["FAN-A2"],
        "while it is down": [True, "right: Network is down"],
        "once it trips": True,
        "after replays": False,
        "after tests": False,
        "after missed states": True,
    }
    missed = [json.loads(line) for line in done.stderr.splitlines() if "GOOSE states were missed" in line]
    assert [(one["block"], one["states"]) for one in missed] == [("B2_SEL710CFG/LLN0$GO$GPub01", MISSED)]


def test_a_gateway_whose_receiver_fails_is_started_again_and_what_it_heard_is_written(tmp_path: Path) -> None:
    chosen = Settings(
        data_directory=tmp_path,
        scd=SCD,
        motors=MOTORS,
        gateways=GatewaysSettings(goose=GooseSettings(interface="none")),
    )
    repository = Repository(connect(make_database(tmp_path)))
    repository.sync_plant(read_plant(chosen))
    gateways = PlantGateways(chosen, (sys.executable, "-m", "tests.service.gateways.goose.failing_gateway"))
    gateways.start()
    try:
        wait_until(lambda: gateways.status()[0].restarts >= 1, "the gateway to end")
        (alarm,) = repository.open_alarms(limit=2).items
        assert (alarm.motor, alarm.kind) == ("PUMP-A1", AlarmKind.MOTOR_TRIPPED)
        wait_until(lambda: gateways.status()[0].restarts >= 2, "it to be started, and to end again")
    finally:
        gateways.stop()


@pytest.mark.parametrize(
    ("settings", "told"),
    [
        (GooseSettings(interface="nosuch0"), "nosuch0: expected a network interface of this machine"),
        (
            GooseSettings.model_validate(
                {"interface": "lo", "triggers": [{"signal": "A1_SEL710PRO/TRIPPTRC1.Nothing"}]}
            ),
            "(GSEControl) of the SCD send, found A1_SEL710PRO/TRIPPTRC1.Nothing in none",
        ),
        (
            GooseSettings.model_validate(
                {
                    "interface": "lo",
                    "triggers": [{"signal": "A1_SEL710PRO/TRIPPTRC1.Tr", "motors": ["PUMP-X"]}],
                }
            ),
            "expected motors of the plant, found PUMP-X",
        ),
    ],
)
def test_what_keeps_it_from_listening_is_told(tmp_path: Path, settings: GooseSettings, told: str) -> None:
    chosen = Settings(
        data_directory=tmp_path,
        scd=SCD,
        motors=MOTORS,
        gateways=GatewaysSettings(goose=settings),
    )
    Repository(connect(make_database(tmp_path))).sync_plant(read_plant(chosen))
    with started_gateways(chosen) as gateways:
        wait_until(lambda: told in (gateways.status()[0].problem or ""), told)
