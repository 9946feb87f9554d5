"""The simulated plant: relays of an SCD file, served side by side in one process."""

import threading
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import Self

from ied_sim.errors import SimulatorError
from ied_sim.relay import Relay
from ied_sim.scenario import RelayScenario, healthy_reference
from mms import ServerPump, ServerStartFailed
from scl import Address, Scl

METERING_PERIOD_S = 1.0


class Simulator:
    """Relays of an SCD file at the addresses it names; a context manager that serves while it is entered.

    ieds: names of the relays to serve, all of the file's if empty. scenarios: by IED; a relay without one
    protects a healthy reference motor. files: directory for the relays' files.
    Raises SimulatorError, SclError, OSError.
    """

    def __init__(
        self, document: Scl, scenarios: Mapping[str, RelayScenario], *, files: Path, ieds: Sequence[str] = ()
    ) -> None:
        names = tuple(dict.fromkeys(ieds)) or tuple(ied.name for ied in document.ieds)
        self.addresses: dict[str, Address] = {name: document.address(name) for name in names}
        epoch_ns = time.time_ns()
        self._relays = [
            Relay(
                document,
                name,
                scenarios.get(name) or healthy_reference(name),
                address=address,
                files=files,
                epoch_ns=epoch_ns,
            )
            for name, address in self.addresses.items()
        ]
        self._pump = ServerPump(relay.server for relay in self._relays)
        self._stopping = threading.Event()
        self._metering = threading.Thread(target=self._meter, name="metering", daemon=True)

    def start(self) -> None:
        """Serve; SimulatorError names the relay whose address and port cannot be had."""
        try:
            self._pump.start()
        except ServerStartFailed as error:
            raise self._start_error(error) from error
        self._metering.start()

    def stop(self) -> None:
        """Close all connections, abandon captures under way."""
        self._stopping.set()
        if self._metering.is_alive():
            self._metering.join()
        for relay in self._relays:
            relay.stop()
        self._pump.stop()

    def __enter__(self) -> Self:
        self.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.stop()

    def _meter(self) -> None:
        while not self._stopping.wait(METERING_PERIOD_S):
            for relay in self._relays:
                relay.update_metering(time.time_ns())

    def _start_error(self, error: ServerStartFailed) -> SimulatorError:
        for name, address in self.addresses.items():
            if error.host == f"{address.host}:{address.port}":
                return SimulatorError(
                    f"{name}: cannot listen on {address.host} port {address.port}: the port is taken or "
                    "needs rights this process lacks, or the address is not this machine's; "
                    "stop what listens there, or change IP and MMS-Port in the SCD file"
                )
        return SimulatorError(str(error))
