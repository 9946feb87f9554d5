"""Tell why a motor's start has become another: python examples/why_starts_changed.py.

The starts are simulated here. With recordings of your own, `core.recordings.read(path)` gives each of them.
"""

from dataclasses import replace
from pathlib import Path

from core.machines.motor_file.reader import read_motor
from core.starts.changes import compare_starts
from core.starts.examining import examine_start
from testing.machines.starts import StartRecord

motor = read_motor(Path(__file__).with_name("motor.toml"))
usual = StartRecord(load_level=0.4, duration_s=1.5, snr_db=45.0)
first_ones = [examine_start(replace(usual, seed=k).of(motor), motor) for k in range(3)]

for name, record in (
    ("as before", replace(usual, seed=9)),
    ("a weak supply", replace(usual, voltage=0.9)),
    ("a sticking load", replace(usual, load_level=0.7)),
):
    start = examine_start(record.of(motor), motor)
    changes = compare_starts([start], first_ones)
    print(f"{name}: {changes.state}, {', '.join(changes.causes) or 'no cause'}")
    for reason in changes.reasons:
        print(f"  {reason}")
