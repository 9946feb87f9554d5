"""python -m benchmarks.gateways.iec104: IEC 60870-5-104 with 500 motors, told to a controlling station."""

import time
from contextlib import closing
from pathlib import Path
from tempfile import TemporaryDirectory

import c104

from benchmarks.gateways.load import argument_parser, measure
from benchmarks.gateways.plant import changing_plant
from service.configuration.gateways.iec104 import Iec104Settings
from service.configuration.gateways.settings import GatewaysSettings
from service.configuration.settings import Settings
from service.gateways.iec104.points import address
from testing.ports import LOOPBACK, free_port
from testing.service.gateways import running_gateways
from testing.waiting import wait_until


def is_open(connection: c104.Connection) -> bool:
    """Return whether data flow. The library now and then loses its own order to begin."""
    if connection.state == c104.ConnectionState.OPEN_MUTED:
        connection.unmute()
    return connection.state == c104.ConnectionState.OPEN


class Controlling:
    """A connected client of the library, whose points follow the station's."""

    def __init__(self, port: int, motors: int) -> None:
        self._client = c104.Client()
        connection = self._client.add_connection(ip=LOOPBACK, port=port, init=c104.Init.NONE)
        assert connection is not None
        station = connection.add_station(common_address=1)
        assert station is not None
        self._faults = [
            station.add_point(io_address=address(number, 1), type=c104.Type.M_SP_TB_1)
            for number in range(motors)
        ]
        self._client.start()
        wait_until(lambda: is_open(connection), "data to flow")

    def is_faulty(self, number: int) -> bool:
        """Return what the station said last of a motor."""
        point = self._faults[number]
        assert point is not None
        return bool(point.value)

    def close(self) -> None:
        """End the connection."""
        self._client.stop()


def main() -> None:
    """Print the figures."""
    wanted = argument_parser(__doc__).parse_args()
    with TemporaryDirectory(prefix="statorwatch-") as directory:
        plant = changing_plant(Path(directory), wanted.motors, now_ns=time.time_ns())
        server = Iec104Settings(port=free_port())
        settings = Settings(data_directory=Path(directory), gateways=GatewaysSettings(iec104=server))
        places = {name: place for place, name in enumerate(sorted(plant.motors))}
        with running_gateways(settings) as running:
            (status,) = running.status()
            assert status.process_id is not None
            with closing(Controlling(server.port, wanted.motors)) as client:

                def wait_for(motor: str, *, is_faulty: bool) -> None:
                    wait_until(lambda: client.is_faulty(places[motor]) == is_faulty, f"the fault of {motor}")

                load = measure(
                    status.process_id, plant, wait_for, idle_s=wanted.idle_s, changes=wanted.changes
                )
    print(f"{wanted.motors} motors: {load}")


if __name__ == "__main__":
    main()
