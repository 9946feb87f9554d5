import pytest


@pytest.fixture(autouse=True)
def _wide_tables(monkeypatch: pytest.MonkeyPatch) -> None:
    """Tables have room, so that what they say stands in one line; test_widths.py tries narrow ones."""
    monkeypatch.setenv("COLUMNS", "250")
