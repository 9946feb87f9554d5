"""Storage of captures: files, an entry in the journal, the record's number."""

from dataclasses import dataclass, replace
from datetime import UTC, datetime

import numpy as np

from core.recordings import Recording
from core.recordings.cev.writer import EventSummary
from core.recordings.waveform import Digitals
from core.units import NANOSECONDS_PER_SECOND
from ied_sim.misbehaviour import Kind, MisbehaviourState
from ied_sim.monitoring.journal import Event, Journal
from ied_sim.monitoring.metering import METERING_CYCLES, Metering, metered
from ied_sim.monitoring.relay_word import BITS, RelayWord
from ied_sim.relay.clock import RelayClock
from ied_sim.relay.event_files import FIRST_NUMBER, EventFiles
from ied_sim.relay.event_recorder import Capture

WORDS_PER_CYCLE = 4
TARGET_BITS = ("50P1T", "49T", "46UBT")


@dataclass(frozen=True, slots=True)
class RecordOrigin:
    """What every record says of its relay. The direction is +1 for abc, -1 for acb."""

    relay: str
    firmware: str
    direction: int
    settings: tuple[tuple[str, str], ...]


class RecordArchive:
    """Stores the captures of one relay, one at a time. Without `files` it only counts."""

    def __init__(
        self,
        origin: RecordOrigin,
        files: EventFiles | None,
        journal: Journal,
        word: RelayWord,
        clock: RelayClock,
        misbehaviour_state: MisbehaviourState,
    ) -> None:
        self._origin = origin
        self._files = files
        self._journal = journal
        self._word = word
        self._clock = clock
        self._misbehaviour_state = misbehaviour_state
        self.last_number = None if files is None else files.last_number

    def store(self, capture: Capture) -> int:
        """Store a capture and return its number. Raise OSError where it cannot be written."""
        metering = _at_trigger(capture.recording, self._origin.direction)
        record = self._complete(capture.recording)
        targets = " ".join(bit for bit in TARGET_BITS if self._word[bit])
        if self._files is None:
            number = self._number()
        else:
            number = self._files.store(
                record,
                self._header(record, capture.kind, metering),
                self._summary(record, capture.kind, targets, metering),
                utc_offset_min=self._clock.ahead_ns(capture.time_ns) // (60 * NANOSECONDS_PER_SECOND),
                grow_s=self._misbehaviour_state.number(Kind.GROWING_FILE) or 0.0,
                in_second=self._misbehaviour_state.is_on(Kind.TWO_FOLDERS) and self._number() % 2 == 1,
            )
        self.last_number = number
        self._journal.add_event(Event(number, capture.time_ns, capture.kind, metering, targets))
        return number

    def _number(self) -> int:
        """Return the number of the next record."""
        return FIRST_NUMBER if self.last_number is None else self.last_number + 1

    def clear(self) -> None:
        """Delete all records."""
        if self._files is not None:
            self._files.clear()
        self._journal.clear_events()

    def _complete(self, recording: Recording) -> Recording:
        """Add the relay word beside the samples, and put the times into the relay's own."""
        elapsed_ns = np.rint(recording.time_s * NANOSECONDS_PER_SECOND).astype(np.int64)
        times_ns = recording.first_time_ns + elapsed_ns
        return replace(
            recording,
            device=self._origin.firmware,
            digitals=Digitals.of(BITS, self._word.states(times_ns)),
            start_time_ns=self._clock.written(recording.first_time_ns),
        )

    def _header(self, record: Recording, kind: str, metering: Metering) -> str:
        """Return the .HDR file: the relay's event summary in plain text."""
        seconds, nanoseconds = divmod(record.trigger_time_ns, NANOSECONDS_PER_SECOND)
        trigger = datetime.fromtimestamp(seconds, UTC).strftime("%Y-%m-%d %H:%M:%S")
        zone = "local" if self._clock.is_local else "UTC"
        return (
            f"RELAY     {self._origin.relay}\r\n"
            f"FID       {self._origin.firmware}\r\n"
            f"EVENT     {kind}\r\n"
            f"TRIGGER   {trigger}.{nanoseconds:09d} {zone}\r\n"
            f"FREQ      {metering.frequency_Hz:.2f} Hz\r\n"
            f"SAMPLES   {record.samples.shape[1]} at {record.sample_rate_hz:g} Hz\r\n"
        )

    def _summary(self, record: Recording, kind: str, targets: str, metering: Metering) -> EventSummary:
        per_cycle = max(1, round(record.sample_rate_hz / (record.nominal_frequency_hz or 50.0)))
        currents, voltages = np.abs(metering.currents_A), np.abs(metering.phase_voltages_V)
        names = [f"{quantity}{phase}" for quantity in "IV" for phase in "ABC"]
        return EventSummary(
            samples_per_cycle=per_cycle,
            digital_samples_per_cycle=next(n for n in (WORDS_PER_CYCLE, 2, 1) if per_cycle % n == 0),
            event=kind,
            targets=targets,
            figures=dict(zip(names, np.round([*currents, *voltages], 3).tolist(), strict=True)),
            settings="\r\n".join(f"{name} := {value}" for name, value in self._origin.settings),
        )


def _at_trigger(recording: Recording, direction: int) -> Metering:
    """Return the phasors of the first cycles after the trigger, of as many as there are."""
    frequency_Hz = recording.nominal_frequency_hz or 50.0
    span = round(METERING_CYCLES / frequency_Hz * recording.sample_rate_hz)
    first = min(recording.trigger_index or 0, max(0, recording.samples.shape[1] - span))
    samples = recording.samples[:, first : first + span]
    return metered(samples, frequency_Hz, recording.sample_rate_hz, direction)
