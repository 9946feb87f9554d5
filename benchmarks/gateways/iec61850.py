"""python -m benchmarks.gateways.iec61850: the IEC 61850 server with 500 motors, which reports to a client."""

import time
from pathlib import Path
from tempfile import TemporaryDirectory

from open61850 import data as open_data
from open61850 import mms as open_mms
from open61850.mms import rcb as open_rcb

from benchmarks.gateways.load import argument_parser, measure
from benchmarks.gateways.plant import changing_plant
from service.configuration.gateways.iec61850 import Iec61850Settings
from service.configuration.gateways.settings import GatewaysSettings
from service.configuration.settings import Settings
from service.gateways.iec61850.logical_devices import logical_devices
from testing.ports import LOOPBACK, free_port
from testing.service.gateways import running_gateways
from testing.waiting import wait_until

OK, ALARM = 1, 3
"""EEHealth by IEC 61850-7-4."""

REPORTS = open_rcb.RcbSettings(
    trg_ops=None,
    opt_flds=open_mms.OptFlds(data_reference=True, entry_id=True),
    intg_pd_ms=None,
    resv_tms=None,
    entry_id=None,
    general_interrogation=True,
)


class Healths:
    """The health of each logical device, by the reports of a client of open61850."""

    def __init__(self) -> None:
        self._found: dict[str, int] = {}

    def hear(self, message: open_mms.InformationReport) -> None:
        """Keep what a report tells."""
        for entry in open_mms.decode_report(message).entries:
            device, _, item = (entry.reference or "").partition("/")
            if item == "ZMOT1$ST$EEHealth" and isinstance(entry.value, open_data.StructureData):
                state = entry.value.members[0]
                assert isinstance(state, open_data.IntData)
                self._found[device] = state.value

    def of(self, device: str) -> int | None:
        """Return what was told last; None where nothing was."""
        return self._found.get(device)


def main() -> None:
    """Print the figures. The client is open61850's, which does not stand on the server's library."""
    wanted = argument_parser(__doc__).parse_args()
    with TemporaryDirectory(prefix="statorwatch-") as directory:
        plant = changing_plant(Path(directory), wanted.motors, now_ns=time.time_ns())
        port = free_port()
        gateways = GatewaysSettings(iec61850=Iec61850Settings(port=port))
        devices = {motor: f"MCC{device}" for motor, device in logical_devices(plant.motors).items()}
        healths = Healths()
        with (
            running_gateways(Settings(data_directory=Path(directory), gateways=gateways)) as running,
            open_mms.MmsClient.connect(LOOPBACK, port=port, on_information_report=healths.hear) as client,
        ):
            (status,) = running.status()
            assert status.process_id is not None
            for device in devices.values():
                open_rcb.enable(client, open_mms.ObjectName("LLN0$BR$brcbVerdict01", device), REPORTS)

            def wait_for(motor: str, *, is_faulty: bool) -> None:
                expected = ALARM if is_faulty else OK
                wait_until(lambda: healths.of(devices[motor]) == expected, f"the health of {motor}")

            for motor in plant.motors:
                wait_for(motor, is_faulty=False)
            load = measure(status.process_id, plant, wait_for, idle_s=wanted.idle_s, changes=wanted.changes)
    print(f"{wanted.motors} motors, a report control block of each enabled: {load}")


if __name__ == "__main__":
    main()
