from pathlib import Path

from service.process.disk_space import disk_problem
from testing.no_room import no_room


def test_a_full_disk_is_named(tmp_path: Path) -> None:
    full = tmp_path / "full"
    full.mkdir()
    with no_room():
        problem = disk_problem([full])
    assert problem is not None
    assert str(full) in problem
    assert disk_problem([full]) is None
    assert list(full.iterdir()) == []


def test_a_directory_that_is_not_there_is_named(tmp_path: Path) -> None:
    assert disk_problem([tmp_path, tmp_path / "gone"]) == f"{tmp_path / 'gone'}: No such file or directory"
