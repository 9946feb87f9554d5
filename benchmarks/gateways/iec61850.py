"""python -m benchmarks.gateways.iec61850: the IEC 61850 server with 500 motors, read by a client."""

import time
from pathlib import Path
from tempfile import TemporaryDirectory

from open61850 import data as open_data
from open61850 import mms as open_mms

from benchmarks.gateways.load import argument_parser, measure
from benchmarks.gateways.plant import changing_plant
from service.configuration.gateways.iec61850 import Iec61850Settings
from service.configuration.gateways.settings import GatewaysSettings
from service.configuration.settings import Settings
from service.gateways.iec61850.logical_devices import logical_devices
from testing.ports import LOOPBACK, free_port
from testing.service.gateways import running_gateways
from testing.waiting import wait_until


def main() -> None:
    """Print the figures. The client is open61850's, which does not stand on the server's library."""
    wanted = argument_parser(__doc__).parse_args()
    with TemporaryDirectory(prefix="statorwatch-") as directory:
        plant = changing_plant(Path(directory), wanted.motors, now_ns=time.time_ns())
        port = free_port()
        gateways = GatewaysSettings(iec61850=Iec61850Settings(port=port))
        devices = logical_devices(plant.motors)
        with (
            running_gateways(Settings(data_directory=Path(directory), gateways=gateways)) as running,
            open_mms.MmsClient.connect(LOOPBACK, port=port) as client,
        ):
            (status,) = running.status()
            assert status.process_id is not None

            def wait_for(motor: str, *, is_faulty: bool) -> None:
                name = f"MCC{devices[motor]}/ZMOT1.EEHealth.stVal[ST]"
                expected = open_data.IntData(3 if is_faulty else 1)
                wait_until(lambda: client.read(name) == expected, f"the health of {motor}")

            wait_for(plant.motors[-1], is_faulty=False)
            load = measure(status.process_id, plant, wait_for, idle_s=wanted.idle_s, changes=wanted.changes)
    print(f"{wanted.motors} motors: {load}")


if __name__ == "__main__":
    main()
