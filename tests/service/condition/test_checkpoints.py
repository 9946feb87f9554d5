"""States are kept spaced geometrically."""

from service.condition.checkpoints import is_kept


def kept(records: int) -> list[int]:
    return [at for at in range(1, records + 1) if is_kept(at, records)]


def test_no_state_is_needed_that_was_not_kept_before() -> None:
    held = [1]
    for records in range(2, 3000):
        held = [at for at in [*held, records] if is_kept(at, records)]
        assert held == kept(records)


def test_a_late_record_makes_at_most_sixteen_times_as_many_be_folded() -> None:
    for records in (700, 1024, 4097, 20_000):
        held = kept(records)
        for late in range(1, records // 2):
            before = max((at for at in held if at <= records - late), default=0)
            assert records - before <= 16 * late


def test_ten_years_of_hourly_records_keep_about_ten_states() -> None:
    assert max(len(kept(records)) for records in range(87_600, 87_700, 7)) <= 12
