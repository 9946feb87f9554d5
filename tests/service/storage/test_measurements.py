"""Measured values: kept as sampled for a while, averaged, and forgotten."""

import random
from statistics import fmean

import pytest

from core.units import NANOSECONDS_PER_DAY
from service.plant import MeteredQuantity
from service.storage import NotFoundError, Repository
from service.storage.models import MeasurementRow
from service.storage.records import Measurement, Sample
from testing.service.plants import SECOND_NS

QUARTER_NS = 900 * SECOND_NS
BEGIN_NS = 1_760_000_000 * SECOND_NS // QUARTER_NS * QUARTER_NS
DAY_NS = NANOSECONDS_PER_DAY


def measured(repository: Repository, step_s: int, motor: str = "PUMP-A1") -> list[Measurement]:
    return list(repository.measurements(motor, step_s, limit=1000).items)


def test_every_quantity_has_its_column() -> None:
    others = ["motor", "step_s", "time_ns", "samples", "source"]
    assert MeasurementRow.__table__.columns.keys() == [*others, *MeteredQuantity]


def test_means_are_those_of_the_samples(repository: Repository) -> None:
    """Against Python's own mean of every sample, though the longer means are made of the shorter ones."""
    chance = random.Random(4)
    samples = []
    for motor in ("PUMP-A1", "FAN-A2"):
        at_ns = BEGIN_NS
        while at_ns < BEGIN_NS + 2 * QUARTER_NS:
            values = {"ia_A": chance.uniform(5, 9), "frequency_Hz": chance.gauss(50, 0.1)}
            if chance.random() < 0.2:
                del values["frequency_Hz"]
            samples.append(Sample(motor, at_ns, values))
            at_ns += round(chance.uniform(5, 20) * SECOND_NS)
    for first in range(0, len(samples), 50):
        repository.add_samples(samples[first : first + 50])
    for later_s in (400, 700, 1500, 2100):  # the means are made bit by bit, as in service
        repository.average_measurements(now_ns=BEGIN_NS + later_s * SECOND_NS)
    quarters = measured(repository, 900)
    assert [quarter.time_ns for quarter in quarters] == [BEGIN_NS, BEGIN_NS + QUARTER_NS]
    for quarter in quarters:
        own = [
            sample
            for sample in samples
            if sample.motor == "PUMP-A1" and 0 <= sample.time_ns - quarter.time_ns < QUARTER_NS
        ]
        assert quarter.samples == len(own)
        assert quarter.values["ia_A"] == pytest.approx(fmean(sample.values["ia_A"] for sample in own))
        assert quarter.values["frequency_Hz"] == pytest.approx(50, abs=0.05)
        assert quarter.values["vab_V"] is None
    minutes = measured(repository, 60)
    assert len(minutes) == 30
    of_first = [s for s in samples if s.motor == "PUMP-A1" and s.time_ns < BEGIN_NS + 60 * SECOND_NS]
    known = [s.values["frequency_Hz"] for s in of_first if "frequency_Hz" in s.values]
    assert minutes[0].values["frequency_Hz"] == pytest.approx(fmean(known))
    assert sum(minute.samples for minute in minutes) == sum(s.motor == "PUMP-A1" for s in samples)


def test_of_the_relay_s_own_extremes_the_extremes_are_kept(repository: Repository) -> None:
    for second, value in enumerate((3.0, 7.0, 5.0)):
        values = {"maximum_ia_A": value, "minimum_ia_A": value, "average_current_A": value}
        repository.add_samples([Sample("PUMP-A1", BEGIN_NS + second * SECOND_NS, values)])
    repository.average_measurements(now_ns=BEGIN_NS + 1200 * SECOND_NS)
    for step_s in (60, 900):
        (kept,) = measured(repository, step_s)
        assert (
            kept.values["maximum_ia_A"],
            kept.values["minimum_ia_A"],
            kept.values["average_current_A"],
        ) == (7.0, 3.0, 5.0)


def test_an_interval_that_is_not_over_has_no_mean(repository: Repository) -> None:
    repository.add_samples([Sample("PUMP-A1", BEGIN_NS, {"ia_A": 1.0})])
    repository.average_measurements(now_ns=BEGIN_NS + 179 * SECOND_NS)
    assert measured(repository, 60) == []
    repository.add_samples([Sample("PUMP-A1", BEGIN_NS + 59 * SECOND_NS, {"ia_A": 3.0})])
    for _ in range(2):
        repository.average_measurements(now_ns=BEGIN_NS + 180 * SECOND_NS)
    assert [(minute.values["ia_A"], minute.samples) for minute in measured(repository, 60)] == [(2.0, 2)]


def test_means_of_a_clock_that_was_ahead_hold_up_no_others(repository: Repository) -> None:
    tomorrow_ns = BEGIN_NS + DAY_NS
    repository.add_samples([Sample("PUMP-A1", tomorrow_ns, {"ia_A": 9.0})])
    repository.average_measurements(now_ns=tomorrow_ns + 2 * QUARTER_NS)
    for at_s in range(0, 1800, 60):  # the clock is right again
        repository.add_samples([Sample("PUMP-A1", BEGIN_NS + at_s * SECOND_NS, {"ia_A": 1.0})])
        repository.average_measurements(now_ns=BEGIN_NS + at_s * SECOND_NS)
    repository.average_measurements(now_ns=BEGIN_NS + 3600 * SECOND_NS)
    quarters = [(BEGIN_NS, 15), (BEGIN_NS + QUARTER_NS, 15), (tomorrow_ns, 1)]
    assert [(each.time_ns, each.samples) for each in measured(repository, 900)] == quarters
    minutes = [each.time_ns for each in measured(repository, 60)]
    assert minutes == [*range(BEGIN_NS, BEGIN_NS + 2 * QUARTER_NS, 60 * SECOND_NS), tomorrow_ns]
    for at_s in range(-300, 1800, 60):  # its time comes
        repository.add_samples([Sample("PUMP-A1", tomorrow_ns + at_s * SECOND_NS + 1, {"ia_A": 1.0})])
        repository.average_measurements(now_ns=tomorrow_ns + at_s * SECOND_NS)
    times = [each.time_ns for each in measured(repository, 60)]
    assert times == sorted(set(times)), "none is doubled"
    assert tomorrow_ns - 60 * SECOND_NS in times
    assert tomorrow_ns + 60 * SECOND_NS in times


def test_the_same_sample_twice_is_one(repository: Repository) -> None:
    for _ in range(2):
        repository.add_samples([Sample("PUMP-A1", BEGIN_NS, {"ia_A": 1.0})])
    assert len(measured(repository, 0)) == 1
    assert measured(repository, 0, "FAN-A2") == []
    with pytest.raises(NotFoundError):
        measured(repository, 0, "NOPE")


def test_forgetting_ends_with_a_batch(repository: Repository) -> None:
    for number in range(10):
        for motor in ("PUMP-A1", "FAN-A2"):
            repository.add_samples([Sample(motor, BEGIN_NS + number * SECOND_NS, {"ia_A": 1.0})])
    before_ns = BEGIN_NS + 8 * SECOND_NS
    numbers = [repository.forget_measurements(0, 5, before_ns=before_ns).rows for _ in range(4)]
    assert numbers == [6, 6, 4, 0], "those of one time go together"
    assert [each.time_ns for each in measured(repository, 0)] == [before_ns, before_ns + SECOND_NS]
    assert repository.forget_measurements(60, 5, before_ns=before_ns).rows == 0
