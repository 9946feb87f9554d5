"""Unequal rotor phases, and the resistance at the rings that their sidebands tell."""

from collections.abc import Sequence
from concurrent.futures import Executor

import numpy as np

from benchmarks.reporting import Section, spread, table
from benchmarks.wound_rotor.cases import MOTORS, Result, Subject, examined
from core.rotor.finding import RotorState

CONTACTS, LOADS, SEEDS = (0.01, 0.02, 0.05, 0.1, 0.3), (0.3, 0.6, 0.9), 2
SHARES = (0.0, 0.05, 0.15)


def sections(pool: Executor, *, quick: bool) -> list[Section]:
    """The table by what one rotor phase has more."""
    subjects = [
        Subject(motor, load, share, "unknown", seed, contact_share=contact)
        for motor in MOTORS
        for share in SHARES
        for contact in CONTACTS
        for load in LOADS[: 1 if quick else None]
        for seed in range(1 if quick else SEEDS)
    ]
    results = list(spread(examined, subjects, "unequal phases", pool))
    rows = [
        _row(contact, [one for one in results if one.subject.contact_share == contact])
        for contact in CONTACTS
    ]
    lines = [
        f"{len(results)} records of 4 s of both motors at {', '.join(f'{load:.0%}' for load in LOADS)} load, "
        "the resistance at the rings unknown: 0, 5 or 15 % of that which makes rated torque at standstill. "
        "One phase of the rotor's circuit has more resistance than the others. The slip is told where its "
        "sidebands are.",
        "",
        *table(
            [
                "one phase has more",
                "true severity",
                "fault",
                "watch",
                "healthy",
                "unsupported",
                "severity off, 95 % of them",
                "slip told",
                "off by, 95 % of them",
            ],
            rows,
        ),
    ]
    command = "python -m benchmarks.wound_rotor --subject winding"
    return [Section("winding", "Unequal rotor phases, and what is at the rings", command, tuple(lines))]


def _row(contact: float, results: Sequence[Result]) -> list[str]:
    findings = [one.found.rotor for one in results]
    states = (RotorState.FAULT, RotorState.WATCH, RotorState.HEALTHY, RotorState.UNSUPPORTED)
    true_dB = 20.0 * np.log10(contact / 3.0 / (1.0 + contact / 3.0))
    off_dB, off = [], []
    for one, finding in zip(results, findings, strict=True):
        if finding.slip is not None and finding.severity_dB is not None:
            off_dB.append(abs(finding.severity_dB - true_dB))
            off.append(abs(finding.slip / one.slip - 1.0))
    return [
        f"{contact:.0%}",
        f"{true_dB:.1f} dB",
        *(str(sum(one.state is state for one in findings)) for state in states),
        f"{np.quantile(off_dB, 0.95):.1f} dB" if off_dB else "none",
        f"{len(off)} of {len(results)}",
        f"{np.quantile(off, 0.95):.1%}" if off else "none",
    ]
