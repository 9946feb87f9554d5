"""Measured values are averaged and deleted by a clock that can be trusted, and by no other."""

from pathlib import Path

from core.units import NANOSECONDS_PER_DAY as DAY_NS
from service.background.housekeeping import Housekeeping
from service.configuration.settings import Settings
from service.storage import Repository
from service.storage.records import Measurement, Sample
from testing.service.plants import SECOND_NS
from tests.service.fixtures import database_url, engine, repository

__all__ = ["database_url", "engine", "repository"]

QUARTER_NS = 900 * SECOND_NS
BEGIN_NS = 1_760_000_000 * SECOND_NS // QUARTER_NS * QUARTER_NS


def measured(repository: Repository, step_s: int) -> list[Measurement]:
    return list(repository.measurements("PUMP-A1", step_s, limit=1000).items)


def test_old_values_are_deleted_and_their_means_kept(repository: Repository, tmp_path: Path) -> None:
    settings = Settings(data_directory=tmp_path, metering_sample_days=1, metering_minute_days=2)
    housekeeping = Housekeeping(settings, repository)
    repository.add_samples([Sample("PUMP-A1", BEGIN_NS, {"ia_A": 1.0})])
    counts = []
    for days in (0.5, 1.5, 2.5):
        housekeeping.average_and_delete(BEGIN_NS + round(days * DAY_NS), round(days * DAY_NS))
        counts.append([len(measured(repository, step_s)) for step_s in (0, 60, 900)])
    assert counts == [[1, 1, 1], [0, 1, 1], [0, 0, 1]]
    housekeeping.average_and_delete(BEGIN_NS + 100 * DAY_NS, 3 * DAY_NS)
    assert [len(measured(repository, step_s)) for step_s in (0, 60, 900)] == [0, 0, 1], "the clock was set"


def test_a_clock_that_is_ahead_for_a_while_deletes_nothing(repository: Repository, tmp_path: Path) -> None:
    """Begun with the clock ahead, or set ahead in service."""
    settings = Settings(data_directory=tmp_path, metering_sample_days=1, metering_minute_days=2)
    repository.add_samples([Sample("PUMP-A1", BEGIN_NS, {"ia_A": 1.0})])
    housekeeping = Housekeeping(settings, repository)
    monotonic_s = 50
    for ahead_s, seconds in ((3 * 86_400, 600), (0, 30), (5 * 86_400, 600), (-86_400, 600), (0, 120)):
        for _ in range(0, seconds, 30):
            monotonic_s += 30
            at_ns = BEGIN_NS + (monotonic_s + ahead_s) * SECOND_NS
            housekeeping.average_and_delete(at_ns, monotonic_s * SECOND_NS)
        assert len(measured(repository, 0)) == 1
    repository.add_samples([Sample("PUMP-A1", BEGIN_NS + 899 * SECOND_NS, {"ia_A": 3.0})])
    monotonic_s += 3600
    housekeeping.average_and_delete(BEGIN_NS + monotonic_s * SECOND_NS, monotonic_s * SECOND_NS)
    assert len(measured(repository, 0)) == 2
    monotonic_s += 86_400
    housekeeping.average_and_delete(BEGIN_NS + monotonic_s * SECOND_NS, monotonic_s * SECOND_NS)
    assert measured(repository, 0) == []


def test_a_clock_that_is_set_ahead_cuts_no_interval_short(repository: Repository, tmp_path: Path) -> None:
    housekeeping = Housekeeping(Settings(data_directory=tmp_path), repository)
    repository.add_samples([Sample("PUMP-A1", BEGIN_NS, {"ia_A": 1.0})])
    for at_s, ahead_s in ((10, 0), (70, 86_400), (130, 86_400), (190, 0)):
        housekeeping.average_and_delete(BEGIN_NS + (at_s + ahead_s) * SECOND_NS, at_s * SECOND_NS)
    repository.add_samples([Sample("PUMP-A1", BEGIN_NS + 600 * SECOND_NS, {"ia_A": 3.0})])
    for at_s in (3700, 3800):
        housekeeping.average_and_delete(BEGIN_NS + at_s * SECOND_NS, at_s * SECOND_NS)
    assert [(quarter.values["ia_A"], quarter.samples) for quarter in measured(repository, 900)] == [(2.0, 2)]
