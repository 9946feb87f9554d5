"""Diagnose one COMTRADE recording: python examples/diagnose_recording.py RECORD.CFG MOTOR.toml"""

import sys
from pathlib import Path

from core.diagnosis.stator import diagnose
from core.machines.motor_file.reader import read_motor
from core.recordings import read


def main() -> None:
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    recording = read(Path(sys.argv[1]))
    result = diagnose(recording, read_motor(sys.argv[2]))
    print(f"{result.verdict}: " + "; ".join(result.reasons))
    if result.mu_f is not None and result.mu_f_ci95 is not None:
        low, high = result.mu_f_ci95
        print(
            f"mu_f = {result.mu_f:.2%} (95 % interval {low:.2%} to {high:.2%}, "
            f"detection limit {result.detection_limit:.2%}), load {result.load_level:.0%}"
        )


if __name__ == "__main__":
    main()
