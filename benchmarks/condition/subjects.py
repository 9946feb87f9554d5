"""The subjects that are measured, most important first, and what is said of each on the page."""

from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Executor
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from benchmarks.condition.bus import bus
from benchmarks.condition.cost import cost
from benchmarks.condition.detection import detection
from benchmarks.condition.disturbances import disturbances
from benchmarks.condition.effort import Effort, effort_of
from benchmarks.condition.end_to_end import end_to_end
from benchmarks.condition.false_alarms import false_alarms
from benchmarks.condition.file_records import CYCLES, SPACING_H
from benchmarks.condition.folding import folding
from benchmarks.condition.forecasts import forecasts
from benchmarks.condition.marks import Mark
from benchmarks.condition.mill import mill
from benchmarks.condition.page import Section
from benchmarks.condition.second_changes import second_changes
from service.condition.worker import RECORDS_A_FOLD


@dataclass(frozen=True, slots=True)
class Subject:
    """A subject: its title, what is said before its tables, what yields their lines and its marks.

    minutes: that its full size takes two cores, as measured.
    """

    title: str
    about: Callable[[Effort], str]
    measure: Callable[[Effort, Executor], Iterator[str | Mark]]
    minutes: float

    @property
    def section(self) -> Section:
        return Section(self.title, lambda share: self.about(effort_of(share)).splitlines())


def _detection(effort: Effort) -> str:
    return f"""\
{effort.steps} motors a row, each with a step of the fault level; hourly records.
Delays: the median, and the record by which 90 % of those that ever were seen or called had been."""


def _disturbances(effort: Effort) -> str:
    return f"""\
{effort.disturbed} motors a row, a disturbance after 60 to 140 hourly records, 300 records after
it. Channels: 0.3 to 2 % either way, drifts within 20 to 200 records. Relays: another one of the
class. Rewound: R_s and L_ls within 10 %, other asymmetries. Joints: 0.2 to 2 % of the voltage at
rated current, in a line. No bus: each motor is judged alone. `In the end`: what is named last."""


def _second_changes(effort: Effort) -> str:
    return f"""\
{effort.disturbed // 2} motors a row: a change after 60 to 140 hourly records, another one 100 records
later, 100 records after it. Shorted turns after another change: 1.5 %; else 1 %, then 2 %; paths
of 0 to 3 times the turns' resistance. Channels: 1 to 2 %; joints as above. The delay counts from
the second change; `kept` is the share of later records in which fault and phase stayed."""


def _bus(effort: Effort) -> str:
    return f"""\
{effort.buses} buses a row, five motors each with relays of any class, hourly records within a
minute; real noise. What happens, happens to the first motor after 100 records."""


def _forecasts(effort: Effort) -> str:
    return f"""\
{effort.growing} motors a row, a fault that grows by 0.002 to 0.02 % a record (hourly), at a
rate that wanders by a factor of two or more, or exponentially with 25 to 100 records; up to four
forecasts of each motor after the change was found. The time is that until the true level
reaches the limit of the forecast. The ends of the interval are the 5 and 95 % quantiles; it is
published as one of 80 %. `Told with`: until when the level is told to stay below its limit, and how
often it did; chances were calibrated with other motors. `Too early`, `too late`: the whole interval was."""


def _false_alarms(effort: Effort) -> str:
    return f"""\
Healthy motors, {effort.healthy_motors} a row, hourly unless said otherwise. A motor-day is a day
with records after the reference is complete; it counts as `watch` if the motor is other than
healthy after any of them. `In watch at the end`: without a change, for a standing asymmetry or
for a last record that needs confirmation."""


def _files(effort: Effort) -> str:
    before, after = effort.file_records
    return f"""\
The simulator's windings in phase variables, integrated in time, with load swings, harmonics,
noise of 0.2 % a sample, 16-bit converters, 1.6 to 8 kHz, {CYCLES:g} cycles; written as COMTRADE
files, read back, observed and followed as `mcc follow` does. {effort.file_motors} of each of
four motors (0.8 to 250 kW) a row, every figure of their files off by up to 10 %, channels within
0.5 % and 25 us; {before} records {SPACING_H:g} hours apart before the case, {after} after it."""


def _mill(_: Effort) -> str:
    return """\
Voltages and currents of a milling machine's motor without a recorded fault, 8 kHz, two recordings
in a row: github.com/wjcotta/induction_motor_model, `Mill Data`. Measured, not simulated. Windows
get times an hour apart unless said otherwise. The shunt is that of the split winding, integrated
on the measured voltages and added to the measured currents. The cases share the recordings, so
that their intervals tell less than those of other sections."""


def _cost(_: Effort) -> str:
    return "Processor time of one core, with whatever else the machine did at the time."


def _folding(_: Effort) -> str:
    return f"""\
As the workers of the service do it: observations read from a database of their own, followed,
what is said from each record on and the history written back, {RECORDS_A_FOLD:,} records a transaction.
With whatever else the machine did at the time."""


SUBJECTS: Final[Mapping[str, Subject]] = {
    "detection": Subject(
        "Shorted turns found", _detection, lambda effort, pool: detection(effort.steps, pool), 14
    ),
    "disturbances": Subject(
        "What is no fault", _disturbances, lambda effort, pool: disturbances(effort.disturbed, pool), 3
    ),
    "bus": Subject("Five motors on a bus", _bus, lambda effort, pool: bus(effort.buses, pool), 5),
    "files": Subject(
        "Records through files",
        _files,
        lambda effort, pool: end_to_end(
            effort.file_motors, pool, before=effort.file_records[0], after=effort.file_records[1]
        ),
        7,
    ),
    "false-alarms": Subject(
        "False alarms",
        _false_alarms,
        lambda effort, pool: false_alarms(effort.healthy_motors, effort.healthy_records, pool),
        1.5,
    ),
    "forecasts": Subject("Forecasts", _forecasts, lambda effort, pool: forecasts(effort.growing, pool), 1),
    "second-changes": Subject(
        "A second change",
        _second_changes,
        lambda effort, pool: second_changes(effort.disturbed // 2, pool),
        1.5,
    ),
    "cost": Subject(
        "Cost",
        _cost,
        lambda effort, pool: cost(effort.cost_motors, effort.cost_records, effort.long_records, pool),
        1,
    ),
    "folding": Subject(
        "Cost in the service",
        _folding,
        lambda effort, pool: folding(effort.cost_motors, effort.cost_records, pool),
        2,
    ),
}
MILL: Final = "mill"
"""The subject that needs recordings which are not the project's."""


def mill_subject(folder: Path) -> Subject:
    """Return the subject of the measured recordings of a folder."""
    return Subject(
        MILL_SECTION.title, _mill, lambda effort, pool: mill(folder, pool, every=effort.whole_mill), 2
    )


MILL_SECTION: Final = Section(
    "Measured recordings in a row", lambda share: _mill(effort_of(share)).splitlines()
)
SECTIONS: Final[Mapping[str, Section]] = {
    **{name: subject.section for name, subject in SUBJECTS.items()},
    MILL: MILL_SECTION,
}
