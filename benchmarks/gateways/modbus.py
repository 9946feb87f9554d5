"""python -m benchmarks.gateways.modbus: the Modbus server with 500 motors, read by libmodbus (mbpoll)."""

import re
import subprocess
import time
from pathlib import Path
from tempfile import TemporaryDirectory

from benchmarks.gateways.load import argument_parser, measure
from benchmarks.gateways.plant import changing_plant
from service.configuration.gateways.modbus import ModbusSettings
from service.configuration.gateways.settings import GatewaysSettings
from service.configuration.settings import Settings
from service.gateways.modbus.register_map import BLOCK, FIRST_BLOCK
from testing.ports import LOOPBACK, free_port
from testing.service.gateways import running_gateways
from testing.waiting import wait_until


def main() -> None:
    """Print the figures."""
    wanted = argument_parser(__doc__).parse_args()
    with TemporaryDirectory(prefix="statorwatch-") as directory:
        plant = changing_plant(Path(directory), wanted.motors, now_ns=time.time_ns())
        port = free_port()
        settings = Settings(
            data_directory=Path(directory), gateways=GatewaysSettings(modbus=ModbusSettings(port=port))
        )
        places = {name: place for place, name in enumerate(sorted(plant.motors))}

        def wait_for(motor: str, is_faulty: bool) -> None:
            address = FIRST_BLOCK + BLOCK * places[motor]
            wait_until(lambda: _read(port, address) == (3 if is_faulty else 1), f"the registers of {motor}")

        with running_gateways(settings) as gateways:
            (status,) = gateways.status()
            assert status.process_id is not None
            wait_for(plant.motors[-1], is_faulty=False)
            load = measure(status.process_id, plant, wait_for, idle_s=wanted.idle_s, changes=wanted.changes)
    print(f"{wanted.motors} motors: {load}")


def _read(port: int, address: int) -> int | None:
    command = ["mbpoll", "-0", "-1", "-q", "-B", "-t", "3", "-c", "1", "-p", str(port), "-r", str(address)]
    done = subprocess.run([*command, LOOPBACK], capture_output=True, text=True, timeout=30, check=False)
    found = re.search(r"^\[\d+\]:\s+(\d+)", done.stdout, re.MULTILINE)
    return None if found is None else int(found[1])


if __name__ == "__main__":
    main()
