"""The event recorder: one record for each trigger, in real time."""

import logging
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, replace

from core.recordings import Channel, Quantity, Recording
from core.units import NANOSECONDS_PER_SECOND
from ied_sim.motor.plant import MotorPlant
from ied_sim.motor.sensors import CHANNELS
from ied_sim.motor.trajectory import Trajectory
from ied_sim.relay.plant_clock import PlantClock

log = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True)
class RecorderSettings:
    """What an event record spans, and how many records the relay keeps."""

    sample_rate_hz: float = 10_000.0
    pre_trigger_s: float = 0.2
    post_trigger_s: float = 0.8
    capacity: int = 20


@dataclass(frozen=True, slots=True)
class Capture:
    """Analogue channels around a trigger at `time_ns`, and the relay's name for the event."""

    time_ns: int
    kind: str
    recording: Recording


class EventRecorder:
    """Captures `plant` around each trigger and passes the capture to `store` after its last sample.

    A capture ends the post-trigger time after its trigger, as in a relay that has to wait for its samples. A
    trigger meanwhile makes no second record. A trigger soon after makes one that goes on where this one was,
    with waveforms in common as far as its pre-trigger time reaches back. `store` is called in the capture's
    own thread, one capture after the other.
    """

    def __init__(
        self,
        relay_name: str,
        plant: MotorPlant,
        settings: RecorderSettings,
        *,
        clock: PlantClock,
        store: Callable[[Capture], None],
    ) -> None:
        self._relay_name = relay_name
        self._plant = replace(plant, trajectory=Trajectory())
        self._settings = settings
        self._clock = clock
        self._store = store
        self._lock = threading.Lock()
        self._stopping = threading.Event()
        self._capturing = False
        self._capture: threading.Thread | None = None

    def trigger(self, time_ns: int, kind: str, *, on_start: Callable[[], None]) -> bool:
        """Start a capture at `time_ns`; return False if one is under way or the recorder has stopped.

        `on_start` is called when the capture is sure to begin, and returns before its record can be complete.
        """
        with self._lock:
            if self._capturing or self._stopping.is_set():
                return False
            self._capturing = True
        # The lock is not held here: on_start may wait for a thread that wants to trigger.
        on_start()
        with self._lock:
            if self._stopping.is_set():
                return False
            self._capture = threading.Thread(
                target=self._run,
                args=(time_ns, kind, self._capture),
                name=f"{self._relay_name} capture",
                daemon=True,
            )
            self._capture.start()
        log.info("%s: event recorder triggered: %s", self._relay_name, kind)
        return True

    def stop(self) -> None:
        """Abandon a capture under way and wait until all are stored."""
        with self._lock:
            self._stopping.set()
        if self._capture is not None:
            self._capture.join()

    def _run(self, trigger_ns: int, kind: str, before: threading.Thread | None) -> None:
        try:
            recording = self._capture_event(trigger_ns)
        finally:
            self._capturing = False
        if before is not None:
            before.join()  # records appear in their order
        if recording is None:
            return
        try:
            self._store(Capture(trigger_ns, kind, recording))
        except OSError:
            log.exception("%s: an event record is lost: it cannot be written", self._relay_name)

    def _capture_event(self, trigger_ns: int) -> Recording | None:
        """Simulate at once and wait for the samples' own time.

        The capture is simulated again if the motor was switched meanwhile.
        """
        switched = self._switching(trigger_ns)
        recording = self._record(trigger_ns)
        length_ns = round(self._settings.post_trigger_s * NANOSECONDS_PER_SECOND)
        complete_ns = self._clock.real_ns(trigger_ns) + length_ns
        if self._stopping.wait(max(0.0, (complete_ns - time.time_ns()) * 1e-9)):
            return None
        return recording if self._switching(trigger_ns) == switched else self._record(trigger_ns)

    def _switching(self, trigger_ns: int) -> object:
        begin_s = (trigger_ns - self._clock.epoch_ns) * 1e-9 - self._settings.pre_trigger_s
        end_s = begin_s + self._settings.pre_trigger_s + self._settings.post_trigger_s
        return self._plant.contactor and self._plant.contactor.closures(begin_s, end_s)

    def _record(self, trigger_ns: int) -> Recording:
        settings, plant = self._settings, self._plant
        rate_hz = settings.sample_rate_hz
        before = round(settings.pre_trigger_s * rate_hz)
        start_ns = trigger_ns - round(before / rate_hz * NANOSECONDS_PER_SECOND)
        duration_s = settings.pre_trigger_s + settings.post_trigger_s
        return Recording(
            samples=plant.window((start_ns - self._clock.epoch_ns) * 1e-9, duration_s, rate_hz),
            sample_rate_hz=rate_hz,
            start_time_ns=start_ns,
            channels=_channels(plant),
            trigger_index=before,
            nominal_frequency_hz=plant.motor.nameplate.rated_frequency_Hz,
            station=self._relay_name,
        )


def _channels(plant: MotorPlant) -> tuple[Channel, ...]:
    currents = (Quantity.CURRENT, "A", plant.sensors.full_scale_A)
    voltages = (Quantity.PHASE_VOLTAGE, "V", plant.sensors.full_scale_V)
    return tuple(
        Channel(name=name, quantity=quantity, phase=name[1].lower(), unit=unit, full_scale=full_scale)
        for name, (quantity, unit, full_scale) in zip(CHANNELS, [currents] * 3 + [voltages] * 3, strict=True)
    )
