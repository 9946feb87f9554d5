"""What a relay metered of a motor for a day: it runs, stands for six hours, and is silent for three."""

import time
from math import sqrt

from core.units import NANOSECONDS_PER_SECOND
from service.condition.motor_data import document_of
from service.storage import Repository
from service.storage.records import Sample
from testing.service.plants import motor

QUARTER_NS = 900 * NANOSECONDS_PER_SECOND
QUARTERS = 96
STANDING, SILENT = range(24, 48), range(48, 60)
LOW, UNEVEN, SLOW = range(4), range(92, 96), range(88, 92)
MINUTE_NS = 60 * NANOSECONDS_PER_SECOND
LATE_NS = 120 * NANOSECONDS_PER_SECOND
"""Means are made two minutes after their time."""
POWER_W = 640.0


def meter_a_day(repository: Repository, name: str = "PUMP-A1", *, disturbed: bool = False) -> None:
    """Add what was metered each minute of a day, and of the quarter of an hour that is not over.

    disturbed: with an hour of low frequency, and one of uneven currents.
    """
    known = motor(name)
    repository.note_motors({name: document_of(known)}, now_ns=1)
    rated_V = known.nameplate.rated_voltage_V
    running_A = POWER_W / (sqrt(3.0) * rated_V * 0.75)
    now_ns = time.time_ns()
    ended_ns = now_ns - LATE_NS
    first_ns = ended_ns // QUARTER_NS * QUARTER_NS - QUARTERS * QUARTER_NS
    samples = []
    for at_ns in range(first_ns, ended_ns // MINUTE_NS * MINUTE_NS, MINUTE_NS):
        quarter = (at_ns - first_ns) // QUARTER_NS
        if quarter in SILENT:
            continue
        stands = quarter in STANDING
        values = dict.fromkeys(("ia_A", "ib_A", "ic_A"), 0.0 if stands else running_A)
        values["ia_A"] *= 1.3 if disturbed and quarter in UNEVEN else 1.0
        volts = 0.88 * rated_V if quarter in LOW else rated_V
        values |= {"vab_V": volts, "vbc_V": volts, "vca_V": 0.97 * volts if quarter in UNEVEN else volts}
        values |= {
            "power_W": 0.0 if stands else POWER_W,
            "frequency_Hz": 48.0 if disturbed and quarter in SLOW else 50.0,
        }
        samples.append(Sample(name, at_ns, values))
    repository.add_samples(samples)
    repository.average_measurements(now_ns=now_ns)
