"""The table of starts: what each shows of current, voltage, torque, heat and rotor."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from operator import attrgetter
from typing import Final

from core.starts.compared import Change, Quantity, StartChanges
from core.starts.examined import ExaminedStart
from service.exports.paging import pages
from service.exports.tables import Column, Table, number, text, time, whole
from service.storage.records import StartEntry, StartReference
from service.storage.repository import Repository

PAGE = 100
"""A start comes with its curves."""

MEANINGS: Final[Mapping[Quantity, str]] = {
    Quantity.ACCELERATION: "change of the acceleration time since the first starts, a share of it",
    Quantity.VOLTAGE: "change of the least voltage, a share of it",
    Quantity.LOAD: "change of the load's torque, over the rated one",
    Quantity.ROTOR: "change of the rotor's resistance less what is common with the winding's, a share",
    Quantity.WARMTH: "change of the winding's resistance, a share of it",
}


@dataclass(frozen=True, slots=True)
class ToldStart:
    """A start and what is told of it beside others.

    within_hour: starts in the hour that ends with it.  changes: how it differs from the first ones; None of
    those, and of reported ones beside recorded ones.
    """

    entry: StartEntry
    within_hour: int
    changes: StartChanges | None


def _figure(name: str, unit: str, meaning: str) -> Column[ToldStart]:
    return number(name, unit, meaning, lambda told: getattr(told.entry.filled.figures, name))


def _of(part: str, name: str, unit: str, meaning: str, *, column: str | None = None) -> Column[ToldStart]:
    """Return a column of a part of a start that a record may not tell; column: its name, if another."""
    return number(column or name, unit, meaning, lambda told: _told(told.entry.filled, part, name))


def _end(part: str, name: str, end: int, unit: str, *, column: str) -> Column[ToldStart]:
    """Return a column of an end of an interval."""
    which = ("lower", "upper")[end]

    def value(told: ToldStart) -> object:
        interval = _told(told.entry.filled, part, name)
        return interval[end] if isinstance(interval, tuple) else None

    return number(column, unit, f"{which} bound of its 95 % interval", value)


def _told(start: ExaminedStart, part: str, name: str) -> object:
    return getattr(getattr(start, part), name, None)


_PARAMETERS = (
    ("stator_resistance_ohm", "ohm", "R_s"),
    ("rotor_resistance_ohm", "ohm", "R_r'"),
    ("stator_leakage_H", "H", "leakage inductance of the stator"),
    ("rotor_leakage_H", "H", "leakage inductance of the rotor"),
    ("stator_self_inductance_H", "H", "self-inductance of the stator"),
)


def _parameter(name: str, unit: str, meaning: str) -> Iterator[Column[ToldStart]]:
    """Yield the columns of a parameter by the start, and of its interval where the start tells it."""

    def end(which: int, told: ToldStart) -> float | None:
        found = told.entry.filled.parameters
        interval = None if found is None else found.ci95.get(name)
        return None if interval is None else interval[which]

    def value(told: ToldStart) -> float | None:
        found = told.entry.filled.parameters
        return None if found is None else found.values.get(name)

    yield number(name, unit, f"{meaning}, by this start", value)
    missing = "empty where it was held at the motor's"
    yield number(f"{name}_ci95_low", unit, f"lower bound of its 95 % interval, {missing}", partial(end, 0))
    yield number(f"{name}_ci95_high", unit, f"upper bound of its 95 % interval, {missing}", partial(end, 1))


def _causes(told: ToldStart, which: str) -> str:
    return " ".join(getattr(told.changes, which, ()))


def _change(quantity: Quantity) -> Iterator[Column[ToldStart]]:
    """Yield the columns of a change since the first starts, and of its interval."""

    def change(told: ToldStart) -> Change | None:
        changes = () if told.changes is None else told.changes.changes
        return next((one for one in changes if one.quantity is quantity), None)

    def value(told: ToldStart) -> float | None:
        found = change(told)
        return None if found is None else found.change

    def end(which: int, told: ToldStart) -> float | None:
        found = change(told)
        return None if found is None else found.ci95[which]

    name = f"{quantity}_change"
    yield number(name, "1", MEANINGS[quantity], value)
    yield number(f"{name}_ci95_low", "1", "lower bound of its 95 % interval", partial(end, 0))
    yield number(f"{name}_ci95_high", "1", "upper bound of its 95 % interval", partial(end, 1))


TABLE: Table[ToldStart] = Table(
    "starts",
    (
        text("motor", "motor", attrgetter("entry.motor")),
        time("time", "when the motor was switched on", attrgetter("entry.time_ns")),
        text("source", "what tells of it: recording or report", attrgetter("entry.source")),
        whole(
            "is_from_rest",
            "",
            "1 where the motor is seen to be switched on, 0 where the record begins within the start",
            attrgetter("entry.filled.figures.is_from_rest"),
        ),
        _figure("acceleration_s", "s", "time of the run-up"),
        _figure("peak_current_A", "A", "greatest rms of the line currents over one cycle"),
        _figure("mean_current_A", "A", "rms current over the acceleration time"),
        _figure("crest_current_A", "A", "greatest instantaneous current"),
        _figure("running_current_A", "A", "rms current once the motor runs"),
        _figure("lowest_voltage_V", "V", "least rms voltage over one cycle, line to line"),
        _figure("i2t_A2s", "A^2 s", "integral of the current's square"),
        _figure("i2t_over_s", "s", "length of that integral"),
        text(
            "from_report",
            "figures that the record does not show, and the relay's report of the same start tells",
            lambda told: " ".join(told.entry.from_report),
        ),
        _of(
            "stress",
            "share_of_hot",
            "1",
            "I2t over what the rotor withstands from running temperature",
            column="share_of_hot_limit",
        ),
        _of(
            "stress",
            "share_of_cold",
            "1",
            "I2t over what the rotor withstands from cold",
            column="share_of_cold_limit",
        ),
        whole(
            "starts_allowed",
            "1",
            "starts that the motor file allows within an hour",
            lambda told: _told(told.entry.filled, "stress", "starts_per_hour"),
        ),
        whole(
            "starts_within_hour",
            "1",
            "starts in the hour that ends with this one",
            attrgetter("within_hour"),
        ),
        text(
            "comparison",
            "beside the first starts: as-before, changed, not-told-apart or unknown; empty for those",
            lambda told: None if told.changes is None else told.changes.state,
        ),
        text("causes", "why it is other than the first starts", lambda told: _causes(told, "causes")),
        text("possible_causes", "causes that are not told apart", lambda told: _causes(told, "possible")),
        *(column for quantity in Quantity for column in _change(quantity)),
        _of("torque", "mean_torque_Nm", "N m", "mean torque of the air gap"),
        _of("torque", "load_torque_Nm", "N m", "mean torque of the load"),
        _end("torque", "load_torque_Nm_ci95", 0, "N m", column="load_torque_Nm_ci95_low"),
        _end("torque", "load_torque_Nm_ci95", 1, "N m", column="load_torque_Nm_ci95_high"),
        text(
            "rotor_state",
            "what the start shows of the rotor's cage",
            lambda told: _told(told.entry.filled, "sideband", "state"),
        ),
        _of("sideband", "severity_dB", "dB", "rotor bar severity", column="rotor_severity_dB"),
        _end("sideband", "severity_dB_ci95", 0, "dB", column="rotor_severity_dB_ci95_low"),
        _end("sideband", "severity_dB_ci95", 1, "dB", column="rotor_severity_dB_ci95_high"),
        _of(
            "sideband",
            "detection_limit_dB",
            "dB",
            "severity that the start would show",
            column="rotor_detection_limit_dB",
        ),
        *(column for parameter in _PARAMETERS for column in _parameter(*parameter)),
        text("remark", "why the motor's model tells nothing of it", attrgetter("entry.filled.remark")),
        text(
            "recording_id",
            "its recording; empty where a report alone tells it",
            attrgetter("entry.recording"),
        ),
        text("start_id", "id of the start", attrgetter("entry.recording_id")),
    ),
)


def starts(repository: Repository, motors: Sequence[str] | None) -> Iterator[Sequence[ToldStart]]:
    """Return the starts of these motors, one motor after another, or of all; latest first."""
    references: dict[str, StartReference] = {}
    for motor in motors or (None,):
        for entries in pages(partial(repository.starts, motor), size=PAGE):
            counts = repository.starts_within_hour(entries)
            for name in {one.motor for one in entries} - references.keys():
                references[name] = repository.start_reference(name)
            yield [
                ToldStart(one, counts[one.recording_id], references[one.motor].compared([one]))
                for one in entries
            ]
