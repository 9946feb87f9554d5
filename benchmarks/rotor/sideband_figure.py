"""The sidebands of a healthy motor, of one with a broken bar, and of one whose load swings at 2sf."""

from concurrent.futures import Executor
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from benchmarks.reporting import Section
from core.diagnosis.acceptance import accept
from core.diagnosis.stator import diagnose_accepted
from core.machines.base import Array
from core.rotor.baseband import Baseband, baseband_of
from core.rotor.examining import examine_rotor
from core.rotor.finding import RotorFinding
from testing.machines.motors import MEDIUM
from testing.machines.rotor_records import FREQUENCY_HZ, RotorCase

PICTURE = Path("docs/evidence/images/rotor/sidebands.svg")
WIDEST_HZ, LEAST_DB = 8.0, -110.0
LOAD_LEVEL, SWING = 0.6, 0.05
mpl.use("Agg")
mpl.rcParams["svg.hashsalt"] = "rotor"


def sections(pool: Executor, *, quick: bool) -> list[Section]:
    """The picture, drawn unless in a hurry, and what it shows."""
    del pool
    steady = RotorCase(MEDIUM, load_level=LOAD_LEVEL)
    swings = RotorCase(
        MEDIUM, load_level=LOAD_LEVEL, swing=SWING, swing_hz=2.0 * steady.slip() * FREQUENCY_HZ
    )
    cases = {
        "healthy": steady,
        "one of 28 bars broken": RotorCase(MEDIUM, load_level=LOAD_LEVEL, broken_share=1.0 / 28.0),
        f"healthy, load swings by {SWING:.0%} at 2sf": swings,
    }
    shown = {name: _examined(case) for name, case in cases.items()}
    if not quick:
        PICTURE.parent.mkdir(parents=True, exist_ok=True)
        _draw({name: baseband for name, (baseband, _) in shown.items()})
    lines = [f"![Sidebands of the current](images/rotor/{PICTURE.name})", ""]
    lines += [f"- {name}: {_words(finding)}" for name, (_, finding) in shown.items()]
    intro = (
        "The motor of 7.5 kW at 60 % load, 10 s. Both the broken bar and the load make two sidebands; in "
        "amplitude and phase they differ, and that is what is measured."
    )
    command = "python -m benchmarks.rotor --subject sidebands"
    return [Section("sidebands", "What it looks like", command, (intro, "", *lines))]


def _examined(case: RotorCase) -> tuple[Baseband, RotorFinding]:
    acceptance = accept(case.record(10.0), MEDIUM)
    if acceptance.accepted is None:
        raise RuntimeError(f"the quality gate refuses the record: {acceptance.quality}")
    recorded = baseband_of(acceptance.accepted)
    return recorded, examine_rotor(recorded, acceptance.accepted, diagnose_accepted(acceptance))


def _words(finding: RotorFinding) -> str:
    return (
        f"{finding.state}; sidebands {finding.lower_sideband_dB:.1f} and {finding.upper_sideband_dB:.1f} dB, "
        f"severity {finding.severity_dB:.1f} dB, the load's own torque at 2sf "
        f"{finding.load_oscillation_dB:.1f} dB of rated"
    )


def _draw(shown: dict[str, Baseband]) -> None:
    figure = Figure(figsize=(9.0, 3.2), layout="constrained")
    row = figure.subplots(1, len(shown), sharey=True, squeeze=False)[0]
    for axes, (title, baseband) in zip(row, shown.items(), strict=True):
        hertz, level = _spectrum(baseband)
        axes.plot(hertz, level, linewidth=1.0, color="tab:blue")
        axes.set_title(title, fontsize="medium")
        axes.set_xlabel("beside the supply's line [Hz]")
        axes.set_xlim(-WIDEST_HZ, WIDEST_HZ)
        axes.set_ylim(LEAST_DB, 0.0)
        axes.grid(visible=True, linewidth=0.3)
    row[0].set_ylabel("current over the fundamental [dB]")
    figure.savefig(PICTURE, metadata={"Date": None})


def _spectrum(baseband: Baseband) -> tuple[Array, Array]:
    """Forward current about the fundamental under a Blackman window, over the fundamental."""
    window = np.blackman(baseband.current.size)
    size = 4 * baseband.current.size
    lines = np.fft.fftshift(np.fft.fft(baseband.current * window, size)) / window.sum()
    step_s = float(baseband.time_s[1] - baseband.time_s[0])
    hertz = np.fft.fftshift(np.fft.fftfreq(size, step_s))
    near = np.abs(hertz) <= WIDEST_HZ
    level = np.abs(lines[near]) / (np.abs(baseband.current.mean()) * baseband.gain(hertz[near]))
    return hertz[near], 20.0 * np.log10(np.maximum(level, 1e-9))
