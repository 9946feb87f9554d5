"""Measured values in partitions, on a real PostgreSQL: made ahead, filled and dropped."""

from collections import Counter
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path

import pytest
from sqlalchemy import Engine, text

from core.units import NANOSECONDS_PER_DAY as DAY_NS
from service.background.housekeeping import Housekeeping
from service.configuration.settings import Settings
from service.storage import Repository, partitions
from service.storage.partitions import Period
from service.storage.records import Sample
from testing.service.plants import SECOND_NS
from testing.service.tables import differences

pytestmark = pytest.mark.parametrize("database_url", ["postgresql"], indirect=True)


def ns(year: int, month: int, day: int = 1, hour: int = 0) -> int:
    return int(datetime(year, month, day, hour, tzinfo=UTC).timestamp()) * SECOND_NS


NOON_NS = ns(2026, 3, 30, 12)


def sample(engine: Engine, repository: Repository, *times_ns: int, step_s: int = 0) -> None:
    """Have a value of each time; of a step other than samples, by the table itself."""
    repository.add_samples([Sample("PUMP-A1", time_ns, {"ia_A": 1.0}) for time_ns in times_ns])
    if step_s:
        with engine.begin() as connection:
            connection.execute(
                text("UPDATE measurements SET step_s = :step WHERE time_ns = ANY(:times) AND step_s = 0"),
                {"step": step_s, "times": list(times_ns)},
            )


def places(engine: Engine) -> Counter[str]:
    """How many values each partition has, of those that have any."""
    with engine.connect() as connection:
        query = text("SELECT CAST(tableoid::regclass AS text) FROM measurements")
        return Counter(connection.scalars(query).all())


def names(engine: Engine) -> set[str]:
    with engine.connect() as connection:
        return set(partitions.partitions(connection))


def times(repository: Repository, step_s: int = 0) -> Sequence[int]:
    return [one.time_ns for one in repository.measurements("PUMP-A1", step_s, limit=1000).items]


@pytest.mark.parametrize(
    ("step_s", "time_ns", "name", "begin_ns", "end_ns"),
    [
        (0, NOON_NS, "measurements_0_2026_03_30", ns(2026, 3, 30), ns(2026, 3, 31)),
        (60, NOON_NS, "measurements_60_2026_03", ns(2026, 3), ns(2026, 4)),
        (900, ns(2026, 12, 31, 23), "measurements_900_2026_12", ns(2026, 12), ns(2027, 1)),
        (900, ns(2024, 2, 29), "measurements_900_2024_02", ns(2024, 2), ns(2024, 3)),
        (60, ns(2026, 4) - 1, "measurements_60_2026_03", ns(2026, 3), ns(2026, 4)),
    ],
)
def test_a_period_is_a_day_of_samples_or_a_month_of_means(
    database_url: str, step_s: int, time_ns: int, name: str, begin_ns: int, end_ns: int
) -> None:
    period = Period.at(step_s, time_ns)
    assert period == Period(step_s, begin_ns, end_ns)
    assert period.name == name
    assert Period.named(name) == period
    assert Period.named("measurements_default") is None


def test_partitions_are_there_before_their_time(engine: Engine, repository: Repository) -> None:
    made = repository.make_measurement_partitions(now_ns=NOON_NS)
    assert set(made) == {
        *(f"measurements_0_2026_{day}" for day in ("03_30", "03_31", "04_01", "04_02")),
        *(f"measurements_{step_s}_2026_{month}" for step_s in (60, 900) for month in ("03", "04")),
    }
    assert repository.make_measurement_partitions(now_ns=NOON_NS) == ()
    assert set(made) <= names(engine)
    sample(engine, repository, NOON_NS, NOON_NS + DAY_NS)
    assert places(engine) == {"measurements_0_2026_03_30": 1, "measurements_0_2026_03_31": 1}
    with engine.connect() as connection:
        assert differences(connection) == []


def test_a_value_without_a_partition_is_kept_and_moves_into_its_own(
    engine: Engine, repository: Repository
) -> None:
    late_ns, far_ns = ns(2025, 7, 1, 3), ns(2031, 1, 1)
    sample(engine, repository, NOON_NS, far_ns)
    sample(engine, repository, late_ns, step_s=900)
    assert places(engine) == {"measurements_default": 3}
    repository.make_measurement_partitions(now_ns=NOON_NS)
    assert places(engine) == {
        "measurements_0_2026_03_30": 1,
        "measurements_0_2031_01_01": 1,
        "measurements_900_2025_07": 1,
    }
    sample(engine, repository, NOON_NS)
    assert times(repository) == [NOON_NS, far_ns], "a second one at the same time replaces the first"


def test_no_more_partitions_than_each_question_can_bear(
    engine: Engine, repository: Repository, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(partitions, "MOST_PARTITIONS", 6)
    days = [NOON_NS - number * DAY_NS for number in range(20)]
    sample(engine, repository, *days)
    made = repository.make_measurement_partitions(now_ns=NOON_NS)
    assert sum(name.startswith("measurements_0_") for name in made) == 6
    assert places(engine)["measurements_default"] == 17
    assert times(repository) == sorted(days)


def test_what_is_old_goes_as_a_whole(engine: Engine, repository: Repository) -> None:
    for step_s, each in ((900, (ns(2026, 1, 9), ns(2026, 2, 9), ns(2026, 3, 9))), (60, (ns(2026, 1, 8),))):
        sample(engine, repository, *each, step_s=step_s)
    repository.make_measurement_partitions(now_ns=NOON_NS)
    assert repository.drop_measurement_partitions(900, before_ns=ns(2026, 2, 28)) == (
        "measurements_900_2026_01",
    )
    assert times(repository, 900) == [ns(2026, 2, 9), ns(2026, 3, 9)], "of a month that is not all old"
    assert times(repository, 60) == [ns(2026, 1, 8)]
    assert "measurements_900_2026_01" not in names(engine)
    sample(engine, repository, ns(2026, 1, 10), step_s=900)
    assert times(repository, 900)[0] == ns(2026, 1, 10), "what comes late finds a place"
    assert repository.forget_measurements(900, 10, before_ns=ns(2026, 2, 28)).rows == 1


def test_housekeeping_keeps_whole_periods(engine: Engine, repository: Repository, tmp_path: Path) -> None:
    settings = Settings(data_directory=tmp_path, metering_sample_days=1, metering_minute_days=2)
    housekeeping = Housekeeping(settings, repository)
    housekeeping.average_and_delete(NOON_NS, 0)
    sample(engine, repository, NOON_NS)
    kept = []
    for days in (0.1, 1.4, 1.6, 3.4, 33.0):
        housekeeping.average_and_delete(NOON_NS + round(days * DAY_NS), round(days * DAY_NS))
        kept.append([len(times(repository, step_s)) for step_s in (0, 60, 900)])
    assert kept == [[1, 1, 1], [1, 1, 1], [0, 1, 1], [0, 1, 1], [0, 0, 1]]
    assert places(engine) == {"measurements_900_2026_03": 1}


def test_a_long_reader_delays_nobody_else(engine: Engine, repository: Repository) -> None:
    """Dropping waits for who reads, and others for who drops: so it gives up soon."""
    sample(engine, repository, ns(2026, 1, 9), step_s=900)
    repository.make_measurement_partitions(now_ns=NOON_NS)
    with engine.connect() as reader:
        reader.execute(text("SELECT count(*) FROM measurements"))
        assert repository.drop_measurement_partitions(900, before_ns=NOON_NS) == ()
        sample(engine, repository, NOON_NS)
    assert repository.drop_measurement_partitions(900, before_ns=ns(2026, 2)) == ("measurements_900_2026_01",)


def test_an_empty_database_has_the_default_partition_alone(engine: Engine) -> None:
    assert names(engine) == {"measurements_default"}
