"""The table of trends: of each recording what it says by itself, and what is said of the motor from it on.

What it says by itself is of the winding, the rotor, the air gap and the load, and the supply.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from heapq import merge
from itertools import chain, groupby
from operator import attrgetter

from core.rotor.finding import RotorFinding
from core.supply.figures import SupplyFigures
from service.exports.paging import PAGE, pages
from service.exports.tables import Column, ColumnType, Table, text, time
from service.storage.records import (
    ConditionPoint,
    DiagnosisPoint,
    RotorEntry,
    SupplyEntry,
    SwingEntry,
    TrackedPoint,
)
from service.storage.repository import Repository

_Point = DiagnosisPoint | ConditionPoint | RotorEntry | SupplyEntry | SwingEntry | TrackedPoint


@dataclass(slots=True)
class TrendRow:
    """A recording. diagnosed: None where a rule of retention deleted it.  said: None until it is folded.

    rotor, swings, supply: None where the recording shows nothing of them.  tracked: None until it is folded.
    """

    motor: str
    time_ns: int
    recording_id: str
    diagnosed: DiagnosisPoint | None = None
    said: ConditionPoint | None = None
    rotor: RotorFinding | None = None
    swings: SwingEntry | None = None
    supply: SupplyFigures | None = None
    tracked: TrackedPoint | None = None


def _diagnosed(
    name: str, meaning: str, *, column_type: ColumnType = ColumnType.NUMBER, unit: str = "1"
) -> Column[TrendRow]:
    """Return a column of what the recording says by itself."""
    return Column(name, column_type, unit, meaning, lambda row: getattr(row.diagnosed, name, None))


def _said(
    name: str, meaning: str, of: str, *, column_type: ColumnType = ColumnType.NUMBER, unit: str = "1"
) -> Column[TrendRow]:
    """Return a column of what is said of the motor from the recording on; of: name of the figure there."""
    return Column(name, column_type, unit, meaning, lambda row: getattr(row.said, of, None))


def _of_rotor(
    name: str, meaning: str, of: str, *, column_type: ColumnType = ColumnType.NUMBER, unit: str = "dB"
) -> Column[TrendRow]:
    """Return a column of what the recording shows of the rotor; of: name of the figure there."""
    return Column(name, column_type, unit, meaning, lambda row: getattr(row.rotor, of, None))


def _of_gap(name: str, meaning: str, of: str, *, unit: str = "1") -> Column[TrendRow]:
    """Return a column of what the recording shows of the air gap; of: name of the figure there."""

    def value(row: TrendRow) -> float | None:
        return None if row.swings is None else getattr(row.swings.eccentricity, of)

    return Column(name, ColumnType.NUMBER, unit, meaning, value)


def _of_swing(name: str, meaning: str, of: str, *, unit: str = "1") -> Column[TrendRow]:
    """Return a column of what the recording shows of a load that swings; of: name of the figure there."""

    def value(row: TrendRow) -> float | None:
        return None if row.swings is None else getattr(row.swings.pulsation, of)

    return Column(name, ColumnType.NUMBER, unit, meaning, value)


def _of_supply(name: str, meaning: str, *, unit: str = "1") -> Column[TrendRow]:
    """Return a column of what the recording shows of the supply."""
    return Column(name, ColumnType.NUMBER, unit, meaning, lambda row: getattr(row.supply, name, None))


def _tracked(parameter: str, meaning: str) -> Iterator[Column[TrendRow]]:
    """Yield the columns of a parameter's change and its interval's half."""
    for what, words in (("change", meaning), ("margin", "half of its 95 % interval")):
        name = f"{parameter}_{what}"
        yield Column(name, ColumnType.NUMBER, "1", words, partial(_of_tracked, name))


def _of_tracked(name: str, row: TrendRow) -> float | None:
    return getattr(row.tracked, name, None)


def _severity_end(row: TrendRow, end: int) -> float | None:
    interval = None if row.rotor is None else row.rotor.severity_dB_ci95
    return None if interval is None else interval[end]


_LOW = "lower bound of its 95 % interval"
_HIGH = "upper bound of its 95 % interval"
_SCATTER = "from the record's own scatter alone"

TABLE: Table[TrendRow] = Table(
    "trend",
    (
        text("motor", "motor", attrgetter("motor")),
        time("time", "trigger time written in the record", attrgetter("time_ns")),
        _diagnosed("verdict", "verdict of the recording by itself", column_type=ColumnType.TEXT, unit=""),
        _diagnosed("mu_f", "fault level: share of the turns of a phase"),
        _diagnosed("mu_f_ci95_low", f"{_LOW}, from all causes"),
        _diagnosed("mu_f_ci95_high", f"{_HIGH}, from all causes"),
        _diagnosed("mu_f_scatter95_low", f"{_LOW}, {_SCATTER}"),
        _diagnosed("mu_f_scatter95_high", f"{_HIGH}, {_SCATTER}"),
        _diagnosed("detection_limit", "fault level that nine of ten such recordings show"),
        _diagnosed(
            "theta_f",
            "winding with the fault: 0, 1, 2 on terminals a, b, c",
            column_type=ColumnType.WHOLE,
            unit="",
        ),
        _diagnosed("load_level", "load torque over the rated one"),
        _diagnosed("load_level_ci95_low", _LOW),
        _diagnosed("load_level_ci95_high", _HIGH),
        _said("state", "state of the motor from here on", "state", column_type=ColumnType.TEXT, unit=""),
        _said("kind", "kind of what stands out", "kind", column_type=ColumnType.TEXT, unit=""),
        _said("phase", "phase of that: a, b or c", "phase", column_type=ColumnType.TEXT, unit=""),
        _said("condition_level", "fault level in all, from all recordings so far", "mu_f"),
        _said("condition_level_ci95_low", _LOW, "mu_f_ci95_low"),
        _said("condition_level_ci95_high", _HIGH, "mu_f_ci95_high"),
        _said("change", "change of the fault level since the reference", "change"),
        _said("change_ci95_low", _LOW, "change_ci95_low"),
        _said("change_ci95_high", _HIGH, "change_ci95_high"),
        _of_rotor(
            "rotor_state",
            "what the recording shows of the rotor",
            "state",
            column_type=ColumnType.TEXT,
            unit="",
        ),
        _of_rotor("rotor_severity_dB", "rotor bar severity", "severity_dB"),
        Column(
            "rotor_severity_dB_ci95_low", ColumnType.NUMBER, "dB", _LOW, lambda row: _severity_end(row, 0)
        ),
        Column(
            "rotor_severity_dB_ci95_high", ColumnType.NUMBER, "dB", _HIGH, lambda row: _severity_end(row, 1)
        ),
        _of_rotor("rotor_detection_limit_dB", "severity that the recording would show", "detection_limit_dB"),
        _of_rotor("rotor_lower_sideband_dB", "current at (1 - 2s) f, as measured", "lower_sideband_dB"),
        _of_rotor("rotor_upper_sideband_dB", "current at (1 + 2s) f, as measured", "upper_sideband_dB"),
        _of_rotor(
            "load_oscillation_dB",
            "torque of the load that swings at 2 s f, over the rated one",
            "load_oscillation_dB",
        ),
        _of_rotor("slip", "slip, from the fit", "slip", unit="1"),
        _of_gap("gap_permeance_ripple", "air-gap eccentricity: permeance, once a turn", "permeance_ripple"),
        _of_gap("gap_permeance_ripple_deviation", "its standard deviation", "standard_deviation"),
        _of_gap("gap_detection_limit", "ripple that nine of ten such recordings show", "detection_limit"),
        _of_gap("turn_load_torque", "torque that swings once a turn, over the rated one", "load_torque"),
        _of_gap("turn_load_torque_deviation", "its standard deviation", "load_torque_deviation"),
        _of_gap("turn_frequency_hz", "turns of the shaft", "rotation_frequency_hz", unit="Hz"),
        _of_swing("swing_load_torque", "largest torque oscillation, over the rated torque", "load_torque"),
        _of_swing("swing_load_torque_deviation", "its standard deviation", "load_torque_deviation"),
        _of_swing("swing_detection_limit", "swing that nine of ten such recordings show", "detection_limit"),
        _of_swing("swing_noise", "what noise makes of it, rms", "noise"),
        _of_swing("swing_frequency_hz", "frequency of that swing", "frequency_hz", unit="Hz"),
        _of_supply("frequency_hz", "frequency of the supply", unit="Hz"),
        _of_supply("voltage_deviation", "mean line voltage over the rated one, minus 1"),
        _of_supply("voltage_unbalance_iec", "unbalance of the voltages, |V2| / |V1|"),
        _of_supply("voltage_unbalance_nema", "unbalance of the line voltages by NEMA MG-1"),
        _of_supply("derating", "share of the rated power that the unbalance leaves, NEMA MG-1"),
        _of_supply("thd_voltage", "total harmonic distortion of the voltage"),
        _of_supply("harmonic_voltage_factor", "HVF of NEMA MG-1"),
        _of_supply("current_unbalance", "unbalance of the line currents, |I2| / |I1|"),
        _of_supply("thd_current", "total harmonic distortion of the current"),
        _of_supply("active_power_W", "power drawn from the supply", unit="W"),
        _of_supply("power_factor", "power factor"),
        *_tracked("stator_resistance", "change of R_s since the first records, the load's heat taken out"),
        *_tracked("rotor_resistance", "change of R_r' beyond that of R_s"),
        *_tracked("magnetising_inductance", "change of the magnetising inductance"),
        *_tracked("leakage_inductance", "change of the total leakage"),
        text("recording_id", "id of the recording", attrgetter("recording_id")),
    ),
)


def trends(
    repository: Repository, motors: Sequence[str], *, from_ns: int | None = None, to_ns: int | None = None
) -> Iterator[Sequence[TrendRow]]:
    """Return the trends of motors, one motor after another, oldest first, from_ns <= time < to_ns."""
    for motor in motors:
        diagnosed = pages(partial(repository.diagnosis_trend, motor, from_ns=from_ns, to_ns=to_ns))
        said = pages(partial(repository.condition_trend, motor, from_ns=from_ns, to_ns=to_ns))
        rotor = pages(partial(repository.rotor_trend, motor, from_ns=from_ns, to_ns=to_ns))
        supply = pages(partial(repository.supply_trend, motor, from_ns=from_ns, to_ns=to_ns))
        swings = pages(partial(repository.swing_trend, motor, from_ns=from_ns, to_ns=to_ns))
        tracked = pages(partial(repository.tracked_trend, motor, from_ns=from_ns, to_ns=to_ns))
        sources: list[Iterator[_Point]] = [
            chain.from_iterable(diagnosed),
            chain.from_iterable(said),
            chain.from_iterable(rotor),
            chain.from_iterable(swings),
            chain.from_iterable(supply),
            chain.from_iterable(tracked),
        ]
        points = merge(*sources, key=attrgetter("time_ns"))
        yield from _joined(motor, points)


def _joined(motor: str, points: Iterator[_Point]) -> Iterator[Sequence[TrendRow]]:
    """Return a row for each recording of which there is a point; they are in the order of time."""
    batch: list[TrendRow] = []
    for time_ns, together in groupby(points, key=attrgetter("time_ns")):
        rows: dict[str, TrendRow] = {}
        for point in together:
            row = rows.setdefault(point.recording_id, TrendRow(motor, time_ns, point.recording_id))
            match point:
                case DiagnosisPoint():
                    row.diagnosed = point
                case ConditionPoint():
                    row.said = point
                case RotorEntry():
                    row.rotor = point.finding
                case SwingEntry():
                    row.swings = point
                case SupplyEntry():
                    row.supply = point.figures
                case TrackedPoint():
                    row.tracked = point
        batch += rows.values()
        if len(batch) >= PAGE:
            yield batch
            batch = []
    yield batch
