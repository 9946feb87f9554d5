"""Join simulated records of 64 cycles, and write docs/evidence/joining.md: python -m benchmarks.joining."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import ceil
from pathlib import Path
from time import perf_counter

import numpy as np

from benchmarks.reporting import Section, table, write_sections
from core.diagnosis.acceptance import accept
from core.diagnosis.stator import diagnose_accepted
from core.machines.parameters import Motor
from core.recordings import Recording
from core.recordings.joining import Joined, join
from core.rotor.baseband import baseband_of
from core.rotor.examining import examine_rotor
from core.rotor.finding import RotorFinding
from ied_sim.motor.load import Load
from ied_sim.motor.plant import MotorPlant, rated_current
from ied_sim.motor.sensors import Sensors
from ied_sim.motor.supply import Supply
from ied_sim.motor.trajectory import Trajectory
from testing.machines.disturbed_records import record_of
from testing.machines.motors import LARGE, MEDIUM

PAGE = Path(__file__).parents[2] / "docs" / "evidence" / "joining.md"
PREAMBLE = """\
# Joined records

What [longer records](../reference/relays.md#longer-records) tell of the rotor's cage, on simulated motors
with one of 28 bars broken, and a sound one. Records of 64 cycles with 32 samples a cycle, 30 cycles of them
before the trigger, noise 0.3 % of rated. Triggers are late by up to 50 ms and time stamps wrong by up to
1 ms, both drawn at random.
One record alone, ten joined, and one of the same length that was recorded in one piece.
"""
MOTORS = {"7.5 kW": MEDIUM, "37 kW": LARGE}
CASES = (
    ("7.5 kW", 0.5, 1),
    ("7.5 kW", 1.0, 1),
    ("37 kW", 0.5, 0),
    ("37 kW", 0.5, 1),
    ("37 kW", 1.0, 1),
)
RATE_HZ, STEP_RATE_HZ = 1_600.0, 10_000.0
LENGTH_S, PRE_TRIGGER_S, WANTED_S = 1.28, 0.6, 10.0
PERIOD_S = LENGTH_S - PRE_TRIGGER_S / 2
LATE_S, STAMP_ERROR_S, NOISE = 0.05, 1e-3, 0.003
BEGIN_S = 20.0
BARS = 28


@dataclass(frozen=True, slots=True)
class Case:
    """A motor at a load, and what its records show."""

    motor: str
    load: float
    broken_bars: int
    joined: Joined
    offset_error: float
    join_s: float
    findings: tuple[RotorFinding | None, ...]


def case(name: str, load: float, broken_bars: int, random: np.random.Generator) -> Case:
    """Record a series and one long record, and examine both."""
    motor = MOTORS[name]
    sensors = Sensors(10.0 * rated_current(motor), 2.0 * motor.nameplate.rated_voltage_V, noise=NOISE)
    supply = Supply(motor.nameplate.rated_voltage_V, 50.0)
    plant = MotorPlant(motor, supply, Load(load), sensors, broken_bars=broken_bars / BARS)
    series = replace(plant, trajectory=Trajectory())
    count = ceil((WANTED_S - LENGTH_S) / PERIOD_S) + 1
    begins_s = [BEGIN_S + k * PERIOD_S + random.uniform(0.0, LATE_S) for k in range(count)]
    parts = [_record(series, begin_s, LENGTH_S, random) for begin_s in begins_s]
    began = perf_counter()
    joined = join(parts)
    join_s = perf_counter() - began
    places = np.diff(begins_s) * RATE_HZ
    error = float(np.abs([seam.offset for seam in joined.seams] - places).max())
    whole = _record(plant, BEGIN_S, joined.recording.duration_s, random)
    records = (parts[0], joined.recording, whole)
    findings = tuple(_finding(record, motor) for record in records)
    return Case(name, load, broken_bars, joined, error, join_s, findings)


def _record(plant: MotorPlant, begin_s: float, length_s: float, random: np.random.Generator) -> Recording:
    samples = plant.window(begin_s, length_s, RATE_HZ, step_rate_hz=STEP_RATE_HZ)
    stamp_s = begin_s + random.uniform(-STAMP_ERROR_S, STAMP_ERROR_S)
    return replace(record_of(samples, RATE_HZ), start_time_ns=round(stamp_s * 1e9), nominal_frequency_hz=50.0)


def _finding(record: Recording, motor: Motor) -> RotorFinding | None:
    accepted = accept(record, motor).accepted
    if accepted is None:
        return None
    return examine_rotor(baseband_of(accepted), accepted, diagnose_accepted(accept(record, motor)))


def lines() -> Iterator[str]:
    """Lines of the page."""
    random = np.random.default_rng(1)
    cases = [case(name, load, bars, random) for name, load, bars in CASES]
    head = ["motor", "load", "broken bars", "one record", "ten joined", "one long record"]
    yield from table(
        head,
        [[one.motor, f"{one.load:.0%}", str(one.broken_bars), *map(_told, one.findings)] for one in cases],
    )
    yield ""
    yield (
        "State, severity with its 95 % interval, and detection limit [dB], as "
        "[defined](../explanation/rotor.md); one draw of each case."
    )
    yield ""
    errors = max(one.offset_error for one in cases)
    differences = max(seam.difference for one in cases for seam in one.joined.seams)
    number = sum(len(one.joined.seams) for one in cases)
    slowest_s = max(one.join_s for one in cases)
    yield (
        f"Of {number} seams the place was found within {errors:.3f} of a sample; waveforms differed by at "
        f"most {differences:.1%} there. Joining took at most {1e3 * slowest_s:.0f} ms a series."
    )


def _told(finding: RotorFinding | None) -> str:
    if finding is None:
        return "refused"
    limit = finding.detection_limit_dB
    limit_words = "" if limit is None else f", limit {limit:.1f}"
    if finding.severity_dB is None or finding.severity_dB_ci95 is None:
        return f"{finding.state}{limit_words}"
    low, high = finding.severity_dB_ci95
    return f"{finding.state}, {finding.severity_dB:.1f} [{low:.1f}, {high:.1f}]{limit_words}"


def main() -> None:
    """Measure, and write the page."""
    section = Section("rotor", "One broken bar", "python -m benchmarks.joining", tuple(lines()))
    print(section.text())
    write_sections(PAGE, PREAMBLE, ["rotor"], [section])


if __name__ == "__main__":
    main()
