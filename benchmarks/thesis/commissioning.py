"""The thesis's chapter 5 again: a motor's parameters from its start, with our figures beside its own.

python -m benchmarks.thesis.commissioning [--seeds N] [--first-seed N] [--images FOLDER]

prints the section as Markdown.

Records come from the simulator's phase windings (testing/machines/starts.py), which share no code
with the models. The motor is Table 3.2's; the estimator is told the middle of Table 5.1, never the truth.
"""

import argparse
from concurrent.futures import Executor, ProcessPoolExecutor
from dataclasses import dataclass, replace
from multiprocessing import get_context
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from benchmarks.optimisers.start_problems import INERTIA_OF_H, LOWER, SYMBOLS, TRUTH, UPPER, Box, machine_at
from benchmarks.reporting import spread, table
from benchmarks.thesis import commissioning_alone as by_hcpa
from benchmarks.thesis.commissioning_bound import bound
from benchmarks.thesis.commissioning_plots import (
    plot_errors,
    plot_intervals,
    plot_start,
    plot_trajectories,
)
from core.commissioning.commissioning import commission
from core.commissioning.prior import PARAMETERS
from core.commissioning.result import Commissioning
from core.commissioning.start_detection import start_of
from core.machines.candidates import LoadLaw
from core.machines.parameters import MachineParameters
from core.machines.playback import electrical_to_rpm
from core.machines.starting import start_candidate
from testing.machines.motors import REFERENCE
from testing.machines.starts import StartRecord, plate_of

Array = NDArray[np.float64]
IMAGES = Path(__file__).parents[2] / "docs" / "evidence" / "images" / "thesis"
MIDDLE = 0.5 * (LOWER + UPPER)
LOADS = (0.0, 0.25, 0.5, 0.75, 1.0)
WINDOWS: tuple[tuple[str, tuple[float, float]], ...] = (
    ("[0, 1] s", (0.0, 1.0)),
    ("[0, 0.5] s", (0.0, 0.5)),
    ("[0.5, 1] s", (0.5, 1.0)),
)
THESIS_WINDOWS = {
    "[0, 1] s": "8.54, 8.15, 0.0338, 0.4381, 1.64, 49.90 %; refined: exact",
    "[0, 0.5] s": "8.08, 8.03, 0.0354, 0.4384, 1.58, 48.82 %",
    "[0.5, 1] s": "8.24, 8.35, 0.0318, 0.4573, 1.60, 52.83 %",
}
SNR_DB = 30.0
SEEDS = 50
"""Records a load of the first second; of the first half second half as many."""
FIRST_SEED = 7_000
"""Low seeds served while the estimator was written; the page is measured on others."""
RANDOM_TRUTHS = 20
HCPA_SEEDS = 4
"""Records a load on which the ways to use HCPA alone are compared; the best of them runs on all."""
NOISY_VOLTAGE_SEEDS = 8
PROCESSES = 2


def section(seeds: int = SEEDS, images: Path = IMAGES, first_seed: int = FIRST_SEED) -> str:
    """Chapter 5 as Markdown; writes its plots into `images`."""
    images.mkdir(parents=True, exist_ok=True)
    with ProcessPoolExecutor(PROCESSES, mp_context=get_context("spawn")) as pool:
        lines = [
            "## Chapter 5: parameters from a start",
            "",
            *_trajectories(images),
            *_windows(images, first_seed),
            *_loads(seeds, images, first_seed, pool),
            *_noisy_voltages(min(seeds, NOISY_VOLTAGE_SEEDS), first_seed, pool),
            *_whole_table(first_seed, pool),
        ]
    return "\n".join(lines)


def nelder_mead(box: Box, begin: Array) -> Array:
    """Every point Nelder and Mead's method tries from a beginning, (evaluations, dimensions)."""
    tried: list[Array] = []

    def cost(unit: Array) -> float:
        tried.append(box.lower + unit * (box.upper - box.lower))
        return float(box.cost(tried[-1][np.newaxis])[0])

    minimize(
        cost, (begin - box.lower) / (box.upper - box.lower), method="Nelder-Mead",
        options={"maxfev": 1500, "xatol": 1e-7, "fatol": 1e-12, "adaptive": True},
    )  # fmt: skip
    return np.array(tried)


def commissioned(
    record: StartRecord,
    span_s: tuple[float, float | None] = (0.0, 1.0),
    motor: MachineParameters | None = None,
) -> Commissioning:
    """The product's own commissioning, told the middle of Table 5.1."""
    truth = REFERENCE if motor is None else replace(REFERENCE, parameters=motor)
    told = plate_of(REFERENCE, machine_at(MIDDLE))
    return commission([record.of(truth)], told, load_law=LoadLaw.CONSTANT, span_s=span_s)


@dataclass(frozen=True, slots=True)
class Trial:
    """A record of a motor and the part of it that is compared."""

    record: StartRecord
    span_s: tuple[float, float | None] = (0.0, 1.0)
    motor: MachineParameters = REFERENCE.parameters


def outcome(trial: Trial) -> tuple[Array, list[bool]]:
    """Relative errors (5,) of a trial, and whether each interval there is holds its truth."""
    found = commissioned(trial.record, trial.span_s, trial.motor)
    return errors(found, trial.motor), covered(found, trial.motor)


def outcomes(trials: list[Trial], label: str, pool: Executor) -> tuple[Array, list[bool]]:
    """Errors (trials, 5), and of all intervals whether they hold the truth."""
    found = list(spread(outcome, trials, label, pool))
    return np.array([wrong for wrong, _ in found]), [hit for _, hits in found for hit in hits]


def errors(found: Commissioning, truth: MachineParameters) -> Array:
    """Relative errors of the five parameters."""
    return np.array([found.parameters[name].value / getattr(truth, name) - 1.0 for name in PARAMETERS])


def covered(found: Commissioning, truth: MachineParameters) -> list[bool]:
    """Whether each interval there is holds its truth."""
    hits = []
    for name in PARAMETERS:
        interval = found.parameters[name].ci95
        if interval is not None:
            hits.append(interval[0] <= getattr(truth, name) <= interval[1])
    return hits


def _trajectories(images: Path) -> list[str]:
    box = Box(start_of(StartRecord().of(REFERENCE), REFERENCE.nameplate, plate_of(REFERENCE).channels), 0.0)
    truth = np.array([*TRUTH, 0.5])
    rows = []
    for name, settings, printed in (
        ("5.2", by_hcpa.FIG_5_2, "7.88, 8.49, 0.0319, 0.4386, 1.91, 48.93 % (934)"),
        ("5.3", by_hcpa.FIG_5_3, "8.54, 8.15, 0.0338, 0.4381, 1.64, 49.90 % (< 460)"),
    ):
        result = by_hcpa.search(box.cost, box.bounds, settings)
        plot_trajectories(images / f"fig-{name.replace('.', '-')}.png", result.points, truth, SYMBOLS)
        rows.append(
            [f"{name}, adaptiveness {settings.adaptiveness:g}", printed, _point(result.x, result.nfev)]
        )
    tried = nelder_mead(box, result.x)
    plot_trajectories(images / "fig-5-5.png", tried, truth, SYMBOLS)
    rows.append(["5.5, Nelder-Mead from there", "exact after 272", _point(tried[-1], len(tried))])
    found = commissioned(StartRecord())
    _plot_start(images / "fig-5-4.png", found)
    own = [*(found.parameters[name].value for name in PARAMETERS), found.starts[0].load_level.value]
    own[4] /= INERTIA_OF_H
    rows.append(["`mcc commission`", "-", _point(np.array(own), found.evaluations)])
    return [
        "### Trajectories (Figs. 5.2, 5.3, 5.5)",
        "",
        "Half load, no noise, T_d known, as in section 5.3: R_s, R_r', L_ls, L_s, H, LL (evaluations). "
        "The truth is 8.4, 8.2, 0.0328, 0.4377, 1.80, 50 %.",
        "",
        *table(("figure", "thesis", "here"), rows),
        "",
        *(f"![trajectories](images/thesis/fig-5-{number}.png)" for number in (2, 3, 5)),
        "",
        "Measured and modelled current, their squared distance and the speed, like Fig. 5.4:",
        "",
        "![start](images/thesis/fig-5-4.png)",
        "",
    ]


def _plot_start(path: Path, found: Commissioning) -> None:
    start = start_of(StartRecord().of(REFERENCE), REFERENCE.nameplate, plate_of(REFERENCE).channels)
    load, offset = found.starts[0].load_level.value, found.starts[0].time_offset_s.value
    track = start.playback(LoadLaw.CONSTANT).trajectories(start_candidate(found.machine, load, offset))
    seconds = np.arange(track.speed.shape[1]) / start.sample_rate_hz
    rpm = electrical_to_rpm(track.speed[0], REFERENCE.nameplate.pole_pairs)
    plot_start(path, seconds, start.measured_ab, track.current[0], rpm)


def _windows(images: Path, seed: int) -> list[str]:
    rows, widths = [], {}
    for name, span in WINDOWS:
        found = commissioned(StartRecord(snr_db=SNR_DB, seed=seed), span)
        wrong = errors(found, REFERENCE.parameters)
        widths[name] = [_half(found, key) for key in PARAMETERS]
        rows.append(
            [
                name,
                THESIS_WINDOWS[name],
                ", ".join(
                    f"{symbol} fixed" if found.parameters[key].fixed else f"{symbol} {100 * error:+.2f} %"
                    for symbol, key, error in zip(SYMBOLS, PARAMETERS, wrong, strict=False)
                ),
                "yes" if found.identifiable else "**no**",
                f"{found.condition_number:.3g}",
            ]
        )
    plot_intervals(images / "windows.png", widths, SYMBOLS[:5])
    return [
        "### Data window (section 5.3.3)",
        "",
        f"Half load, SNR {SNR_DB:g} dB on the currents. Steady running alone is reported as what it is: "
        "the parameters are fixed at what was known before and named, none is passed off as estimated.",
        "",
        *table(("window", "thesis, no noise", "errors here", "identifiable", "condition"), rows),
        "",
        "![half widths of the intervals](images/thesis/windows.png)",
        "",
    ]


def _loads(seeds: int, images: Path, first_seed: int, pool: Executor) -> list[str]:
    rows, refined, alone, compared = [], {}, {}, []
    for load in LOADS:
        for window, span, count in ((*WINDOWS[0], seeds), (*WINDOWS[1], _fewer(seeds))):
            record = StartRecord(load_level=load, duration_s=span[1], snr_db=SNR_DB)
            least = pool.submit(bound, REFERENCE, record)
            records = [_seeded(record, first_seed + seed) for seed in range(count)]
            trials = [Trial(one, span) for one in records]
            wrong, hits = outcomes(trials, f"load {load:.0%}, {window}", pool)
            deviation = least.result()
            allowed = 2.6 * deviation < 0.01
            within = np.abs(wrong) < 0.01
            if span == WINDOWS[0][1]:
                refined[load] = wrong
                tasks = [(by_hcpa.BEST, one) for one in records]
                found = spread(by_hcpa.alone, tasks, f"load {load:.0%}, HCPA alone", pool)
                alone[load] = np.array([errors_of for errors_of, _ in found])
                compared += records[:HCPA_SEEDS]
            rows.append(
                [
                    f"{load:.0%}",
                    window,
                    ", ".join(f"{100 * value:.2f}" for value in np.abs(wrong).max(axis=0)),
                    ", ".join(f"{100 * value:.2f}" for value in np.sqrt(np.mean(wrong**2, axis=0))),
                    ", ".join(f"{100 * value:.2f}" for value in deviation),
                    f"{np.mean(np.abs(wrong).max(axis=1) < 0.05):.0%}",
                    f"{np.mean(within[:, allowed].all(axis=1)):.0%} ({int(allowed.sum())} of 5)",
                    f"{np.mean(hits):.1%}",
                ]
            )
    plot_errors(images / "fig-5-8.png", alone, SYMBOLS[:5])
    plot_errors(images / "fig-5-9.png", refined, SYMBOLS[:5])
    return [
        "### Loads (Figs. 5.8, 5.9)",
        "",
        f"SNR {SNR_DB:g} dB on the currents, {seeds} seeds a load for the first second and {_fewer(seeds)} "
        f"for the first half, from {first_seed} on: lower ones served while the estimator was written. T_d "
        "anywhere in its 20 ms and the instant of switching anywhere in the cycle. Errors in % of R_s, R_r', "
        "L_ls, L_s, J. The bound is Cramer and Rao's for seven unknowns from the simulator's own currents; "
        "it allows 1 % where 2.6 of its standard "
        "deviations (99 % of the errors) are below. The switching flux, which is fitted too, is not "
        "among them: an error somewhat above the bound is its price.",
        "",
        *table(
            (
                "load",
                "window",
                "greatest error",
                "rms error",
                "bound",
                "all within 5 %",
                "within 1 % where the bound allows",
                "intervals that hold the truth",
            ),
            rows,
        ),
        "",
        *by_hcpa.lines(compared, np.concatenate(list(alone.values())), pool),
        "![HCPA alone](images/thesis/fig-5-8.png)",
        "![refined](images/thesis/fig-5-9.png)",
        "",
    ]


def _noisy_voltages(seeds: int, first_seed: int, pool: Executor) -> list[str]:
    trials = [
        Trial(_seeded(StartRecord(load_level=load, snr_db=SNR_DB, voltage_snr_db=SNR_DB), first_seed + seed))
        for load in LOADS
        for seed in range(seeds)
    ]
    wrong, hits = outcomes(trials, "noisy voltages", pool)
    greatest = ", ".join(f"{100 * value:.2f}" for value in np.abs(wrong).max(axis=0))
    return [
        "### Noise on the voltages too",
        "",
        f"White noise of {SNR_DB:g} dB on currents and voltages, the first second, the same loads with "
        f"{seeds} seeds each: greatest errors of R_s, R_r', L_ls, L_s, J {greatest} %; intervals that "
        f"hold the truth {np.mean(hits):.1%} of {len(hits)}. The models integrate the voltages' noise.",
        "",
    ]


def _whole_table(first_seed: int, pool: Executor) -> list[str]:
    random = np.random.default_rng((51, first_seed))
    trials = []
    for seed in range(RANDOM_TRUTHS):
        truth = LOWER + random.uniform(size=7) * (UPPER - LOWER)
        record = _seeded(StartRecord(load_level=float(truth[5]), snr_db=SNR_DB), first_seed + seed)
        trials.append(Trial(replace(record, time_offset_s=float(truth[6])), motor=machine_at(truth)))
    motors = [replace(REFERENCE, parameters=trial.motor) for trial in trials]
    least = pool.map(bound, motors, [trial.record for trial in trials])
    errors_of, hits = outcomes(trials, "anywhere in Table 5.1", pool)
    wrong = np.abs(errors_of)
    worst = wrong.max(axis=1)
    inside = [
        bool((one[2.6 * deviation < 0.01] < 0.01).all()) for one, deviation in zip(wrong, least, strict=True)
    ]
    return [
        "### Anywhere in Table 5.1",
        "",
        f"{RANDOM_TRUTHS} random motors and loads from Table 5.1's ranges, the first second, SNR "
        f"{SNR_DB:g} dB: greatest error of any parameter {100 * worst.max():.2f} %, median of the greatest "
        f"{100 * np.median(worst):.2f} %; all within 5 % in {np.mean(worst < 0.05):.0%}; "
        f"within 1 % wherever the bound allows in {np.mean(inside):.0%}; intervals that hold the truth "
        f"{np.mean(hits):.1%}.",
        "",
    ]


def _fewer(seeds: int) -> int:
    """Seeds of the shorter window."""
    return max(1, seeds // 2)


def _seeded(record: StartRecord, seed: int) -> StartRecord:
    random = np.random.default_rng((seed, 5))
    return replace(
        record,
        time_offset_s=float(random.uniform(0.0, 0.02)),
        switched_at_s=float(random.uniform(0.0, 0.02)),
        duration_s=record.duration_s + 0.025,
        seed=seed,
    )


def _half(found: Commissioning, name: str) -> float:
    one = found.parameters[name]
    return float("nan") if one.ci95 is None else 0.5 * (one.ci95[1] - one.ci95[0]) / one.value


def _point(x: Array, evaluations: int) -> str:
    R_s, R_r, L_l, L_s, H, load = x[:6].tolist()
    return f"{R_s:.2f}, {R_r:.2f}, {L_l:.4f}, {L_s:.4f}, {H:.2f}, {load:.2%} ({evaluations})"


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=SEEDS)
    parser.add_argument("--first-seed", type=int, default=FIRST_SEED)
    parser.add_argument("--images", type=Path, default=IMAGES)
    arguments = parser.parse_args()
    print(section(arguments.seeds, arguments.images, arguments.first_seed))
