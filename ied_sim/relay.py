"""One simulated relay: its data model served over MMS, its remote bits, its event recorder, its meters."""

import cmath
import time
from collections.abc import Mapping
from math import degrees
from pathlib import Path

from ied_sim.errors import SimulatorError
from ied_sim.event_files import EventFiles
from ied_sim.event_recorder import EventRecord, EventRecorder
from ied_sim.metering import meter, metered_values
from ied_sim.scenario import RelayScenario
from mms import GOOD, ControlAction, Quality, Server, Timestamp, Value
from scl import Address, Scl
from scl.model_text import model_text

RECORD_MADE = "PRO/FLTRDRE1.RcdMade"
RECORD_NUMBER = "PRO/FLTRDRE1.FltNum"
TRIP = "PRO/TRIPPTRC1.Tr"
TRIGGER_BIT = "CON/RBGGIO1.SPCSO01"

_STAGING = ".staging"


class Relay:
    """The relay `ied_name` of an SCD file, protecting what its scenario says.

    files: the simulator's directory; the relay's own files are in files/<IED>. epoch_ns: UTC of the plant's
    time zero. RB01 going from false to true triggers the event recorder; remote bits stay as operated.
    RcdMade falls with each trigger and rises when the record can be fetched.
    Raises SimulatorError where the data model is not that of such a relay; SclError, ModelError, OSError.
    """

    def __init__(
        self,
        document: Scl,
        ied_name: str,
        scenario: RelayScenario,
        *,
        address: Address,
        files: Path,
        epoch_ns: int,
    ) -> None:
        ied = document.ied(ied_name)
        for reference in (RECORD_MADE, RECORD_NUMBER, TRIP, TRIGGER_BIT):
            if ied.find(reference) is None:
                raise SimulatorError(
                    f"{document.path}: {ied_name} has no {reference}, so it is no SEL-710; "
                    "choose the relays to simulate with --ied"
                )
        self.name = ied_name
        self._plant = scenario.plant
        self._epoch_ns = epoch_ns
        self._domains = {device.inst: device.name for device in ied.logical_devices}
        event_files = EventFiles(files / ied_name, files / _STAGING / ied_name, scenario.recorder.capacity)
        self._recorder = EventRecorder(
            ied_name,
            scenario.plant,
            scenario.recorder,
            event_files,
            epoch_ns=epoch_ns,
            announce=self._announce,
        )
        self.server = Server(
            model_text(document, ied_name),
            address=address.host,
            port=address.port,
            file_root=files / ied_name,
        )
        self._trigger_bit = self._reference(TRIGGER_BIT)
        bits = [placed.reference for placed in ied.data_objects(ln_class="GGIO", common_data_class="SPC")]
        self._bits = dict.fromkeys(bits, False)
        for reference in bits:
            self.server.on_operate(reference, self._operate)

        statuses: dict[str, Value] = {f"{reference}.stVal": False for reference in bits}
        statuses[self._reference(f"{RECORD_MADE}.stVal")] = False
        statuses[self._reference(f"{RECORD_NUMBER}.stVal")] = event_files.last_number or 0
        statuses[self._reference(f"{TRIP}.general")] = False
        now_ns = time.time_ns()
        self._publish(statuses, now_ns)
        possible = self._measurements(now_ns)
        self._measured = [reference for reference in possible if ied.find(reference) is not None]
        self.update_metering(now_ns)

    def stop(self) -> None:
        """Abandon a capture under way; the server itself belongs to its pump."""
        self._recorder.stop()

    def update_metering(self, time_ns: int) -> None:
        """Meter the motor at UTC `time_ns` and publish the values."""
        values = self._measurements(time_ns)
        self._publish({reference: values[reference] for reference in self._measured}, time_ns)

    def _operate(self, action: ControlAction) -> bool:
        """Set or clear a remote bit, unless it is but a test; runs in the pump's thread."""
        if action.test:
            return True
        now_ns = time.time_ns()
        value = bool(action.value)
        rises = value and not self._bits[action.reference]
        self._bits[action.reference] = value
        changes: dict[str, Value] = {f"{action.reference}.stVal": value}
        if rises and action.reference == self._trigger_bit and self._recorder.trigger(now_ns):
            changes[self._reference(f"{RECORD_MADE}.stVal")] = False
        self._publish(changes, now_ns)
        return True

    def _announce(self, record: EventRecord) -> None:
        """Tell the clients of a record; runs in the capture's thread."""
        made: dict[str, Value] = {
            self._reference(f"{RECORD_NUMBER}.stVal"): record.number,
            self._reference(f"{RECORD_MADE}.stVal"): True,
        }
        self._publish(made, time.time_ns())

    def _measurements(self, time_ns: int) -> dict[str, Value]:
        """Every attribute a metering data object may have, by reference."""
        attributes: dict[str, Value] = {}
        for inst_reference, value in metered_values(
            meter(self._plant, (time_ns - self._epoch_ns) * 1e-9)
        ).items():
            reference = self._reference(inst_reference)
            if isinstance(value, complex):
                for vector in ("instCVal", "cVal"):
                    attributes[f"{reference}.{vector}.mag.f"] = abs(value)
                    attributes[f"{reference}.{vector}.ang.f"] = degrees(cmath.phase(value))
            else:
                for magnitude in ("instMag", "mag"):
                    attributes[f"{reference}.{magnitude}.f"] = value
        return attributes

    def _publish(self, values: Mapping[str, Value], time_ns: int) -> None:
        """Update attributes as one change, with quality and time of their data objects."""
        changes: dict[str, Value | Quality] = dict(values)
        for reference in values:
            data_object = _data_object(reference)
            changes[f"{data_object}.q"] = GOOD
            changes[f"{data_object}.t"] = Timestamp(time_ns)
        self.server.update_many(changes)

    def _reference(self, reference: str) -> str:
        """The reference clients use, with the domain in place of the logical device's inst."""
        inst, _, rest = reference.partition("/")
        return f"{self._domains[inst]}/{rest}"


_VALUE_ATTRIBUTES = frozenset({"stVal", "general", "instMag", "mag", "instCVal", "cVal"})


def _data_object(attribute: str) -> str:
    """Reference of the data object that a value attribute belongs to."""
    names = attribute.split(".")
    return ".".join(names[: next(place for place, name in enumerate(names) if name in _VALUE_ATTRIBUTES)])
