"""Motors with shorted turns as others model them, judged: python -m benchmarks.winding.others KIND FOLDER.

KIND is "fields" (finite elements in time, needs gmsh and getdp) or "equations" (two axes, needs octave-cli);
FOLDER holds the files of the authors' repository. Neither is part of this project, and nothing of them is
kept: currents and voltages go to the folder of `--work`, and a run that is there already is only judged.
docs/evidence/other-winding-models.md says where the files come from and what was found.
"""

import argparse
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from benchmarks.reporting import table
from benchmarks.winding import others_equations, others_fields
from core.diagnosis.stator import diagnose
from core.diagnosis.verdict import Diagnosis, Verdict
from core.machines.parameters import MachineParameters, Motor, Nameplate
from core.machines.sensors import SensorClass
from core.machines.stator_winding import StatorWinding, WindingKind
from core.recordings import Recording
from testing.machines.disturbed_records import record_of
from testing.machines.slot_fault_records import PRECISE, USUAL

Array = NDArray[np.float64]

CLASSES = {"0.2 %, 5 us": PRECISE, "1 %, 25 us": USUAL}
DRAWS = 8
"""Relays whose channels are drawn, a class."""
NOISE = 0.002
SHOWN = (Verdict.FAULT, Verdict.WATCH, Verdict.HEALTHY)
MARGIN = 2
"""Samples left at both ends, where the delayed channels are not interpolated well."""
HEADER = (
    "case", "level", "channels", "winding given", "fault", "watch", "healthy", "phase a named",
    "another named", "level, median", "interval holds", "likeliest",
)  # fmt: skip
FIELD_MOTOR = Motor(
    "3 kW, 4 poles, of finite elements",
    Nameplate(3_000.0, 380.0, 50.0, pole_pairs=2),
    # R_s as the authors give it. The rest fits their model's impedance in the frequency domain at slips of
    # 0, 2, 4 and 100 % within 2 %, with both leakages equal.
    MachineParameters.from_magnetising_inductance(
        stator_resistance_ohm=2.2,
        rotor_resistance_ohm=1.598,
        stator_leakage_H=5.83e-3,
        rotor_leakage_H=5.83e-3,
        magnetising_inductance_H=0.1765,
        inertia_kgm2=0.02,
    ),
)
EQUATION_MOTOR = Motor(
    "1.5 kW, 2 poles, of two axes",
    # Its phases have 220 V, in delta; the equations leave no zero sequence, as in star at 381 V.
    Nameplate(1_491.4, 381.05, 60.0, pole_pairs=1),
    MachineParameters.from_magnetising_inductance(
        stator_resistance_ohm=6.1,
        rotor_resistance_ohm=3.15218,
        stator_leakage_H=1.87303e-3,
        rotor_leakage_H=1.87303e-3,
        magnetising_inductance_H=0.271407,
        inertia_kgm2=0.03,
    ),
)
LAP = StatorWinding(WindingKind.LAP, 36, 1, 9)
CONCENTRIC = StatorWinding(WindingKind.CONCENTRIC, 36, 1)


@dataclass(frozen=True, slots=True)
class Run:
    """Currents and phase voltages of a steady motor, (6, n), and what is true of them."""

    name: str
    samples: Array
    sample_rate_hz: float
    level: float
    motor: Motor
    winding: StatorWinding | None


def field_runs(folder: Path, work: Path) -> Iterator[Run]:
    """Run the finite elements, or take what is there."""
    for k, case in enumerate(others_fields.CASES):
        here = work / f"fields-{k}"
        if not (here / "res" / "Ic.dat").exists():
            others_fields.run(folder, here, case)
        samples, turns = others_fields.steady(here)
        level = turns / others_fields.TURNS_PER_PHASE / (1.0 + case.path_ratio)
        rate = others_fields.FREQUENCY_HZ * others_fields.STEPS
        winding = CONCENTRIC if "concentric" in case.name else LAP
        yield Run(case.name, samples, rate, level, FIELD_MOTOR, winding)


def equation_runs(folder: Path, work: Path) -> Iterator[Run]:
    """Run the equations, or take what is there."""
    for k, case in enumerate(others_equations.CASES):
        kept = work / f"equations-{k}.npy"
        if not kept.exists():
            np.save(kept, others_equations.run(folder, work / f"equations-{k}", case))
        share = case.turns / others_equations.TURNS_PER_PHASE
        own_ohm = share * EQUATION_MOTOR.parameters.stator_resistance_ohm
        level = share / (1.0 + case.path_ohm / own_ohm) if share else 0.0
        rate = 1.0 / (others_equations.STEP_S * others_equations.EVERY)
        yield Run(case.name, np.load(kept)[:6], rate, level, EQUATION_MOTOR, None)


def seen_by(run: Run, sensors: SensorClass, seed: int) -> Recording:
    """Return the record of a relay whose channels are drawn from the class."""
    random = np.random.default_rng([seed, 41])
    spans = np.repeat([sensors.current_gain, sensors.voltage_gain], 3)
    delays = random.uniform(-1.0, 1.0, 6) * np.repeat([sensors.current_delay_s, sensors.voltage_delay_s], 3)
    gains = 1.0 + random.uniform(-1.0, 1.0, 6) * spans
    times = np.arange(run.samples.shape[1]) / run.sample_rate_hz
    wanted = times[MARGIN:-MARGIN]
    rows = [
        gain * CubicSpline(times, row)(wanted - delay)
        for row, gain, delay in zip(run.samples, gains, delays, strict=True)
    ]
    scale = np.repeat([float(np.std(run.samples[:3])), float(np.std(run.samples[3:]))], 3)
    noise = NOISE * scale[:, np.newaxis] * random.standard_normal((6, wanted.size))
    return record_of(np.stack(rows) + noise, run.sample_rate_hz)


def rows_of(run: Run) -> Iterator[list[str]]:
    """Rows of the table: with and without the winding, both classes."""
    for name, sensors in CLASSES.items():
        for winding in (None, run.winding) if run.winding is not None else (None,):
            motor = replace(run.motor, sensors=sensors, winding=winding)
            found = [diagnose(seen_by(run, sensors, seed), motor) for seed in range(DRAWS)]
            yield [run.name, f"{run.level:.2%}", name, "no" if winding is None else "yes", *_told(run, found)]


def _told(run: Run, found: list[Diagnosis]) -> list[str]:
    counts = [sum(one.verdict is kind for one in found) for kind in SHOWN]
    named = [one.phase for one in found if one.phase is not None]
    levels = [one.mu_f for one in found if one.mu_f is not None]
    holds = sum(
        one.mu_f_ci95 is not None and one.mu_f_ci95[0] <= run.level <= one.mu_f_ci95[1] for one in found
    )
    answers = [one.hypotheses[0].cause.value for one in found if one.hypotheses]
    likeliest = max(set(answers), key=answers.count) if answers else "refused"
    return [
        *(str(count) for count in counts),
        str(named.count("a")),
        str(len(named) - named.count("a")),
        f"{np.median(levels):.2%}" if levels else "",
        f"{holds} of {len(found)}",
        f"{likeliest} ({answers.count(likeliest)})",
    ]


RUNS = {"fields": field_runs, "equations": equation_runs}


def main() -> None:
    """Judge one of the models and print the table."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.winding.others")
    parser.add_argument("kind", choices=list(RUNS))
    parser.add_argument("folder", type=Path, help="files of the authors' repository")
    parser.add_argument("--work", type=Path, required=True, help="folder for currents; made where missing")
    chosen = parser.parse_args()
    runs = RUNS[chosen.kind](chosen.folder, chosen.work)
    print("\n".join(table(HEADER, [row for run in runs for row in rows_of(run)])))


if __name__ == "__main__":
    main()
