"""Names of downloads: every system takes them, whatever a motor is called."""

import re
from dataclasses import replace

import pytest

from service.api.recordings.archive import file_stem
from service.recording_store.store import RecordingStore
from service.storage import Repository
from testing.service.plants import NOW_NS


@pytest.mark.parametrize(
    ("motor", "name"),
    [
        ("P-101 A/B", "P-101_A_B_2025-10-09T08-53-20Z"),
        ('..\\x"\r\nSet-Cookie: a', "_x_Set-Cookie_a_2025-10-09T08-53-20Z"),
        ("Förderband 1", "F_rderband_1_2025-10-09T08-53-20Z"),
    ],
)
def test_only_safe_characters_stay(
    repository: Repository, store: RecordingStore, motor: str, name: str
) -> None:
    stored = store.store({"E.CFF": b"samples"})
    added = repository.add_recording(stored, motor="PUMP-A1", now_ns=NOW_NS).recording
    unread = replace(added, motor=motor)
    assert file_stem(unread) == name, "while nobody has read its time, that of its announcement"
    assert "2024-" in file_stem(replace(unread, recorded_ns=NOW_NS - 366 * 86_400 * 10**9))
    assert re.fullmatch(r"[A-Za-z0-9_.-]+", name)
