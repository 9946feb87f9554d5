"""An installation has one name, and needs to write it once."""

from pathlib import Path

import pytest

from service.process.installation import installation_id


def test_the_name_stays(tmp_path: Path) -> None:
    assert installation_id(tmp_path) == installation_id(tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["installation"]


def test_a_full_disk_matters_the_first_time_only(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_arguments: object, **_options: object) -> int:
        raise OSError(28, "No space left on device")

    named, unnamed = tmp_path / "named", tmp_path / "unnamed"
    named.mkdir()
    unnamed.mkdir()
    name = installation_id(named)
    monkeypatch.setattr(Path, "write_text", full)
    assert installation_id(named) == name
    with pytest.raises(OSError, match="No space left"):
        installation_id(unnamed)
    assert not list(unnamed.iterdir())
