"""Estimate a motor's parameters from recordings of its starts, and draw the first beside the model.

python examples/commission_motor.py MOTOR.toml PICTURE.png RECORD.CFG...      (needs matplotlib)
"""

import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from core.commissioning.commissioning import commission
from core.commissioning.start_detection import start_of
from core.machines.candidates import LoadLaw
from core.machines.motor_file.reader import read_plate
from core.machines.playback import electrical_to_rpm
from core.machines.starting import start_candidate
from core.recordings import read


def main() -> None:
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    plate = read_plate(sys.argv[1])
    recordings = [read(Path(name)) for name in sys.argv[3:]]
    found = commission(recordings, plate)
    for name, one in found.parameters.items():
        interval = "fixed" if one.ci95 is None else f"95 %: {one.ci95[0]:.5g} to {one.ci95[1]:.5g}"
        print(f"{name:26} {one.value:.5g}  ({interval})")
    print(*found.warnings, *found.reasons, sep="\n")

    first = found.starts[0]
    start = start_of(recordings[0], plate.nameplate, plate.channels)
    machine = start_candidate(found.machine, first.load_level.value, first.time_offset_s.value)
    model = start.playback(LoadLaw[found.load_law.upper()]).trajectories(machine)
    seconds = start.compared_s[0] + np.arange(model.speed.shape[1]) / start.sample_rate_hz

    figure = Figure(figsize=(9, 5), layout="constrained")
    current, speed = figure.subplots(2, 1, sharex=True)
    current.plot(seconds, start.measured_ab[0], color="0.7", linewidth=2.0, label="measured")
    current.plot(seconds, model.current[0, 0], linewidth=0.8, label="modelled")
    current.set_ylabel("winding current, alpha axis, A")
    current.legend()
    speed.plot(seconds, electrical_to_rpm(model.speed[0], plate.nameplate.pole_pairs))
    speed.set_ylabel("modelled speed, rpm")
    speed.set_xlabel("time after switching on, s")
    figure.savefig(sys.argv[2], dpi=100)


if __name__ == "__main__":
    main()
