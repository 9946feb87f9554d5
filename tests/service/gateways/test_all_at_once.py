"""All gateways run beside each other, and one that fails or is killed is in nobody's way."""

import os
import signal
from pathlib import Path

from service.configuration.gateways.settings import GatewaysSettings
from service.configuration.settings import Settings
from service.storage import Repository
from testing.ports import free_port
from testing.service.conditions import FAULT, HEALTHY, tell
from testing.service.gateways import started_gateways
from testing.service.mosquitto import running_mosquitto
from testing.waiting import eventually, wait_until

BACK_S = 30.0


def test_each_works_beside_the_others_and_is_back_after_it_was_killed(
    repository: Repository, tmp_path: Path
) -> None:
    tell(repository, HEALTHY)
    with running_mosquitto(tmp_path) as broker:
        tables: dict[str, object] = {
            kind: {"port": free_port()} for kind in ("iec104", "iec61850", "modbus", "opcua")
        }
        tables |= {
            "goose": {"interface": "nosuch0"},
            "mqtt": {"port": broker.port, "sparkplug": {}},
        }
        settings = Settings(
            data_directory=tmp_path,
            stale_after_days=3650,
            gateways=GatewaysSettings.model_validate(tables),
        )
        assert set(settings.gateways.configured) == set(GatewaysSettings.model_fields)
        with started_gateways(settings) as gateways:

            def working() -> set[str]:
                return {one.kind for one in gateways.status() if one.problem is None}

            others = set(tables) - {"goose"}
            wait_until(lambda: working() == others, "all gateways but GOOSE to work")
            (goose,) = (one for one in gateways.status() if one.kind == "goose")
            assert goose.problem is not None
            assert "scd" in goose.problem
            killed = {one.kind: one.process_id for one in gateways.status()}
            for process in killed.values():
                assert process is not None
                os.kill(process, signal.SIGKILL)
            tell(repository, FAULT)
            assert eventually(
                lambda: all(one.process_id not in (None, killed[one.kind]) for one in gateways.status()),
                BACK_S,
            )
            assert eventually(lambda: working() == others, BACK_S)
            assert [one.restarts for one in gateways.status()] == [1] * len(tables)
            with broker.listening("statorwatch/#") as heard:
                wait_until(lambda: any(b'"fault"' in one.payload for one in heard), "the fault at the broker")
