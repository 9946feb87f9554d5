"""The simulated plant: relays of an SCL file, served side by side in one process."""

import logging
import threading
import time
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from types import TracebackType
from typing import Self

from ied_sim.errors import SimulatorError
from ied_sim.front import RelayProxies
from ied_sim.relay.configuration import RelayConfiguration
from ied_sim.relay.goose import GooseOutlet
from ied_sim.relay.plant_clock import REAL_TIME, ClockSettings, PlantClock
from ied_sim.relay.relay import Relay
from ied_sim.scenario.scenario import healthy_reference
from mms import ModelError, ServerPump, ServerStartFailed
from mms.goose import PublisherThread, RawSocket, RawSocketError
from scl import Address, Scl, SclError
from scl.ied_model import Ied

log = logging.getLogger(__name__)

UPDATE_CHECK_PERIOD_S = 0.05
"""Time between checks for relays that are due for an update."""


class Simulator:
    """Relays of an SCL file, served while this context manager is entered.

    A relay that cannot be served is left out, with a line in the log; the others are served.

    Parameters
    ----------
    document : Scl
        The SCL file.
    scenarios : mapping of str to RelayConfiguration
        Configuration of each relay by its IED. A relay without one protects a healthy reference motor.
    files : pathlib.Path
        Directory for the relays' files.
    ieds : sequence of str
        Names of the relays to serve. All of the file's by default.
    clock : ClockSettings
        How the plant's time runs.
    addresses : mapping of str to Address
        Where relays listen, by their IED. A relay without one listens where the file says.
    goose_interface : str, optional
        Network interface on which the relays' GOOSE control blocks are published. None are without.

    Raises
    ------
    SimulatorError
        A relay cannot be made as its scenario says, or no relay can be served at all.
    SclError
        The file lacks an IED of `ieds`.
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
        addresses: Mapping[str, Address] | None = None,
        goose_interface: str | None = None,
    ) -> None:
        self._files = files
        self._clock = PlantClock(time.time_ns(), clock)
        self._start_s = time.monotonic()
        self._proxies = RelayProxies()
        self._goose_interface = goose_interface
        self._goose: tuple[RawSocket, PublisherThread] | None = None
        self.relays: dict[str, Relay] = {}
        self.addresses: dict[str, Address] = {}
        self.left_out: dict[str, str] = {}
        """Why a relay is not served, by its IED."""
        for ied in [document.ied(name) for name in dict.fromkeys(ieds)] or document.ieds:
            scenario = scenarios.get(ied.name) or healthy_reference(ied.name)
            self._add(document, ied, scenario, (addresses or {}).get(ied.name))
        if not self.relays:
            reasons = "; ".join(f"{name}: {reason}" for name, reason in self.left_out.items())
            raise SimulatorError(f"{document.path}: no relay to serve: {reasons or 'the file has no IED'}")
        self._pump = ServerPump(relay.server for relay in self.relays.values() if not relay.serves_itself)
        self._stopping = threading.Event()
        self._updating = threading.Thread(target=self._update_relays, name="relay updates", daemon=True)

    @property
    def epoch_ns(self) -> int:
        """UTC of the scenario's beginning [ns]."""
        return self._clock.epoch_ns

    def start(self) -> None:
        """Serve. SimulatorError names the relay whose address and port cannot be had.

        RawSocketError: there is no such interface for GOOSE, or the capability CAP_NET_RAW is missing.
        """
        try:
            self._pump.start()
            for relay in self.relays.values():
                if relay.serves_itself:
                    relay.server.start()
        except ServerStartFailed as error:
            raise self._start_error(error.host) from error
        servers = [relay.server for relay in self.relays.values()]
        taken = self._proxies.start(
            {Address(one.address, one.port): partial(self._pump.expect, one) for one in servers}
        )
        if taken is not None:
            self.stop()
            raise self._start_error(str(taken))
        self._updating.start()
        if self._goose_interface is not None:
            self._publish_goose(self._goose_interface)

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
        if self._goose is not None:
            socket, thread = self._goose
            thread.stop()
            socket.close()

    def __enter__(self) -> Self:
        self.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.stop()

    def _add(self, document: Scl, ied: Ied, scenario: RelayConfiguration, address: Address | None) -> None:
        """Add a relay, or note why it is left out. Raises SimulatorError where the scenario is at fault."""
        if not ied.logical_devices:
            self._leave_out(ied, "it has no server (an access point with a Server and LDevices)")
            return
        try:
            address = address or document.address(ied.name)
        except SclError as error:
            self._leave_out(ied, f"{error}; --host and --port give it an address")
            return
        other = next((name for name, taken in self.addresses.items() if taken == address), None)
        if other is not None:
            self._leave_out(ied, f"{other} has its address, {address}; --port gives each its own")
            return
        try:
            self.relays[ied.name] = Relay(
                document,
                ied.name,
                scenario,
                address=address,
                files=self._files,
                clock=self._clock,
                proxies=self._proxies,
            )
        except (SclError, ModelError) as error:
            self._proxies.remove(address)
            self._leave_out(ied, str(error))
            return
        self.addresses[ied.name] = address

    def _publish_goose(self, interface: str) -> None:
        try:
            socket = RawSocket(interface)
        except RawSocketError:
            self.stop()
            raise
        thread = PublisherThread(socket.send)
        self._goose = socket, thread
        outlet = GooseOutlet(thread, socket.address)
        for relay in self.relays.values():
            relay.publish_goose(outlet)
        thread.start()

    def _leave_out(self, ied: Ied, reason: str) -> None:
        self.left_out[ied.name] = reason
        log.warning("%s is not served: %s", ied.name, reason)

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
                    "stop what listens there, change IP and MMS-Port in the file, or give --host and --port"
                )
        return SimulatorError(f"cannot listen on {where}: the port was taken meanwhile; start again")
