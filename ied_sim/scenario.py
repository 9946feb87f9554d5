"""The scenario: which motor stands behind each relay, in what condition, on what supply, under what load.

One TOML file, explained in docs/scenario.md.
"""

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from math import radians, sqrt
from pathlib import Path
from typing import Annotated, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from core.machines.motor_file import MotorFileError, motor_from_table
from core.machines.parameters import MachineParameters, Motor, Nameplate
from ied_sim.fault import FaultCourse
from ied_sim.load import Load
from ied_sim.plant import HIGHEST_STEP_RATE_HZ, RATE_PER_STEP, MotorPlant, rated_current
from ied_sim.sensors import Sensors
from ied_sim.supply import Harmonic, Supply
from ied_sim.windings import highest_fault_resistance

CURRENT_HEADROOM = 12
"""Full scale of the current channels over the rated current's peak: a start-up current must fit."""
VOLTAGE_HEADROOM = 2

Share = Annotated[float, Field(ge=-0.5, le=0.5)]
SixShares = tuple[Share, Share, Share, Share, Share, Share]
Turns = Annotated[float, Field(ge=0, le=0.5)]


class ScenarioError(ValueError):
    """A scenario cannot be used: which file, which field, what was expected and what was found."""

    def __init__(self, path: Path | str, field: str, *, expected: str, found: str) -> None:
        self.path = Path(path)
        self.field = field
        self.expected = expected
        self.found = found
        super().__init__(f"{self.path}: {field}: expected {expected}, found {found}")


class _Section(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class _Harmonic(_Section):
    order: Annotated[int, Field(ge=2, le=50)]
    fraction: Annotated[float, Field(ge=0, le=0.5)]
    angle_deg: float = 0.0

    @model_validator(mode="after")
    def _has_a_sequence(self) -> Self:
        if self.order % 3 == 0:
            raise ValueError(f"order {self.order} has no sequence and drives no current into three wires")
        return self


class _Supply(_Section):
    line_voltage_V: Annotated[float, Field(gt=0)] | None = None
    frequency_Hz: Annotated[float, Field(gt=10, lt=500)] | None = None
    frequency_drift_Hz: Annotated[float, Field(ge=0, le=2)] = 0.0
    drift_period_s: Annotated[float, Field(ge=10)] = 300.0
    unbalance: Annotated[float, Field(ge=0, le=0.3)] = 0.0
    unbalance_angle_deg: float = 0.0
    harmonics: tuple[_Harmonic, ...] = ()
    sequence: Literal["abc", "acb"] = "abc"

    def supply(self, nameplate: Nameplate) -> Supply:
        return Supply(
            line_voltage_V=self.line_voltage_V or nameplate.rated_voltage_V,
            frequency_Hz=self.frequency_Hz or nameplate.rated_frequency_Hz,
            frequency_drift_Hz=self.frequency_drift_Hz,
            drift_period_s=self.drift_period_s,
            unbalance=self.unbalance,
            unbalance_angle_rad=radians(self.unbalance_angle_deg),
            harmonics=tuple(Harmonic(h.order, h.fraction, radians(h.angle_deg)) for h in self.harmonics),
            sequence=self.sequence,
        )


class _Load(_Section):
    level: Annotated[float, Field(ge=0, le=1.5)] = 0.5
    swing: Annotated[float, Field(ge=0, le=0.5)] = 0.0
    swing_period_s: Annotated[float, Field(ge=0.1)] = 20.0

    def load(self) -> Load:
        return Load(self.level, self.swing, self.swing_period_s)


class _TimelinePoint(_Section):
    at_s: float
    level: Turns


class _Fault(_Section):
    phase: Literal["a", "b", "c"]
    level: Turns | None = None
    timeline: Annotated[tuple[_TimelinePoint, ...], Field(min_length=1)] | None = None
    resistance_ohm: Annotated[float, Field(ge=0)] = 0.0

    @model_validator(mode="after")
    def _is_one_course_in_time(self) -> Self:
        if (self.level is None) == (self.timeline is None):
            raise ValueError("give either level or timeline")
        times = [point.at_s for point in self.timeline or ()]
        if times != sorted(set(times)):
            raise ValueError("at_s must rise from each point of timeline to the next")
        return self

    def course(self) -> FaultCourse:
        constant = ((0.0, self.level or 0.0),)
        points = tuple((p.at_s, p.level) for p in self.timeline) if self.timeline else constant
        return FaultCourse("abc".index(self.phase), points, self.resistance_ohm)


class _Sensors(_Section):
    gain_errors: SixShares = (0.0,) * 6
    offsets: SixShares = (0.0,) * 6
    current_delay_us: Annotated[float, Field(ge=0, le=20_000)] = 0.0
    noise: Annotated[float, Field(ge=0, le=0.5)] = 0.0
    full_scale_A: Annotated[float, Field(gt=0)] | None = None
    full_scale_V: Annotated[float, Field(gt=0)] | None = None

    def sensors(self, motor: Motor) -> Sensors:
        phase_peak_V = sqrt(2 / 3) * motor.nameplate.rated_voltage_V
        return Sensors(
            full_scale_A=self.full_scale_A or CURRENT_HEADROOM * sqrt(2) * rated_current(motor),
            full_scale_V=self.full_scale_V or VOLTAGE_HEADROOM * phase_peak_V,
            gain_errors=self.gain_errors,
            offsets=self.offsets,
            current_delay_s=self.current_delay_us * 1e-6,
            noise=self.noise,
        )


class _Recorder(_Section):
    sample_rate_Hz: Annotated[float, Field(ge=500, le=100_000)] = 10_000.0
    pre_trigger_s: Annotated[float, Field(ge=0, le=10)] = 0.2
    post_trigger_s: Annotated[float, Field(gt=0, le=30)] = 0.8
    capacity: Annotated[int, Field(ge=1, le=10_000)] = 20


class _Motor(_Section):
    ied: Annotated[str, Field(min_length=1)]
    seed: Annotated[int, Field(ge=0)] = 0
    nameplate: dict[str, object]
    parameters: dict[str, object]
    supply: _Supply = _Supply()
    load: _Load = _Load()
    fault: _Fault | None = None
    sensors: _Sensors = _Sensors()
    recorder: _Recorder = _Recorder()


class _File(_Section):
    motor: tuple[_Motor, ...]


@dataclass(frozen=True, slots=True)
class RecorderSettings:
    """What an event record spans, and how many records the relay keeps."""

    sample_rate_hz: float = 10_000.0
    pre_trigger_s: float = 0.2
    post_trigger_s: float = 0.8
    capacity: int = 20


@dataclass(frozen=True, slots=True)
class RelayScenario:
    """What one relay protects and how it records."""

    plant: MotorPlant
    recorder: RecorderSettings = field(default_factory=RecorderSettings)

    def truth(self, time_s: float) -> dict[str, float | int | None]:
        """The true condition at a time since the start: mu_f (the equivalent level), theta_f, load_level."""
        plant = self.plant
        parameters = plant.motor.parameters
        fault = None if plant.fault is None else plant.fault.at(time_s)
        level = 0.0 if fault is None else fault.equivalent_level(parameters.stator_resistance_ohm)
        return {
            "mu_f": level,
            "theta_f": fault.phase if fault is not None and level > 0 else None,
            "load_level": plant.load.level_at(time_s),
        }


def read_scenario(path: Path) -> dict[str, RelayScenario]:
    """Scenario of each IED by its name. Raises ScenarioError."""
    try:
        table = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise ScenarioError(
            path, "file", expected="a readable file", found=error.strerror or str(error)
        ) from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ScenarioError(path, "file", expected="TOML in UTF-8", found=str(error)) from error
    try:
        motors = _File.model_validate(table).motor
    except ValidationError as error:
        raise _scenario_error(path, table, error) from error
    scenarios: dict[str, RelayScenario] = {}
    for motor in motors:
        if motor.ied in scenarios:
            raise ScenarioError(
                path, f"[motor {motor.ied}] ied", expected="each IED once", found="a second motor"
            )
        scenarios[motor.ied] = _relay_scenario(path, motor)
    return scenarios


def healthy_reference(ied: str) -> RelayScenario:
    """A healthy 800 W motor (thesis Table 3.2) at half load: what a relay protects that no scenario names."""
    motor = Motor(
        name=ied,
        nameplate=Nameplate(rated_power_W=800, rated_voltage_V=380, rated_frequency_Hz=50, pole_pairs=2),
        parameters=MachineParameters(
            stator_resistance_ohm=8.4,
            rotor_resistance_ohm=8.2,
            stator_leakage_H=0.0328,
            rotor_leakage_H=0.0328,
            stator_self_inductance_H=0.4377,
            inertia_kgm2=0.0229,
        ),
    )
    return RelayScenario(
        MotorPlant(
            motor=motor,
            supply=_Supply().supply(motor.nameplate),
            load=_Load().load(),
            sensors=_Sensors(noise=0.002).sensors(motor),
        )
    )


def _relay_scenario(path: Path, section: _Motor) -> RelayScenario:
    where = f"[motor {section.ied}]"
    try:
        motor = motor_from_table(
            {"nameplate": section.nameplate, "parameters": section.parameters}, name=section.ied, source=path
        )
    except MotorFileError as error:
        raise ScenarioError(
            path, f"{where} {error.field}", expected=error.expected, found=error.found
        ) from error
    course = None if section.fault is None else section.fault.course()
    if course is not None:
        highest_ohm = highest_fault_resistance(motor.parameters, HIGHEST_STEP_RATE_HZ * RATE_PER_STEP)
        if course.resistance_ohm > highest_ohm:
            raise ScenarioError(
                path,
                f"{where} fault.resistance_ohm",
                expected=f"at most {highest_ohm:.3g}, above which the shorted loop is too fast to simulate",
                found=f"{course.resistance_ohm:g}",
            )
    recorder = section.recorder
    return RelayScenario(
        plant=MotorPlant(
            motor=motor,
            supply=section.supply.supply(motor.nameplate),
            load=section.load.load(),
            sensors=section.sensors.sensors(motor),
            fault=course,
            seed=section.seed,
        ),
        recorder=RecorderSettings(
            recorder.sample_rate_Hz, recorder.pre_trigger_s, recorder.post_trigger_s, recorder.capacity
        ),
    )


def _scenario_error(path: Path, table: Mapping[str, object], error: ValidationError) -> ScenarioError:
    """The first of the errors, with the motor called by its IED where it has one."""
    first = error.errors()[0]
    location = list(first["loc"])
    place = ".".join(str(part) for part in location)
    if len(location) >= 2 and isinstance(location[1], int):
        motors = table.get("motor")
        motor = motors[location[1]] if isinstance(motors, list) else None
        name = motor.get("ied") if isinstance(motor, dict) else None
        field = ".".join(str(part) for part in location[2:])
        place = f"[motor {name if isinstance(name, str) else location[1] + 1}] {field}".rstrip()
    if first["type"] == "missing":
        return ScenarioError(path, place, expected="this field", found="nothing")
    if first["type"] == "extra_forbidden":
        return ScenarioError(path, place, expected="no such field", found="one; is the name right?")
    expected = first["msg"].removeprefix("Value error, ").removeprefix("Input should be ")
    found = first["input"]
    return ScenarioError(path, place, expected=expected, found=repr(found)[:80])
