"""The rotor of a motor on its page: what its records say of it, and over time."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple

from core.machines.parameters import MachineKind
from core.rotor.advice import rotor_advice
from core.rotor.finding import RotorState
from core.rotor.judgement import FAULT_DB, WATCH_DB
from core.rotor.trend import RotorCondition
from service.api.rotor_and_supply.start_agreement import StartAgreement, start_agreement
from service.client.rotor_and_supply import STATES, decibels, sideband_words
from service.storage import Repository
from service.storage.records import RotorEntry
from service.web.charts import Chart, Kind, Limit, Series, Tone
from service.web.charts.chart import AxisKind
from service.web.motor.time_range import TimeRange, in_seconds
from service.web.motor.trend import SYNC, TAB_HEIGHT

MOST_RECORDS: Final = 400
"""The latest records that the charts show."""
LOWEST_DB: Final = -90.0
"""What lies lower is drawn here: it is noise."""
DIGITS: Final = 1
TONES: Final = (Tone.A, Tone.B, Tone.C, Tone.MODEL, Tone.ACCENT)


class RotorPart(NamedTuple):
    """What the page calls a rotor and its fault, and what its severity does not tell."""

    name: str
    fault: str
    note: str


PARTS: Final = {
    MachineKind.CAGE: RotorPart(
        "cage",
        "broken bars or a broken end ring",
        "A severity tells how uneven the cage is, never how many bars are broken.",
    ),
    MachineKind.WOUND_ROTOR: RotorPart(
        "rotor winding",
        "a bad contact of a brush or a slip ring",
        "A severity tells how uneven the resistances of the rotor's phases are, not in which phase.",
    ),
}


@dataclass(frozen=True, slots=True)
class RotorSection:
    """What the page says of the rotor. latest: None where no record tells of it; no charts then.

    start: None where no start tells of it, or no running record.
    """

    part: RotorPart
    latest: RotorEntry | None
    condition: RotorCondition
    words: str
    sentence: str
    advice: str
    sidebands: str | None
    start: StartAgreement | None
    severity_chart: Chart | None
    sideband_chart: Chart | None
    records: int
    silent: int


def rotor_section(repository: Repository, motor: str, kind: MachineKind, shown: TimeRange) -> RotorSection:
    """Read what the page says of a motor's rotor, a cage or a winding. Raises NotFoundError."""
    entries = repository.latest_rotor_findings(motor, limit=MOST_RECORDS)
    telling = [one for one in entries if one.finding.severity_dB is not None]
    drawn = [one for one in telling if shown.has(one.time_ns)]
    latest = telling[-1] if telling else (entries[-1] if entries else None)
    condition = repository.rotor_condition(motor)
    return RotorSection(
        part=PARTS[kind],
        latest=latest,
        condition=condition,
        words=STATES[condition.state],
        sentence=_sentence(condition, PARTS[kind]) if entries else "No record tells of the rotor yet.",
        advice=rotor_advice(condition.state),
        sidebands=None if latest is None else sideband_words(latest.finding),
        start=start_agreement(repository, motor),
        severity_chart=_severity_chart(motor, drawn, shown) if drawn else None,
        sideband_chart=_sideband_chart(motor, drawn, shown) if drawn else None,
        records=len(entries),
        silent=len(entries) - len(telling),
    )


def _sentence(condition: RotorCondition, part: RotorPart) -> str:
    if condition.severity_dB is None:
        return f"The records cannot tell whether the {part.name} is sound."
    level = decibels(condition.severity_dB, condition.severity_dB_ci95)
    says = {
        RotorState.HEALTHY: f"The {part.name} is even: its asymmetry is",
        RotorState.WATCH: f"The {part.name} may be uneven: its asymmetry is",
        RotorState.FAULT: f"The {part.name} is uneven, as with {part.fault}: its asymmetry is",
    }[condition.state]
    changed = ""
    if condition.change_dB is not None:
        changed = f", {condition.change_dB:+.1f} dB against the first records at the same load"
    return f"{says} {level}{changed}."


def _severity_chart(motor: str, entries: Sequence[RotorEntry], shown: TimeRange) -> Chart:
    """Return the severity over time, of each tenth of the load by itself, with what would have been seen."""
    severities = [_drawn(one.finding.severity_dB) for one in entries]
    intervals = [one.finding.severity_dB_ci95 for one in entries]
    bins = sorted({one.finding.load_bin for one in entries if one.finding.load_bin is not None})
    series = [
        Series(
            "95 % interval",
            [None] * len(entries),
            "dB",
            Tone.MUTED,
            Kind.LINE,
            [None if ends is None else _drawn(ends[0]) for ends in intervals],
            [None if ends is None else _drawn(ends[1]) for ends in intervals],
        ),
        Series(
            "detection limit",
            [_drawn(one.finding.detection_limit_dB) for one in entries],
            "dB",
            Tone.MUTED,
            Kind.DASHES,
        ),
    ]
    for number, load_bin in enumerate(bins):
        of_bin = [one.finding.load_bin == load_bin for one in entries]
        series.append(
            Series(
                f"at {10 * load_bin} to {10 * (load_bin + 1)} % load",
                [value if is_in else None for value, is_in in zip(severities, of_bin, strict=True)],
                "dB",
                TONES[number % len(TONES)],
                Kind.POINTS,
            )
        )
    for state, tone in ((RotorState.WATCH, Tone.WATCH), (RotorState.FAULT, Tone.FAULT)):
        called = [one.finding.state is state for one in entries]
        if any(called):
            values = [
                value if is_called else None for value, is_called in zip(severities, called, strict=True)
            ]
            series.append(Series(state.value, values, "dB", tone, Kind.POINTS))
    return Chart(
        key="rotor-severity",
        caption=f"Rotor bar severity of {motor}",
        x_label="time",
        y_label="rotor bar severity",
        y_unit="dB",
        x_kind=AxisKind.TIME,
        x=_times(entries),
        series=series,
        limits=[Limit(WATCH_DB, "watch", Tone.WATCH), Limit(FAULT_DB, "fault", Tone.FAULT)],
        summary=f"{len(entries)} record{'s' if len(entries) > 1 else ''}, by tenths of the rated load. "
        f"Above {WATCH_DB:g} dB a record is on watch. It shows a fault where its whole interval lies above "
        f"{FAULT_DB:g} dB.",
        x_from=shown.x_from,
        x_to=shown.x_to,
        sync=SYNC,
        height=TAB_HEIGHT,
    )


def _sideband_chart(motor: str, entries: Sequence[RotorEntry], shown: TimeRange) -> Chart:
    lower = [_drawn(one.finding.lower_sideband_dB) for one in entries]
    upper = [_drawn(one.finding.upper_sideband_dB) for one in entries]
    swing = [_drawn(one.finding.load_oscillation_dB) for one in entries]
    return Chart(
        key="rotor-sidebands",
        caption=f"Sidebands in the current of {motor}",
        x_label="time",
        y_label="over the fundamental",
        y_unit="dB",
        x_kind=AxisKind.TIME,
        x=_times(entries),
        series=[
            Series("lower, (1 - 2s) f", lower, "dB", Tone.INK, Kind.LINE, short="lower"),
            Series("upper, (1 + 2s) f", upper, "dB", Tone.ACCENT, Kind.LINE, short="upper"),
            Series(
                "swing of the load's torque, over the rated one",
                swing,
                "dB",
                Tone.MUTED,
                Kind.THIN,
                short="load",
            ),
        ],
        summary="As measured: load and inertia are still in them.",
        x_from=shown.x_from,
        x_to=shown.x_to,
        sync=SYNC,
        height=TAB_HEIGHT,
    )


def _times(entries: Sequence[RotorEntry]) -> list[float]:
    return [in_seconds(one.time_ns) for one in entries]


def _drawn(value_dB: float | None) -> float | None:
    return None if value_dB is None else round(max(value_dB, LOWEST_DB), DIGITS)
