"""The event recorder: one trigger, one record, in real time."""

import logging
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from datetime import UTC, datetime

from core.recordings import Channel, Quantity, Recording
from ied_sim.event_files import EventFiles
from ied_sim.plant import MotorPlant
from ied_sim.scenario import RecorderSettings
from ied_sim.sensors import CHANNELS

log = logging.getLogger(__name__)

FIRMWARE = "SEL-710-SIM-R100-V0-Z001001-D20250101"


@dataclass(frozen=True, slots=True)
class EventRecord:
    """A record that is complete on the relay's disk."""

    number: int
    trigger_time_ns: int


class EventRecorder:
    """Captures `plant` around each trigger and calls `announce` once the record can be fetched.

    epoch_ns: UTC of the plant's time zero. A capture ends the post-trigger time after its trigger, as in a
    relay that has to wait for its samples; a trigger meanwhile makes no second record. `announce` is called
    in the capture's own thread.
    """

    def __init__(
        self,
        relay_name: str,
        plant: MotorPlant,
        settings: RecorderSettings,
        files: EventFiles,
        *,
        epoch_ns: int,
        announce: Callable[[EventRecord], None],
    ) -> None:
        self._relay_name = relay_name
        self._plant = plant
        self._settings = settings
        self._files = files
        self._epoch_ns = epoch_ns
        self._announce = announce
        self._lock = threading.Lock()
        self._stopping = threading.Event()
        self._capturing = False
        self._capture = threading.Thread()

    def trigger(self, time_ns: int) -> bool:
        """Start a capture at UTC `time_ns`; False if one is under way or the recorder has stopped."""
        with self._lock:
            if self._capturing or self._stopping.is_set():
                return False
            self._capturing = True
            self._capture = threading.Thread(
                target=self._run, args=(time_ns,), name=f"{self._relay_name} capture", daemon=True
            )
            self._capture.start()
        log.info("%s: event recorder triggered", self._relay_name)
        return True

    def stop(self) -> None:
        """Abandon a capture under way and wait until it is gone."""
        with self._lock:
            self._stopping.set()
        if self._capture.ident is not None:
            self._capture.join()

    def _run(self, trigger_ns: int) -> None:
        try:
            record = self._capture_event(trigger_ns)
            if record is not None:
                self._announce(record)
        finally:
            self._capturing = False

    def _capture_event(self, trigger_ns: int) -> EventRecord | None:
        """Simulate at once, then wait for the samples' own time; None where nothing came of it."""
        recording = self._record(trigger_ns)
        complete_ns = trigger_ns + round(self._settings.post_trigger_s * 1e9)
        if self._stopping.wait(max(0.0, (complete_ns - time.time_ns()) * 1e-9)):
            return None
        try:
            number = self._files.store(recording, self._summary(recording))
        except OSError:
            log.exception("%s: an event record is lost: it cannot be written", self._relay_name)
            return None
        log.info("%s: event record %d is complete", self._relay_name, number)
        return EventRecord(number, trigger_ns)

    def _record(self, trigger_ns: int) -> Recording:
        settings, plant = self._settings, self._plant
        rate_hz = settings.sample_rate_hz
        before = round(settings.pre_trigger_s * rate_hz)
        start_ns = trigger_ns - round(before / rate_hz * 1e9)
        duration_s = settings.pre_trigger_s + settings.post_trigger_s
        return Recording(
            samples=plant.window((start_ns - self._epoch_ns) * 1e-9, duration_s, rate_hz),
            sample_rate_hz=rate_hz,
            start_time_ns=start_ns,
            channels=_channels(plant),
            trigger_index=before,
            nominal_frequency_hz=plant.motor.nameplate.rated_frequency_Hz,
            station=self._relay_name,
            device=FIRMWARE,
        )

    def _summary(self, recording: Recording) -> str:
        """The .HDR file: what a relay's event summary tells, in plain text."""
        trigger_ns = recording.trigger_time_ns
        seconds, nanoseconds = divmod(trigger_ns, 1_000_000_000)
        trigger = datetime.fromtimestamp(seconds, UTC).strftime("%Y-%m-%d %H:%M:%S")
        frequency_hz = self._plant.supply.frequency((trigger_ns - self._epoch_ns) * 1e-9)
        return (
            f"RELAY     {self._relay_name}\r\n"
            f"FID       {FIRMWARE}\r\n"
            f"EVENT     ER TRIG (RB01)\r\n"
            f"TRIGGER   {trigger}.{nanoseconds:09d} UTC\r\n"
            f"FREQ      {frequency_hz:.2f} Hz\r\n"
            f"SAMPLES   {recording.samples.shape[1]} at {recording.sample_rate_hz:g} Hz\r\n"
        )


def _channels(plant: MotorPlant) -> tuple[Channel, ...]:
    currents = (Quantity.CURRENT, "A", plant.sensors.full_scale_A)
    voltages = (Quantity.PHASE_VOLTAGE, "V", plant.sensors.full_scale_V)
    return tuple(
        Channel(name=name, quantity=quantity, phase=name[1].lower(), unit=unit, full_scale=full_scale)
        for name, (quantity, unit, full_scale) in zip(CHANNELS, [currents] * 3 + [voltages] * 3, strict=True)
    )
