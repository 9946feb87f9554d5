"""Draw a motor's condition over its records.

python examples/picture_of_a_condition.py FOLLOW.json PICTURE.png

FOLLOW.json is what `mcc follow RECORD... --motor MOTOR.toml --json` prints. Needs matplotlib (in the dev
extra).
"""

import json
import sys
from datetime import datetime, timedelta
from pathlib import Path

import matplotlib as mpl

mpl.use("Agg")
import matplotlib.pyplot as plt

COLOURS = {"healthy": "#2a9d5c", "watch": "#e9a23b", "fault": "#d1495b", "unknown": "#8d99ae"}
GREY = "#8d99ae"


def main() -> None:
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    condition = json.loads(Path(sys.argv[1]).read_text("utf-8"))
    latest = _time(condition["as_of"])

    def days(time: str) -> float:
        return (_time(time) - latest) / timedelta(days=1)

    figure, axes = plt.subplots(figsize=(10, 3.8), layout="constrained")
    for state, colour in COLOURS.items():
        shown = [one for one in condition["history"] if one["state"] == state]
        if shown:
            levels = [100 * one["mu_f"] for one in shown]
            axes.plot(
                [days(one["time"]) for one in shown], levels, "o", markersize=4, color=colour, label=state
            )
    forecast = condition["forecast"]
    limit = 100 * forecast["limit"]
    axes.axhline(limit, color=GREY, linestyle="--", linewidth=1)
    if forecast["days"] is not None:
        low, mid, high = forecast["days"]
        axes.plot([0.0, mid], [100 * condition["mu_f"], limit], ":", color=COLOURS["fault"])
        axes.plot([low, high], [limit, limit], color=COLOURS["fault"], linewidth=3)
    if condition["since"] is not None:
        axes.axvline(days(condition["since"]), color=GREY, linewidth=1)
        axes.annotate(" since", (days(condition["since"]), 0.9 * limit), color=GREY)
    kind = " or ".join(condition["candidates"]) or condition["kind"]
    phase = f", phase {condition['phase']}" if condition["phase"] else ""
    axes.set_title(f"{condition['motor']}: {condition['state']}, {kind}{phase}", loc="left")
    axes.set(xlabel="days from the latest record", ylabel="shorted turns, % of the phase")
    axes.legend(loc="lower right", title="dashed: limit; bar: 80 % forecast")
    figure.savefig(sys.argv[2], dpi=110)


def _time(text: str) -> datetime:
    return datetime.fromisoformat(text[: len("2026-01-31T12:00:00")])


if __name__ == "__main__":
    main()
