"""Shorted turns of motors with a wound rotor, with shorted rings and with a resistance nobody knows."""

from collections.abc import Sequence
from concurrent.futures import Executor

from benchmarks.reporting import Section, rate_text, spread, table
from benchmarks.wound_rotor.cases import MOTORS, Result, Subject, examined
from core.diagnosis.verdict import Verdict

LEVELS, LOADS, SEEDS = (0.01, 0.02, 0.03, 0.05), (0.3, 0.6, 0.9), 2
RINGS: tuple[tuple[str, float, str], ...] = (
    ("shorted, known", 0.0, "shorted"),
    ("shorted, unknown", 0.0, "unknown"),
    ("a little, unknown", 0.05, "unknown"),
    ("much, unknown", 0.15, "unknown"),
)


def sections(pool: Executor, *, quick: bool) -> list[Section]:
    """The table by what is at the rings and how many turns are shorted."""
    subjects = [
        Subject(motor, load, share, "shorted" if known == "shorted" else "unknown", seed, level=level)
        for motor in MOTORS
        for _, share, known in RINGS
        for level in LEVELS
        for load in LOADS[: 1 if quick else None]
        for seed in range(1 if quick else SEEDS)
    ]
    results = list(spread(examined, subjects, "shorted turns", pool))
    rows = []
    for words, share, known in RINGS:
        for level in LEVELS:
            here = [
                one
                for one in results
                if (one.subject.external_share, one.subject.knowledge, one.subject.level)
                == (share, known, level)
            ]
            rows.append([words, f"{level:.0%}", *_row(here)])
    wrong = [one for one in results if _is_fault(one) and one.found.diagnosis.theta_f != one.phase]
    lines = [
        f"{len(results)} records of 4 s of both motors at {', '.join(f'{load:.0%}' for load in LOADS)} load. "
        "Resistance at the rings, over that which makes rated torque at standstill: 5 % (a little), 15 % "
        "(much); the file says 0 to 20 % where it is unknown.",
        "",
        *table(
            ["at the rings", "shorted", "fault", "watch", "interval holds the level", "load off at most"],
            rows,
        ),
        "",
        f"Faults in a wrong phase: {rate_text(len(wrong), sum(map(_is_fault, results)))}.",
    ]
    return [
        Section("stator", "Shorted turns", "python -m benchmarks.wound_rotor --subject stator", tuple(lines))
    ]


def _is_fault(result: Result) -> bool:
    return result.found.diagnosis.verdict is Verdict.FAULT


def _row(results: Sequence[Result]) -> list[str]:
    diagnoses = [one.found.diagnosis for one in results]
    holds = [
        one.mu_f_ci95 is not None and one.mu_f_ci95[0] <= result.subject.level <= one.mu_f_ci95[1]
        for one, result in zip(diagnoses, results, strict=True)
    ]
    loads = [
        abs(one.load_level - result.subject.load_level)
        for one, result in zip(diagnoses, results, strict=True)
        if one.load_level is not None
    ]
    watch = sum(one.verdict is Verdict.WATCH for one in diagnoses)
    counts = (sum(map(_is_fault, results)), watch, sum(holds))
    return [*(f"{count} of {len(results)}" for count in counts), f"{max(loads):.3f}" if loads else "none"]
