"""How near the efficiency of a record is to that of the motor: python -m benchmarks.losses.

Motors of 0.8 to 1,200 kW whose losses are drawn from the ranges that tests of cage motors give. Windings are
warm by chance, and the motor's file is off by its tolerance. What a record would show follows from the
motor's own circuit; the losses are then told by the file. Writes docs/evidence/losses.md.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import sqrt
from pathlib import Path
from statistics import median

import numpy as np

from benchmarks.reporting import rate_text, table
from core.diagnosis.verdict import Indicators
from core.losses.measuring import measure_losses
from core.losses.other_losses import copper_W
from core.machines.load_point import load_point
from core.machines.parameters import Motor, ParametersSource, ParameterTolerances
from core.rotor.finding import RotorFinding
from core.speed.finding import SpeedFinding, SpeedSource, SpeedState
from core.supply.figures import SupplyFigures
from testing.machines.rated_motors import POLES, POWERS_KW, rated_motor
from testing.service.plants import healthy

PAGE = Path("docs/evidence/losses.md")
MOTORS = 4000
SEED = 7
LOADS = (0.25, 0.5, 0.75, 1.0)
CORE, FRICTION, STRAY = (0.15, 0.25), (0.05, 0.15), (0.08, 0.16)
WARMTH = (1.0, 1.25)
"""Resistances of a motor at work over those of its file's temperature."""
SPEED_DEVIATION_RPM = 0.15
"""Of a speed that is seen in the current."""
TYPICAL = 0.7
"""Tolerance of parameters that are typical of the rating: half to twice."""


@dataclass(frozen=True, slots=True)
class Outcome:
    """What was told of one record, beside the truth."""

    load: float
    kind: str
    truth: float
    efficiency: float | None
    covered: bool
    width: float


def main() -> None:
    """Write the page."""
    outcomes = list(_outcomes())
    rows = []
    for kind in dict.fromkeys(one.kind for one in outcomes):
        for load in LOADS:
            drawn = [one for one in outcomes if (one.kind, one.load) == (kind, load)]
            own = [one for one in drawn if one.efficiency is not None]
            errors = sorted(100.0 * abs((one.efficiency or 0.0) - one.truth) for one in own)
            rows.append(
                [
                    kind,
                    f"{load:.0%}",
                    f"{len(own) / len(drawn):.1%}",
                    f"{median(errors):.1f}",
                    f"{errors[int(0.95 * len(errors))]:.1f}",
                    f"{100.0 * median(one.width for one in own) / 2.0:.1f}",
                    rate_text(sum(one.covered for one in own), len(own)),
                ]
            )
    header = [
        "parameters, speed",
        "load",
        "told",
        "error, median",
        "95 %",
        "half of the interval",
        "interval holds",
    ]
    PAGE.write_text(PREAMBLE + "\n".join(table(header, rows)) + "\n" + CLOSING, "utf-8")


def _outcomes() -> Iterator[Outcome]:
    random = np.random.default_rng(SEED)
    for _ in range(MOTORS):
        sound = rated_motor(float(random.choice(POWERS_KW)), int(random.choice(POLES)))
        load = float(random.choice(LOADS))
        for kind, tolerance, seen in (
            ("commissioned, seen", 0.1, True),
            ("commissioned, by the model", 0.1, False),
            ("typical, by the model", TYPICAL, False),
        ):
            yield _outcome(random, sound, load, kind, tolerance, seen=seen)


def _outcome(
    random: np.random.Generator, cold: Motor, load: float, kind: str, tolerance: float, *, seen: bool
) -> Outcome:
    machine = cold.parameters
    warmth = random.uniform(*WARMTH)
    hot = replace(
        machine,
        stator_resistance_ohm=warmth * machine.stator_resistance_ohm,
        rotor_resistance_ohm=warmth * machine.rotor_resistance_ohm,
    )
    truth = replace(cold, parameters=hot)
    plate = truth.nameplate
    volts, hertz = plate.winding_voltage_V, plate.rated_frequency_Hz
    rated = load_point(truth, volts, hertz, plate.rated_power_W)
    core, friction, stray = (random.uniform(*one) for one in (CORE, FRICTION, STRAY))
    of_windings = 1.0 - core - friction - stray
    rated_W = copper_W(truth, rated) / of_windings
    at = load_point(truth, volts, hertz, load * plate.rated_power_W)
    idle_A = abs(load_point(truth, volts, hertz, 0.0).current_A)
    grown = (abs(at.current_A) ** 2 - idle_A**2) / (abs(rated.current_A) ** 2 - idle_A**2)
    iron_W = core * rated_W
    lost_W = copper_W(truth, at) + iron_W
    lost_W += friction * rated_W + stray * rated_W * grown
    drawn_W = 3.0 * volts * at.current_A.real + iron_W
    current_A = abs(at.current_A + iron_W / (3.0 * volts))
    told = measure_losses(
        _file(random, cold, tolerance),
        replace(healthy(), indicators=Indicators(0.0, 0.0, 0.0, 0.0, 1.0, 0.0)),
        _supply(truth, drawn_W, current_A),
        RotorFinding.untold("a benchmark", 1.0),
        _speed(random, truth, at.slip, warmth, tolerance, seen=seen),
    )
    efficiency = 1.0 - lost_W / drawn_W
    low, high = told.efficiency_ci95 or (0.0, 1.0)
    return Outcome(load, kind, efficiency, told.efficiency, low <= efficiency <= high, high - low)


def _file(random: np.random.Generator, motor: Motor, tolerance: float) -> Motor:
    """Return the motor as its file has it: each parameter off by its tolerance."""
    names = ParameterTolerances.names()
    values = {
        name: getattr(motor.parameters, name) * float(np.exp(random.uniform(-tolerance, tolerance)))
        for name in names
    }
    return replace(
        motor,
        parameters=replace(motor.parameters, **values),
        tolerances=ParameterTolerances(**dict.fromkeys(names, tolerance)),
        parameters_source=ParametersSource.COMMISSIONED,
    )


def _supply(motor: Motor, power_W: float, current_A: float) -> SupplyFigures:
    plate = motor.nameplate
    return SupplyFigures(
        frequency_hz=plate.rated_frequency_Hz,
        line_voltages_V=(plate.rated_voltage_V,) * 3,
        voltage_unbalance_iec=0.0,
        voltage_unbalance_nema=0.0,
        derating=1.0,
        voltage_deviation=0.0,
        thd_voltage=0.0,
        harmonic_voltage_factor=0.0,
        voltage_harmonics=(1.0,),
        line_currents_A=(current_A,) * 3,
        current_unbalance=0.0,
        thd_current=0.0,
        current_harmonics=(1.0,),
        active_power_W=power_W,
        power_factor=power_W / (sqrt(3.0) * plate.rated_voltage_V * current_A),
        duration_s=1.0,
        reasons=(),
    )


def _speed(
    random: np.random.Generator, motor: Motor, slip: float, warmth: float, tolerance: float, *, seen: bool
) -> SpeedFinding:
    """Return a speed: as seen, or by a model whose rotor resistance is cold and off by its tolerance."""
    synchronous_rpm = motor.nameplate.synchronous_rpm
    if seen:
        rpm = synchronous_rpm * (1.0 - slip) + SPEED_DEVIATION_RPM * random.normal()
        ends = (rpm - 1.96 * SPEED_DEVIATION_RPM, rpm + 1.96 * SPEED_DEVIATION_RPM)
        state, source = SpeedState.SEEN, SpeedSource.CURRENT
        found = 1.0 - rpm / synchronous_rpm
    else:
        found = slip / warmth * float(np.exp(random.uniform(-tolerance, tolerance)))
        rpm, ends, state, source = (
            synchronous_rpm * (1.0 - found),
            None,
            SpeedState.NOT_SEEN,
            SpeedSource.MODEL,
        )
    return SpeedFinding(state, source, rpm, ends, found, None, None, None, (), ())


PREAMBLE = f"""# Losses and efficiency

Asked: how near is the [efficiency](../reference/losses.md) that a record tells to that of the motor, and does
its interval hold it? `python -m benchmarks.losses` draws {MOTORS:,} motors (0.8 to 1,200 kW, 2 to 8 poles)
whose losses are not those that the service takes for usual: core {CORE[0]:.0%} to {CORE[1]:.0%}, friction
{FRICTION[0]:.0%} to {FRICTION[1]:.0%}, stray load losses {STRAY[0]:.0%} to {STRAY[1]:.0%} of all at rated
load, as tests of cage motors give them; resistances up to {WARMTH[1] - 1.0:.0%} above the file's. Errors in
points of efficiency, of records that tell it.

"""
CLOSING = """
What faults cost is compared with simulated motors, which draw more power with the fault at the same load:
shorted turns within 15 %, an unbalanced supply within 25 % (`tests/core/losses/test_measuring.py`).

**Falls short**: no motor on a test bench was measured. With typical parameters the interval is too wide to
compare motors; a commissioning and a speed that is seen make it narrow. Unbalance, harmonics: not drawn.
"""

if __name__ == "__main__":
    main()
