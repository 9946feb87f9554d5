"""Draw what a demo found: python examples/picture_of_a_demo.py DEMO.json PICTURE.png

DEMO.json comes from `mcc demo --once --json DEMO.json`. Needs matplotlib (in the dev extra).
"""

import json
import sys
from pathlib import Path

import matplotlib as mpl

mpl.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.layout_engine import ConstrainedLayoutEngine

COLOURS = {"healthy": "#2a9d5c", "watch": "#e9a23b", "fault": "#d1495b", "undiagnosable": "#8d99ae"}


def main() -> None:
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    motors = json.loads(Path(sys.argv[1]).read_text("utf-8"))["motors"]
    figure, (levels, loads) = plt.subplots(
        1,
        2,
        figsize=(10, 3.6),
        sharey=True,
        gridspec_kw={"width_ratios": (3, 2)},
        layout=ConstrainedLayoutEngine(wspace=0.05),
    )
    for row, motor in enumerate(reversed(motors)):
        for diagnosis in motor["diagnoses"]:
            colour = COLOURS[diagnosis["verdict"]]
            low, high = diagnosis["mu_f_ci95"]
            levels.plot([100 * low, 100 * high], [row, row], color=colour, linewidth=2)
            levels.plot(100 * diagnosis["mu_f"], row, "o", color=colour)
            loads.plot(100 * diagnosis["load_level"], row, "o", color=colour)
        levels.plot(100 * motor["truth"]["mu_f"], row, "|", color="black", markersize=18)
        loads.plot(100 * motor["truth"]["load_level"], row, "|", color="black", markersize=18)
        phase = diagnosis["phase"]
        text = diagnosis["verdict"] + (f", phase {phase}" if phase else "")
        levels.annotate(text, (1.02, row), xycoords=levels.get_yaxis_transform(), va="center", color=colour)
    levels.set_ylim(-0.6, len(motors) - 0.4)
    levels.axvline(0.5, color="#8d99ae", linestyle="--", linewidth=1)
    levels.set(xlim=(-0.5, None), xlabel="shorted turns, % of the phase (bar: truth; dashed: limit)")
    levels.set_yticks(range(len(motors)), [f"{m['motor']}\n{m['site']}" for m in reversed(motors)])
    loads.set(xlim=(0, 100), xlabel="load, % of rated torque (bar: truth)")
    figure.savefig(sys.argv[2], dpi=110)


if __name__ == "__main__":
    main()
