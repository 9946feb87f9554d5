"""Parameters from starts of motors as they are built: python -m benchmarks.commissioning [--quick]."""

from collections import Counter
from collections.abc import Sequence
from concurrent.futures import Executor
from pathlib import Path

import numpy as np

from benchmarks.commissioning.motors import Outcome, drawn, drawn_load, of_issue, of_steps, tried
from benchmarks.page_of_subjects import PageOfSubjects
from benchmarks.reporting import Section, rate_text, spread, table
from core.commissioning.prior import PARAMETERS

PAGE = Path("docs/evidence/commissioning.md")
PREAMBLE = """\
# Parameters from a start

Asked: how near are the parameters that `mcc commission` estimates from one start, and do the intervals hold
the truth? Records are simulated (`benchmarks/commissioning/motors.py`): rotors of two cages of coils,
leakage that falls as an arc tangent, 10 kHz, noise of 46 dB, nothing given but the plate without its speed.
The estimator has other equations and another law of saturation (`core/machines/deep_bars.py`). Parameters
are those of small slip and running currents; the rotor's leakage follows the stator's. Speed: the largest
error of the model's speed at 0.3, 0.6 and 1.0 of rated torque.

**Falls short.** The leakage is 1 % too small in the median: part of what the simulator's law takes away at
rated current counts as saturated there. A start of 3 s was to take 5 s: a second of a 7.5 kW motor takes
that, 2.5 s of a 160 kW motor ten to 24. Five hundred motors were to be drawn, not 96.
Of 16 loads that step in, two are not told and one only as unexplained: deep bars take up a small step.
These 48 starts were measured before smaller changes of the load were looked for; since then the 16 under a
constant load again had no change told, and of the first nine under a step one had not.
A start under a load that changes takes about ten times as long; all seconds of changing loads were counted
on a machine that did other work.
"""
SYMBOLS = ("R_s", "R_r", "L_ls", "L_s", "J")
FEW, SOME, MANY = 4, 16, 96


def kinds(pool: Executor, *, quick: bool) -> list[Section]:
    """One loop, and rotors of more resistance at standstill."""
    cases = of_issue()[::5] if quick else of_issue()
    outcomes = list(spread(tried, cases, "kinds of rotor", pool))
    header = ("motor", *SYMBOLS, "all intervals hold", "told to change", "speed, rpm", "s")
    rows = [
        [
            one.case.name,
            *(_share(one.errors[name]) for name in PARAMETERS),
            "yes" if all(one.held.values()) else ", ".join(n for n, held in one.held.items() if not held),
            "yes" if one.changes else "no",
            "" if one.speed_rpm is None else f"{one.speed_rpm:.2f}",
            f"{one.seconds:.1f}",
        ]
        for one in outcomes
    ]
    return [_section("kinds", "Kinds of rotor", table(header, rows))]


def random(pool: Executor, *, quick: bool) -> list[Section]:
    """Motors of any rating."""
    count = FEW if quick else MANY
    outcomes = list(spread(tried, [drawn(seed) for seed in range(count)], "drawn motors", pool))
    kept = [one for one in outcomes if not one.refused]
    rows = [_row(name, symbol, kept) for name, symbol in zip(PARAMETERS, SYMBOLS, strict=True)]
    slips = [one.slip_share for one in kept if one.slip_share is not None]
    lines = [
        f"{count} motors of 0.5 kW to 2 MW, 2 to 6 poles; resistance at a great slip 1.3 to 5 times that",
        "at a small one, its leakage 0.35 to 0.85 times; 5 to 45 % of the leakage lost by saturation;",
        f"records as long as the run-up, 0.6 to 3 s. {len(outcomes) - len(kept)} were refused.",
        "",
        *table(("parameter", "told", "error, median", "95 %", "interval holds"), rows),
        "",
        f"Slip of running records within 5 %: {rate_text(sum(s <= 0.05 for s in slips), len(slips))}.",
        f"Seconds: median {np.median([one.seconds for one in kept]):.1f},"
        f" longest {max(one.seconds for one in kept):.1f}.",
    ]
    return [_section("random", "Motors of any rating", lines)]


def loads(pool: Executor, *, quick: bool) -> list[Section]:
    """Loads that step in or rise during the start."""
    count = FEW if quick else SOME
    header = ("load", "parameter", "told", "error, median", "95 %", "interval holds")
    rows, lines = [], []
    for kind in ("constant", "step", "rise"):
        cases = [drawn_load(seed, kind) for seed in range(count)]
        outcomes = list(spread(tried, cases, f"load: {kind}", pool))
        kept = [one for one in outcomes if not one.refused]
        rows += [[kind, *_row(name, symbol, kept)] for name, symbol in zip(PARAMETERS, SYMBOLS, strict=True)]
        counted = sorted(Counter(one.load_change or "nothing" for one in kept).items())
        said = ", ".join(f"{word} {number}" for word, number in counted)
        seconds = [one.seconds for one in kept]
        lines.append(
            f"- Load {kind}: {len(outcomes) - len(kept)} refused; said of the load: {said}; "
            f"seconds: median {np.median(seconds):.1f}, longest {max(seconds):.1f}."
        )
    text = [
        f"{count} motors of 0.8 to 160 kW, one in three with deep bars and saturation, each under three",
        "loads: constant; with a step of 10 to 50 % of the rated torque at 10 to 70 % of the record; with a",
        "rise of as much, over 10 to 80 % of the rest.",
        "",
        *table(header, rows),
        "",
        *lines,
    ]
    return [_section("loads", "Loads that change during the start", text)]


def steps(pool: Executor, *, quick: bool) -> list[Section]:
    """One motor under loads that step in."""
    cases = of_steps()[:1] if quick else of_steps()
    header = ("record, step", *SYMBOLS, "intervals that miss", "said of the load", "s")
    rows = [
        [
            one.case.name,
            *(_share(one.errors[name]) for name in PARAMETERS),
            ", ".join(s for n, s in zip(PARAMETERS, SYMBOLS, strict=True) if not one.held.get(n, True))
            or "none",
            one.load_change or "nothing",
            f"{one.seconds:.0f}",
        ]
        for one in spread(tried, cases, "steps of the load", pool)
    ]
    lines = [
        "A 1.5 kW motor with R_s = 6.1 and R_r = 3.152 ohm, 20 % of its rated torque before the step;",
        "noise of 46 dB.",
        "",
        *table(header, rows),
    ]
    return [_section("steps", "One motor whose load steps in", lines)]


def _row(name: str, symbol: str, outcomes: Sequence[Outcome]) -> list[str]:
    errors = [abs(error) for one in outcomes if (error := one.errors[name]) is not None]
    held = [one.held[name] for one in outcomes if name in one.held]
    if not errors:
        return [symbol, "0", "", "", ""]
    return [
        symbol,
        f"{len(errors)} of {len(outcomes)}",
        f"{np.median(errors):.1%}",
        f"{np.percentile(errors, 95):.1%}",
        rate_text(sum(held), len(held)),
    ]


def _share(error: float | None) -> str:
    return "not told" if error is None else f"{error:+.1%}"


def _section(name: str, title: str, lines: Sequence[str]) -> Section:
    return Section(name, title, f"python -m benchmarks.commissioning --subject {name}", tuple(lines))


SUBJECTS = {"kinds": kinds, "random": random, "loads": loads, "steps": steps}

if __name__ == "__main__":
    PageOfSubjects(PAGE, PREAMBLE, SUBJECTS).measure(__doc__)
