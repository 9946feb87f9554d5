"""Motors as the motors file describes them, beside what their relays measure."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import isfinite, sqrt
from typing import Final

from core.machines.parameters import Connection, Limits, Nameplate
from core.units import NANOSECONDS_PER_HOUR
from service.api.pages import decode, encode
from service.condition.parameter_sources import SOURCES
from service.storage import Repository
from service.storage.records import Sample
from service.storage.records.overviews import MotorOverview
from service.web.addresses import address

MOST_SHOWN: Final = 100

RECENT_NS: Final = NANOSECONDS_PER_HOUR
"""What was measured longer ago says little of now."""

NO_VOLTAGE: Final = 0.2
"""Below this share of the rated voltage, the motor is switched off and nothing is compared."""

VOLTAGE_BAND: Final = (0.90, 1.10)
FREQUENCY_BAND: Final = (0.95, 1.03)
"""Of the rated values. Outside zone B of IEC 60034-1, the file or the relay's settings are in doubt."""

LINE_VOLTAGES: Final = ("vab_V", "vbc_V", "vca_V")
PHASE_VOLTAGES: Final = ("va_V", "vb_V", "vc_V")


@dataclass(frozen=True, slots=True)
class Measured:
    """What the relay measures beside a rated value. agrees: None where nothing can be compared."""

    voltage_V: float | None
    frequency_Hz: float | None
    time_ns: int
    voltage_agrees: bool | None
    frequency_agrees: bool | None

    @property
    def is_off(self) -> bool:
        """Tell whether there is no voltage to compare: the motor is switched off."""
        return self.voltage_V is not None and self.voltage_agrees is None

    @property
    def disagrees(self) -> bool:
        """Tell whether file and relay contradict each other."""
        return self.voltage_agrees is False or self.frequency_agrees is False


@dataclass(frozen=True, slots=True)
class MotorLine:
    """A motor in the list. nameplate, fault_level: None before the service has read its file."""

    overview: MotorOverview
    nameplate: Nameplate | None
    fault_level: float | None
    measured: Measured | None

    @property
    def source_words(self) -> str:
        """Return where its parameters come from."""
        return SOURCES[self.overview.motor.parameters_source]


@dataclass(frozen=True, slots=True)
class MotorChoice:
    """Which motors somebody wants to see, as the address of the page says it."""

    site: str | None = None
    text: str | None = None
    cursor: str | None = None

    @property
    def is_filtered(self) -> bool:
        """Tell whether some motors are left out."""
        return self.site is not None or self.text is not None


@dataclass(frozen=True, slots=True)
class MotorList:
    """The motors that the page shows."""

    choice: MotorChoice
    lines: Sequence[MotorLine]
    next_path: str | None


def motor_list(repository: Repository, choice: MotorChoice, *, now_ns: int) -> MotorList:
    """Read the motors of a page. Raises ProblemError for a cursor that is none."""
    found = repository.motor_overviews(
        limit=MOST_SHOWN, after=decode(choice.cursor, str), site=choice.site, text=choice.text
    )
    names = [overview.motor.name for overview in found.items]
    samples = repository.latest_samples(names, since_ns=now_ns - RECENT_NS)
    next_path = None
    if found.next is not None:
        next_path = address("/plant", site=choice.site, text=choice.text, cursor=encode(found.next))
    return MotorList(
        choice, [_line(overview, samples.get(overview.motor.name)) for overview in found.items], next_path
    )


def measured(nameplate: Nameplate, sample: Sample) -> Measured:
    """Compare what a relay measures with a nameplate."""
    voltage, frequency = _line_voltage(sample.values), _figure(sample.values.get("frequency_Hz"))
    voltage_share = None if voltage is None else voltage / nameplate.rated_voltage_V
    has_voltage = voltage_share is not None and voltage_share >= NO_VOLTAGE
    frequency_share = None if frequency is None else frequency / nameplate.rated_frequency_Hz
    return Measured(
        voltage_V=voltage,
        frequency_Hz=frequency,
        time_ns=sample.time_ns,
        voltage_agrees=_within(voltage_share, VOLTAGE_BAND) if has_voltage else None,
        frequency_agrees=_within(frequency_share, FREQUENCY_BAND) if has_voltage else None,
    )


def _line(overview: MotorOverview, sample: Sample | None) -> MotorLine:
    document = overview.document or {}
    nameplate = _nameplate(document.get("nameplate"))
    limits = document.get("limits")
    level = limits.get("fault_level", Limits().fault_level) if isinstance(limits, Mapping) else None
    told = None if nameplate is None or sample is None else measured(nameplate, sample)
    return MotorLine(overview, nameplate, level, told)


def _nameplate(table: object) -> Nameplate | None:
    if not isinstance(table, Mapping):
        return None
    return Nameplate(**{**table, "connection": Connection(str(table["connection"]))})


def _line_voltage(values: Mapping[str, float]) -> float | None:
    """Return the mean voltage line to line [V]; None where the relay does not measure it."""
    for names, factor in ((LINE_VOLTAGES, 1.0), (PHASE_VOLTAGES, sqrt(3.0))):
        found = [values[name] for name in names if name in values and isfinite(values[name])]
        if found:
            return factor * sum(found) / len(found)
    return None


def _figure(value: float | None) -> float | None:
    return value if value is not None and isfinite(value) and value > 0.0 else None


def _within(share: float | None, band: tuple[float, float]) -> bool | None:
    return None if share is None else band[0] <= share <= band[1]
