"""Equations of shorted turns inside one coil against all coils: python -m benchmarks.winding [--quick]."""

from pathlib import Path

from benchmarks.page_of_subjects import PageOfSubjects
from benchmarks.winding import over_time, records, table

PAGE = Path("docs/evidence/winding.md")
PREAMBLE = """\
# Shorted turns inside one coil

Turns that are shorted inside one coil share its slots: their leakage links the rest of the coil, and their
axis is the coil's. Asked: do the equations of this (`core/machines/coil_fault.py`) hold, and what do one
record and records over time tell? All figures are simulated.

**Method.** The equations are compared with a circuit for every coil (`ied_sim/motor/coils.py`, solved at
one slip by `testing/machines/slot_faults.py`), which shares nothing with them: winding functions slot by
slot, fields of 1 to 50 times the pole pairs, leakage by slot, layer and coil end. Motors of 0.8, 7.5 and
160 kW at 0.6 load, every coil of a group, 1 to 100 % of its turns, paths of 0 to 8 times the turns'
resistance.

**Columns.** N: coils of a phase. `c`: `kappa / (N mu)`, one for all paths. Misfits: of the changes of I1
and I2, with the axis of the winding, and with turns on the phase's axis. Best delta: the axis that fits
best.

**Found.** One kappa serves all paths: the terminals cannot tell path and leakage apart. It is near N mu
with a cage, larger with slip rings. The axis is the coil's within some 5 degrees. Shapes of slots matter
little.

| called `fault`, channels of 1 % and 25 us, winding not given | 1 % | 2 % | 3 % | 5 % | 8 % |
| --- | --- | --- | --- | --- | --- |
| 0.8 kW | 0 of 40 | 4 | 10 | 35 | 40 |
| 7.5 kW | 0 of 40 | 13 | 31 | 40 | 40 |
| 37 kW | 8 of 40 | 37 | 40 | 40 | 40 |
| 160 kW | 13 of 40 | 40 | 40 | 40 | 40 |
| 1,200 kW | 40 of 40 | 39 | 40 | 40 | 40 |

No phase is named wrongly, of 3,137. Of 2,400 records without shorted turns 14 are called, all with an unknown
asymmetry.

Followed over records of these circuits, 36 of 36 motors with 1 % are named, 32 with 98 % or more; with the
winding in the file all 60 axes that are told are right.

**Falls short.** The study that this follows called 37, 63 and 100 % of 3 % in motors of 0.8, 7.5 and 160 kW
with channels of 1 %; here 25, 78 and 100 %. Without unknown asymmetries as a cause, and with channels of
0.2 %, it called 78 and 82 % of 2 and 3 % at 0.8 kW, and 80 and 98 % at 7.5 kW; here 20 and 50 %, and 35 and
68 %. Intervals are a little wide: they hold 98.9 %. Levels at 1,200 kW are 13 to 46 % off in the median, for
its leakage decides what it draws. Joints are mostly healthy or not assessed with channels of 1 %.
"""
SUBJECTS = {
    "windings": table.windings,
    "shapes": table.shapes,
    "faults": records.faults,
    "sound": records.sound,
    "series": over_time.series,
}

if __name__ == "__main__":
    PageOfSubjects(PAGE, PREAMBLE, SUBJECTS).measure(__doc__)
