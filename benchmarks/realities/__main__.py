"""What plants do to records, healthy and faulty: python -m benchmarks.realities [--quick]."""

from pathlib import Path

from benchmarks.page_of_subjects import PageOfSubjects
from benchmarks.realities import single_records

PAGE = Path("docs/evidence/realities.md")
PREAMBLE = """# What plants do to records

A relay measures a feeder, and plants do more to it than a model of a motor knows. Each reality below is
simulated (`benchmarks/realities/cases.py`, with the simulator's [feeder]) and judged as single records:
healthy motors, and motors with 5 % of a phase's turns shorted inside one coil. [What behind the relay
looks like a fault](../explanation/behind-the-relay.md) explains them to engineers.

**Records.** Motors of 0.8, 7.5, 37 and 160 kW with four poles, in star and delta, at loads of 0.2 to 1;
parameters of the file off by up to 10 %, channels by up to 1 % and 25 us, noise, harmonics, V2/V1 up to 2
%, paths of up to twice the resistance of the turns, 0.5 s at 4 kHz. There are 12 healthy and 12 faulty
records a row, so a share is known within some 25 %. "Before" is the same records, judged by the project
before it knew of these realities.

The figures were measured with a standard deviation of the iron's curve of 60 % of the deviation of the flux;
it is 100 % since, so that motors whose iron hardly saturates stay healthy, too.

**Columns.** Called: `fault`. Level held: of those called, the 95 % interval holds the equivalent level.
Named: the reasons or the quality findings name the reality. Rows without a name are to be judged as any
record.

**Findings.** No healthy record is called, but where a row says so. With the capacitors, the cable, the
neutral or the place of the transformers in the motor's file, records are judged as well as without them.
Dips, blown fuses and stops in the last cycle no longer cost the record, and a fuse that blows is no
longer taken for steady running.

**Falls short.** A capacitor that lost a branch beside shorted turns is two causes, and one record is
weighed for one: levels are off, and in a large motor the phase was wrong. Capacitors that the file does
not have hide shorted turns in a third to a half of the records: the file should have them. Two-phase
loads are seldom named, for they count as rarer than other causes; those of 6 and 12 % of the rated
current are mostly within what channels of 1 % can look like, and are not named. Transformers inside the
delta can look like a healthy motor at another load. A motor with shorted turns that stays in star is
often taken for one with capacitors. A motor that generates is named and not diagnosed.

Each command writes its part of this page; with `--quick` it prints few cases instead.

[feeder]: ../reference/scenario.md#what-lies-behind-the-relay-besides-the-motor
[What behind the relay looks like a fault]: ../explanation/behind-the-relay.md
"""
SUBJECTS = {"steady": single_records.steady, "events": single_records.events}

if __name__ == "__main__":
    PageOfSubjects(PAGE, PREAMBLE, SUBJECTS).measure(__doc__)
