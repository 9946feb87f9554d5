"""Doing what the schedule says goes wrong, and undoing it after its time."""

import os
import signal
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from threading import Lock

from core.units import NANOSECONDS_PER_SECOND
from mms import Client, MmsError
from testing.tcp_proxy import Proxy
from tests.chaos.database import Database
from tests.chaos.disk import Disk
from tests.chaos.history import History
from tests.chaos.plant import SWITCHED, ChaosPlant
from tests.chaos.schedule import Action
from tests.chaos.served import ServedService
from tests.chaos.simulators import SimulatorProcess

CLOCK_JUMPS_S = (3600, -3600, 90, -90, 86_400, -86_400)
FILE_TIMES_JUMPS_S = (3600, -3600)
CUT_AFTER_BYTES = (500, 4_000, 12_000)
REQUEST_LIMIT_S = 3.0
KEEP_FULL_PERIOD_S = 0.05


class Faults:
    """The hands of the schedule. `do` lasts as long as the fault does, so each needs a thread."""

    def __init__(
        self,
        plant: ChaosPlant,
        files: Path,
        service: ServedService,
        simulators: Sequence[SimulatorProcess],
        proxy: Proxy,
        database: Database,
        disk: Disk,
        history: History,
    ) -> None:
        self._plant = plant
        self._files = files
        self._service = service
        self._simulators = simulators
        self._proxy = proxy
        self._disk = disk
        self._history = history
        self._disk_in_use = Lock()
        self._kinds: dict[str, Callable[[Action], None]] = {
            "kill-service": self._kill_service,
            "kill-gateway": lambda action: self._kill_one_of(self._service.gateways(), action),
            "kill-worker": lambda action: self._kill_one_of(self._service.workers(), action),
            "freeze-service": self._freeze_service,
            "freeze-gateway": lambda action: self._freeze_one_of(self._service.gateways(), action),
            "freeze-worker": lambda action: self._freeze_one_of(self._service.workers(), action),
            "disk-full": self._fill_disk,
            "disk-full-and-kill-gateway": self._fill_disk,
            "disk-full-and-kill-service": self._fill_disk,
            "service-clock-jump": self._jump_service_clock,
            "link-cut": lambda action: self._proxy.cut(action.relay),
            "link-cut-mid-file": self._cut_mid_file,
            "link-frozen": self._freeze_link,
            "link-refused": self._refuse_link,
            "relays-power-cycle": self._power_cycle,
            "file-times-jump": self._jump_file_times,
            **dict.fromkeys(SWITCHED, self._switch),
            **database.faults,
        }

    def do(self, action: Action) -> None:
        """Raises OSError, RuntimeError, errors of the database where the fault itself cannot be made."""
        self._history.note(f"{action.kind} {action.relay} {action.length_s:.1f} s #{action.number}")
        self._kinds[action.kind](action)
        if action.length_s:
            self._history.note(f"{action.kind} {action.relay} #{action.number} is over")

    def _kill_service(self, _action: Action) -> None:
        self._service.kill()

    def _kill_one_of(self, processes: list[int], action: Action) -> None:
        if processes:
            with suppress(ProcessLookupError):
                os.kill(processes[action.number % len(processes)], signal.SIGKILL)

    def _freeze_service(self, action: Action) -> None:
        process_id = self._service.process_id
        self._freeze_one_of([] if process_id is None else [process_id], action)

    def _freeze_one_of(self, processes: list[int], action: Action) -> None:
        if not processes:
            return
        victim = processes[action.number % len(processes)]
        with suppress(ProcessLookupError):
            os.kill(victim, signal.SIGSTOP)
            try:
                time.sleep(action.length_s)
            finally:
                os.kill(victim, signal.SIGCONT)

    def _fill_disk(self, action: Action) -> None:
        with self._disk_in_use:
            try:
                self._keep_full(action.length_s / 2)
                if action.kind.endswith("kill-gateway"):
                    self._kill_one_of(self._service.gateways(), action)
                elif action.kind.endswith("kill-service"):
                    self._service.kill()
                self._keep_full(action.length_s / 2)
            finally:
                self._disk.free()

    def _keep_full(self, length_s: float) -> None:
        """What the service frees meanwhile is taken at once."""
        until_s = time.monotonic() + length_s
        while time.monotonic() < until_s:
            self._disk.fill()
            time.sleep(KEEP_FULL_PERIOD_S)

    def _jump_service_clock(self, action: Action) -> None:
        self._service.clock_offset.write_text(str(CLOCK_JUMPS_S[action.number % len(CLOCK_JUMPS_S)]))
        try:
            time.sleep(action.length_s)
        finally:
            self._service.clock_offset.write_text("0")

    def _cut_mid_file(self, action: Action) -> None:
        self._proxy.cut_after(action.relay, CUT_AFTER_BYTES[action.number % len(CUT_AFTER_BYTES)])

    def _freeze_link(self, action: Action) -> None:
        self._proxy.freeze(action.relay, on=True)
        try:
            time.sleep(action.length_s)
        finally:
            self._proxy.freeze(action.relay, on=False)

    def _refuse_link(self, action: Action) -> None:
        self._proxy.refuse(action.relay, on=True)
        try:
            time.sleep(action.length_s)
        finally:
            self._proxy.refuse(action.relay, on=False)

    def _power_cycle(self, action: Action) -> None:
        simulator = next(each for each in self._simulators if action.relay in each.relays)
        simulator.power_cycle(action.length_s)

    def _jump_file_times(self, action: Action) -> None:
        """As when a relay that tells local time changes to summer time."""
        folder = self._plant.relay(action.relay).folder(self._files)
        if folder is None:
            return
        jump_ns = FILE_TIMES_JUMPS_S[action.number % len(FILE_TIMES_JUMPS_S)] * NANOSECONDS_PER_SECOND
        for path in folder.iterdir():
            with suppress(FileNotFoundError):
                before = path.stat()
                os.utime(path, ns=(before.st_atime_ns, before.st_mtime_ns + jump_ns))

    def _switch(self, action: Action) -> None:
        control = self._plant.relay(action.relay).switch(action.kind)
        if not self._operate(action.relay, control, value=True):
            return
        time.sleep(action.length_s)
        for _ in range(20):  # it must not stay on for the rest of the run
            if self._operate(action.relay, control, value=False):
                return
            time.sleep(1.0)
        self._history.note(f"{action.kind} {action.relay} could not be switched off")

    def _operate(self, relay: str, control: str, *, value: bool) -> bool:
        own = self._plant.relay(relay).own
        try:
            with Client.connect(own.host, own.port, request_timeout_s=REQUEST_LIMIT_S) as client:
                client.operate(control, value)
        except MmsError as error:
            self._history.note(f"{relay}: {control} not operated: {error}")
            return False
        return True
