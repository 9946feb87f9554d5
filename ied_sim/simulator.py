"""The simulated plant: relays of an SCD file, served side by side in one process."""

import threading
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import Self

from ied_sim.errors import SimulatorError
from ied_sim.front import RelayProxies
from ied_sim.relay.configuration import RelayConfiguration
from ied_sim.relay.plant_clock import REAL_TIME, ClockSettings, PlantClock
from ied_sim.relay.relay import Relay
from ied_sim.scenario.scenario import healthy_reference
from mms import ServerPump, ServerStartFailed
from scl import Address, Scl

UPDATE_CHECK_PERIOD_S = 0.05
"""Time between checks for relays that are due for an update."""


class Simulator:
    """Relays of an SCD file, served at the addresses it names while this context manager is entered.

    Parameters
    ----------
    document : Scl
        The SCD file.
    scenarios : mapping of str to RelayConfiguration
        Configuration of each relay by its IED. A relay without one protects a healthy reference motor.
    files : pathlib.Path
        Directory for the relays' files.
    ieds : sequence of str
        Names of the relays to serve. All of the file's by default.
    clock : ClockSettings
        How the plant's time runs.

    Raises
    ------
    SimulatorError
        A relay cannot be made as its profile and scenario say.
    SclError
        The file lacks an IED or its address.
    OSError
        The relays' directories cannot be made.
    """

    def __init__(
        self,
        document: Scl,
        scenarios: Mapping[str, RelayConfiguration],
        *,
        files: Path,
        ieds: Sequence[str] = (),
        clock: ClockSettings = REAL_TIME,
    ) -> None:
        names = tuple(dict.fromkeys(ieds)) or tuple(ied.name for ied in document.ieds)
        self.addresses: dict[str, Address] = {name: document.address(name) for name in names}
        self._clock = PlantClock(time.time_ns(), clock)
        self._start_s = time.monotonic()
        self._proxies = RelayProxies()
        self.relays: dict[str, Relay] = {}
        for name, address in self.addresses.items():
            relay = Relay(
                document,
                name,
                scenarios.get(name) or healthy_reference(name),
                address=address,
                files=files,
                clock=self._clock,
                proxies=self._proxies,
            )
            self.relays[name] = relay
        self._pump = ServerPump(relay.server for relay in self.relays.values() if not relay.serves_itself)
        self._stopping = threading.Event()
        self._updating = threading.Thread(target=self._update_relays, name="relay updates", daemon=True)

    @property
    def epoch_ns(self) -> int:
        """UTC of the scenario's beginning [ns]."""
        return self._clock.epoch_ns

    def start(self) -> None:
        """Serve. SimulatorError names the relay whose address and port cannot be had."""
        try:
            self._pump.start()
            for relay in self.relays.values():
                if relay.serves_itself:
                    relay.server.start()
        except ServerStartFailed as error:
            raise self._start_error(error.host) from error
        taken = self._proxies.start()
        if taken is not None:
            self.stop()
            raise self._start_error(str(taken))
        self._updating.start()

    def stop(self) -> None:
        """Close all connections and abandon captures under way."""
        self._stopping.set()
        if self._updating.is_alive():
            self._updating.join()
        self._proxies.stop()
        for relay in self.relays.values():
            relay.stop()
            if relay.serves_itself:
                relay.server.stop()
        self._pump.stop()

    def __enter__(self) -> Self:
        self.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.stop()

    def _update_relays(self) -> None:
        """Update every relay when it is due; the first updates come one after the other."""
        relays = tuple(self.relays.values())
        due_s = [k / max(1, len(relays)) for k in range(len(relays))]
        while not self._stopping.wait(UPDATE_CHECK_PERIOD_S):
            now_s = time.monotonic() - self._start_s
            for k, relay in enumerate(relays):
                if due_s[k] <= now_s or relay.needs_update_soon:
                    due_s[k] = now_s + relay.update(self._clock.now_ns())

    def _start_error(self, where: str) -> SimulatorError:
        for name, address in self.addresses.items():
            if where in (f"{address.host}:{address.port}", str(address)):
                return SimulatorError(
                    f"{name}: cannot listen on {address.host} port {address.port}: the port is taken or "
                    "needs rights this process lacks, or the address is not this machine's; "
                    "stop what listens there, or change IP and MMS-Port in the SCD file"
                )
        return SimulatorError(f"cannot listen on {where}: the port was taken meanwhile; start again")
