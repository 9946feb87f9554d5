"""One simulated relay: its model served over MMS, its controls, its event recorder, its view of the motor."""

import logging
import threading
from collections.abc import Callable
from math import inf
from pathlib import Path

from core.units import NANOSECONDS_PER_SECOND
from ied_sim.front import RelayProxies
from ied_sim.misbehaviour import Kind, MisbehaviourState
from ied_sim.monitoring.journal import Journal
from ied_sim.monitoring.metering import Metering
from ied_sim.monitoring.motor_monitor import MotorMonitor
from ied_sim.monitoring.relay_word import RelayWord
from ied_sim.motor.contactor import Closure
from ied_sim.motor.plant import rated_current
from ied_sim.relay.clock import RelayClock
from ied_sim.relay.configuration import RelayConfiguration
from ied_sim.relay.controls import RelayControls
from ied_sim.relay.event_files import EventFiles
from ied_sim.relay.event_recorder import Capture, EventRecorder
from ied_sim.relay.goose import GooseOutlet
from ied_sim.relay.listening import listening_address
from ied_sim.relay.misbehaviour import RelayMisbehaviour
from ied_sim.relay.plant_clock import PlantClock
from ied_sim.relay.points import RelayPoints
from ied_sim.relay.protection import Protection
from ied_sim.relay.record_archive import RecordArchive, RecordOrigin
from ied_sim.relay.record_replacement import RecordReplacement
from ied_sim.relay.server import RelayServer
from ied_sim.relay.settings import relay_settings
from ied_sim.relay.values import RelayValues
from ied_sim.texts import RelaySnapshot, TextMaker, texts
from mms import Identity, Server
from scl import Address, Scl
from scl.model_text import model_text

log = logging.getLogger(__name__)

FREQUENT_UPDATE_PERIOD_S = 0.1
"""Time between updates while a start or a trip may be near."""

OPENING_NS = 40_000_000
"""Time from the command to open until the contactor's current has ended."""

_PULSE_CYCLES = 0.25
_STAGING = ".staging"
_FOLDERS = ("EVENTS", "COMTRADE")
_TRIP_BITS = {"overcurrent": "50P1T", "thermal": "49T", "unbalance": "46UBT"}
_TRIP_KINDS = {"overcurrent": "PHASE 50 TRIP", "thermal": "THERMAL TRIP", "unbalance": "UNBALANCE TRIP"}


class Relay:
    """One relay of an SCD file.

    Parameters
    ----------
    document : Scl
        The SCD file.
    ied_name : str
        Name of the relay's IED.
    configuration : RelayConfiguration
        What kind of relay it is and what it protects.
    address : Address
        Where clients find it.
    files : pathlib.Path
        The simulator's directory. The relay's own files are in files/<IED>.
    clock : PlantClock
        The plant's clock.
    proxies : RelayProxies, optional
        Where it gets a proxy if it needs one.

    Raises
    ------
    SimulatorError
        The scenario asks for what the relay cannot do, or a proxy is needed and not possible.
    SclError, ModelError, OSError
        The model cannot be served, or the directories cannot be made.
    """

    def __init__(
        self,
        document: Scl,
        ied_name: str,
        configuration: RelayConfiguration,
        *,
        address: Address,
        files: Path,
        clock: PlantClock,
        proxies: RelayProxies | None = None,
    ) -> None:
        profile = configuration.profile
        self.name = ied_name
        self._configuration = configuration
        self._epoch_ns = clock.epoch_ns
        self._rated_A = rated_current(configuration.plant.motor)
        self._ied = ied = document.ied(ied_name)
        self._points = RelayPoints(ied, profile)
        if self._points.departures is not None:
            log.warning("%s: %s", ied_name, self._points.departures)
        self.misbehaviour_state = MisbehaviourState(configuration.misbehaviour, clock.running_s)
        self._clock = RelayClock(clock, self.misbehaviour_state, configuration.time_zone)
        self._word = RelayWord()
        self._acting = threading.Lock()
        """Held while a control or a trip does its work: one at a time, whichever thread it is on."""
        self._controls = RelayControls(
            ied_name,
            self._points,
            self._word,
            self.misbehaviour_state,
            publish=lambda values, time_ns: self._values.publish_controls(values, time_ns),
            on_rise=self._on_rise,
            pulse_s=lambda now_ns: (
                _PULSE_CYCLES / configuration.plant.supply.frequency(self._seconds(now_ns))
            ),
            now_ns=self._clock.now_ns,
        )
        self._journal = Journal(
            configuration.recorder.capacity,
            since_ns=clock.epoch_ns,
            profile_every_s=configuration.load_profile_s,
        )
        self._monitor = MotorMonitor(configuration.plant, self._rated_A)
        self._protection = Protection(configuration.protection, self._rated_A)
        self._closure: Closure | None = None
        self._start_noted = True
        self._load_is_above = False
        self._updated_ns = clock.now_ns()
        self.needs_update_soon = False
        """Something has happened that the next look should not be late for."""
        self._settings = relay_settings(ied_name, configuration)
        self._offered: dict[str, TextMaker] = {}
        root, staging = files / ied_name, files / _STAGING / ied_name
        self._event_files = self._make_event_files(root, staging)
        replacement = (
            None
            if self._event_files is None
            else RecordReplacement(self.misbehaviour_state, self._event_files)
        )
        origin = RecordOrigin(
            ied_name, profile.firmware, configuration.plant.supply.direction, self._settings
        )
        self._archive = RecordArchive(
            origin, self._event_files, self._journal, self._word, self._clock, self.misbehaviour_state
        )
        self._recorder = EventRecorder(
            ied_name, configuration.plant, configuration.recorder, clock=clock, store=self._store
        )
        self._relay_server = RelayServer(
            ied_name,
            model_text(document, ied_name),
            self._points,
            profile,
            self._clock,
            address=listening_address(
                ied_name,
                address,
                configuration,
                self.misbehaviour_state,
                proxies,
                report_ids=self._points.report_ids(),
                overflow_server=lambda: self._relay_server.open_overflow_server(),
            ),
            root=root,
            staging=staging,
            operated=self._controls.operate,
            texts={path: self._text(maker) for path, maker in self._offered.items()},
            on_file_request=None if replacement is None else replacement.asked_for_file,
            access=configuration.access,
            identity=Identity(ied.manufacturer, ied.type, profile.firmware),
            misbehaviour_state=self.misbehaviour_state,
        )
        self._values = RelayValues(
            self._relay_server,
            self._points,
            refresh_s=configuration.metering_refresh_s,
        )
        self._misbehaviour = RelayMisbehaviour(
            self.misbehaviour_state,
            self._relay_server,
            self._points,
            profile.report_buffer_bytes,
            self._clock.now_ns,
        )
        self._publish_initial_values(self._clock.now_ns())
        self._relay_server.apply_published()

    @property
    def server(self) -> Server:
        """The relay's MMS server."""
        return self._relay_server.server

    @property
    def serves_itself(self) -> bool:
        """Whether the server has a thread of its own.

        A server that restarts cannot share a pump, and one with TLS handshakes would hold the others up.
        """
        return Kind.RESTART in self.misbehaviour_state.kinds or self._configuration.access.tls is not None

    def publish_goose(self, outlet: GooseOutlet) -> None:
        """Send the GOOSE messages of the relay's control blocks from now on."""
        self._relay_server.publish_goose(self._ied, outlet)

    def stop(self) -> None:
        """Abandon a capture under way. The server itself belongs to its pump."""
        self._controls.stop()
        if self._event_files is not None:
            self._event_files.stop()
        self._recorder.stop()
        self._misbehaviour.stop()
        self._relay_server.close()

    def update(self, time_ns: int) -> float:
        """Update the relay at UTC `time_ns`: meter, protect, keep the journal. Used by one thread.

        It returns the time until the next update [s].
        """
        time_s = self._seconds(time_ns)
        self.needs_update_soon = False
        self._misbehaviour.update()
        metering = self._monitor.measure(time_s)
        self._values.refresh_metering(metering, time_ns)
        closure = self._monitor.closure(time_s)
        self._follow_start(closure, time_s)
        self._journal.add_operation(
            max(0.0, (time_ns - self._updated_ns) * 1e-9),
            metering,
            running=closure is not None,
            starting=not self._start_noted,
        )
        self._updated_ns = time_ns
        tripped = self._protection.update(metering, time_s)
        if closure is not None and tripped:
            with self._acting:
                self._trip(tripped, time_ns)
        self._journal.add_load_row(time_ns, metering, self._protection.thermal_capacity)
        self._check_load_trigger(metering, time_ns)
        if self._start_noted and not self._needs_frequent_updates:
            return self._configuration.metering_period_s
        return FREQUENT_UPDATE_PERIOD_S

    def update_metering(self, time_ns: int) -> None:
        """Meter the motor at UTC `time_ns` and publish the values, which clients see on return."""
        self._values.publish_metering(self._monitor.measure(self._seconds(time_ns)), time_ns)
        self._relay_server.apply_published()

    @property
    def _needs_frequent_updates(self) -> bool:
        protection = self._configuration.protection
        return bool(self.misbehaviour_state.kinds or protection.overcurrent or protection.unbalance)

    def _seconds(self, time_ns: int) -> float:
        return (time_ns - self._epoch_ns) * 1e-9

    # Events

    def _on_rise(self, reference: str, now_ns: int) -> None:
        """Do what a control is for; runs in a pump's thread."""
        with self._acting:
            self._act(reference, now_ns)

    def _act(self, reference: str, now_ns: int) -> None:
        if reference in self._points.triggers:
            number = self._points.remote_bit(reference)
            self._trigger(now_ns, "ER TRIG (RCDTRG)" if number is None else f"ER TRIG (RB{number})")
        elif reference == self._points.control("start"):
            self._start_motor(now_ns)
        elif reference == self._points.control("stop"):
            self._stop_motor(now_ns)
        elif reference == self._points.control("clear"):
            self._archive.clear()

    def _start_motor(self, now_ns: int) -> None:
        contactor = self._configuration.plant.contactor
        closed_s = None if contactor is None else contactor.close(self._seconds(now_ns))
        if closed_s is None:
            return
        closed_ns = self._epoch_ns + round(closed_s * NANOSECONDS_PER_SECOND)
        log.info("%s: the motor is started", self.name)
        self.needs_update_soon = True
        for bit in ("TRIP", *_TRIP_BITS.values(), "STOPPED"):
            self._word.set(bit, False, closed_ns)  # noqa: FBT003
        self._word.set("STARTING", True, closed_ns)  # noqa: FBT003
        self._values.publish_status(dict.fromkeys(("trip", *_TRIP_BITS), False), now_ns)
        if self._configuration.triggers.motor_start:
            self._trigger(now_ns, "ER MOTOR START")

    def _stop_motor(self, now_ns: int) -> None:
        contactor = self._configuration.plant.contactor
        open_ns = now_ns + OPENING_NS
        if contactor is None or not contactor.open(self._seconds(open_ns)):
            return
        self._note_stopped(open_ns)

    def _note_stopped(self, open_ns: int) -> None:
        if self._word["STOPPED"]:
            return
        log.info("%s: the motor is stopped", self.name)
        self._word.set("STARTING", False, open_ns)  # noqa: FBT003
        self._word.set("RUNNING", False, open_ns)  # noqa: FBT003
        self._word.set("STOPPED", True, open_ns)  # noqa: FBT003

    def _trip(self, elements: list[str], now_ns: int) -> None:
        log.info("%s: trip: %s", self.name, ", ".join(elements))
        self._word.set("TRIP", True, now_ns)  # noqa: FBT003
        for element in elements:
            self._journal.add_trip(element)
            self._word.set(_TRIP_BITS[element], True, now_ns)  # noqa: FBT003
        self._values.publish_status(dict.fromkeys(("trip", *elements), True), now_ns)
        self._stop_motor(now_ns)
        if self._configuration.triggers.trip:
            self._trigger(now_ns, _TRIP_KINDS[elements[0]])

    def _check_load_trigger(self, metering: Metering, now_ns: int) -> None:
        level = self._configuration.triggers.load_above
        above = level is not None and self._start_noted and metering.current_A > level * self._rated_A
        if above and not self._load_is_above:
            self._trigger(now_ns, "ER LOAD")
        self._load_is_above = above

    def _follow_start(self, closure: Closure | None, time_s: float) -> None:
        """Note a stop that no control asked for, and add a start to the journal once it has ended."""
        if closure is None and self._closure is not None and self._closure.opened_s < inf:
            self._note_stopped(self._epoch_ns + round(self._closure.opened_s * NANOSECONDS_PER_SECOND))
        if closure != self._closure and closure is not None and closure.closed_s >= 0:
            self._start_noted = False
        self._closure = closure
        if self._start_noted or closure is None:
            self._start_noted = True
            return
        start = self._monitor.start(closure)
        lasted_s = float(start.time_s[-1]) if start.duration_s is None else start.duration_s
        if time_s >= closure.closed_s + lasted_s:
            self._start_noted = True
            self._journal.add_start(self._epoch_ns + round(closure.closed_s * NANOSECONDS_PER_SECOND), start)
            end_ns = self._epoch_ns + round((closure.closed_s + lasted_s) * NANOSECONDS_PER_SECOND)
            self._word.set("STARTING", False, end_ns)  # noqa: FBT003
            self._word.set("RUNNING", True, end_ns)  # noqa: FBT003

    def _trigger(self, now_ns: int, kind: str) -> None:
        def on_start() -> None:
            self._word.pulse("ER", now_ns, 5_000_000)
            self._values.publish_status({"record_made": False, "record_started": True}, now_ns)

        self._recorder.trigger(now_ns, kind, on_start=on_start)

    def _store(self, capture: Capture) -> None:
        """Store a record and report it to the clients; runs in the capture's thread."""
        number = self._archive.store(capture)
        log.info("%s: event record %d is complete", self.name, number)
        self._values.publish_status(
            {"record_number": number, "record_made": True, "record_started": False}, self._clock.now_ns()
        )

    def _publish_initial_values(self, now_ns: int) -> None:
        """Publish what clients see before anything has happened; the first update measures."""
        self._controls.publish_all(now_ns)
        fallen = dict.fromkeys(("record_made", "record_started", "trip", *_TRIP_BITS), False)
        self._values.publish_status({**fallen, "record_number": self._archive.last_number or 0}, now_ns)
        self._closure = self._monitor.closure(self._seconds(now_ns))
        self._word.set("STOPPED" if self._closure is None else "RUNNING", True, now_ns)  # noqa: FBT003
        self._updated_ns = now_ns

    # Parts

    def _make_event_files(self, root: Path, staging: Path) -> EventFiles | None:
        profile = self._configuration.profile
        staging.mkdir(parents=True, exist_ok=True)
        root.mkdir(parents=True, exist_ok=True)
        if profile.files is None:
            return None
        self._offered = texts(profile.files.reports, settings=profile.files.settings)
        return EventFiles(
            root / profile.files.folder,
            staging,
            capacity=self._configuration.recorder.capacity,
            prefix=profile.files.name,
            formats=profile.record.written(),
            second=root / next(name for name in _FOLDERS if name != profile.files.folder),
            keep_latest=Kind.RECORD_REPLACED in self.misbehaviour_state.kinds,
        )

    def _text(self, maker: TextMaker) -> Callable[[], bytes]:
        return lambda: maker(self._snapshot(self._clock.now_ns()))

    def _snapshot(self, now_ns: int) -> RelaySnapshot:
        return RelaySnapshot(
            relay=self.name,
            firmware=self._configuration.profile.firmware,
            motor=self._configuration.plant.motor,
            rated_current_A=self._rated_A,
            journal=self._journal,
            word=self._word,
            settings=self._settings,
            now_ns=now_ns,
            offset_ns=self._clock.written(now_ns) - now_ns,
        )
