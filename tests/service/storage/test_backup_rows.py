"""Back-ups as the database remembers them."""

from core.units import NANOSECONDS_PER_DAY as DAY_NS
from service.storage import Repository
from service.storage.states import BackupState
from testing.service.plants import NOW_NS, SECOND_NS


def test_the_latest_verified_back_up_is_known(repository: Repository) -> None:
    assert repository.latest_verified_backup() is None
    for number in range(3):
        begun = repository.begin_backup("/backup", now_ns=NOW_NS + number * SECOND_NS)
        assert begun is not None
        if number < 2:
            repository.finish_backup(
                begun.id,
                name=f"backup-{number}",
                recordings=3,
                files=6,
                size_bytes=600,
                now_ns=NOW_NS + (number + 10) * SECOND_NS,
            )
        else:
            repository.fail_backup(begun.id, "the disk is full", now_ns=NOW_NS + 20 * SECOND_NS)
    latest = repository.latest_verified_backup()
    assert latest is not None
    assert (latest.name, latest.ended_ns, latest.files) == ("backup-1", NOW_NS + 11 * SECOND_NS, 6)
    listed = repository.backups(limit=2)
    assert [(one.state, one.problem) for one in listed.items] == [
        (BackupState.FAILED, "the disk is full"),
        (BackupState.VERIFIED, None),
    ]
    assert [one.name for one in repository.backups(limit=2, after=listed.next).items] == ["backup-0"]


def test_of_several_services_one_makes_the_back_up_that_is_due(repository: Repository) -> None:
    due_ns = NOW_NS
    assert repository.is_backup_due(due_ns, now_ns=NOW_NS)
    begun = repository.begin_backup("/backup", now_ns=NOW_NS, due_ns=due_ns)
    assert begun is not None
    assert not repository.is_backup_due(due_ns, now_ns=NOW_NS + 1)
    assert repository.begin_backup("/backup", now_ns=NOW_NS + 1, due_ns=due_ns) is None
    repository.finish_backup(begun.id, name="a", recordings=0, files=1, size_bytes=1, now_ns=NOW_NS + 1)
    assert repository.begin_backup("/backup", now_ns=NOW_NS + DAY_NS, due_ns=due_ns) is None
    assert repository.begin_backup("/backup", now_ns=NOW_NS + 2, due_ns=due_ns + SECOND_NS) is not None


def test_a_back_up_that_failed_is_tried_again_after_an_hour(repository: Repository) -> None:
    begun = repository.begin_backup("/backup", now_ns=NOW_NS, due_ns=NOW_NS)
    assert begun is not None
    repository.fail_backup(begun.id, "the disk is full", now_ns=NOW_NS + SECOND_NS)
    assert not repository.is_backup_due(NOW_NS, now_ns=NOW_NS + 3599 * SECOND_NS)
    later_ns = NOW_NS + 3600 * SECOND_NS
    assert repository.is_backup_due(NOW_NS, now_ns=later_ns)
    assert repository.begin_backup("/backup", now_ns=later_ns, due_ns=NOW_NS) is not None
    assert not repository.is_backup_due(NOW_NS, now_ns=later_ns + SECOND_NS)


def test_a_back_up_that_was_interrupted_has_failed_when_the_next_begins(repository: Repository) -> None:
    """Also in a database that was restored: it was copied while its own back-up was under way."""
    repository.begin_backup("/backup", now_ns=NOW_NS)
    repository.begin_backup("/elsewhere", now_ns=NOW_NS + 1)
    repository.begin_backup("/backup", now_ns=NOW_NS + 2)
    states = [one.state for one in repository.backups(limit=3).items]
    assert states == [BackupState.RUNNING, BackupState.RUNNING, BackupState.FAILED]
