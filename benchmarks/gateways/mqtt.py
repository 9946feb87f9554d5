"""python -m benchmarks.gateways.mqtt: topics and Sparkplug with 500 motors, heard by mosquitto_sub."""

import json
import time
from pathlib import Path
from tempfile import TemporaryDirectory

from benchmarks.gateways.load import argument_parser, measure
from benchmarks.gateways.plant import changing_plant
from service.configuration.gateways.mqtt import MqttSettings, SparkplugSettings
from service.configuration.gateways.settings import GatewaysSettings
from service.configuration.settings import Settings
from testing.service.gateways import running_gateways
from testing.service.mosquitto import Heard, running_mosquitto
from testing.waiting import wait_until


def main() -> None:
    """Print the figures."""
    parser = argument_parser(__doc__)
    parser.add_argument("--without-sparkplug", action="store_true")
    wanted = parser.parse_args()
    with TemporaryDirectory(prefix="statorwatch-") as name, running_mosquitto(Path(name)) as broker:
        plant = changing_plant(Path(name), wanted.motors, now_ns=time.time_ns())
        sparkplug = None if wanted.without_sparkplug else SparkplugSettings()
        mqtt = MqttSettings(port=broker.port, sparkplug=sparkplug)
        settings = Settings(data_directory=Path(name), gateways=GatewaysSettings(mqtt=mqtt))
        with broker.listening("statorwatch/motors/#") as heard, running_gateways(settings) as gateways:
            states = States(heard)

            def wait_for(motor: str, is_faulty: bool) -> None:
                expected = "fault" if is_faulty else "healthy"
                wait_until(lambda: states.of(motor) == expected, f"the state of {motor}")

            (status,) = gateways.status()
            assert status.process_id is not None
            wait_for(plant.motors[-1], is_faulty=False)
            load = measure(status.process_id, plant, wait_for, idle_s=wanted.idle_s, changes=wanted.changes)
    print(f"{wanted.motors} motors: {load}")


class States:
    """The latest state of each motor, of all that has been heard."""

    def __init__(self, heard: list[Heard]) -> None:
        self._heard = heard
        self._read = 0
        self._states: dict[str, str] = {}

    def of(self, motor: str) -> str | None:
        """Return what was last heard of a motor; None where nothing was."""
        new = self._heard[self._read :]
        self._read += len(new)
        for one in new:
            found = json.loads(one.payload)
            self._states[found["name"]] = found["state"]
        return self._states.get(motor)


if __name__ == "__main__":
    main()
