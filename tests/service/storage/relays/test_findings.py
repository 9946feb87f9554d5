"""What was found at many relays, written at once."""

import pytest

from service.storage import NotFoundError, Repository
from service.storage.records import RelayFindings
from testing.service.plants import NOW_NS

FIRST, SECOND = "A1_SEL710", "A2_SEL710"


def test_the_latest_findings_of_each_relay_stay(repository: Repository) -> None:
    repository.note_findings(RelayFindings(FIRST, NOW_NS, {"directory": "EVENTS"}, [{"name": "x"}]))
    latest = RelayFindings(FIRST, NOW_NS + 2, {"directory": "COMTRADE"}, [], [{"name": "y"}], 1)
    other = RelayFindings(SECOND, NOW_NS + 1, {"directory": None})
    repository.note_findings(RelayFindings(FIRST, NOW_NS + 1, {"directory": None}), other, latest)
    for expected in (latest, other):
        found = repository.relay_findings(expected.ied)
        assert found is not None
        assert (found.found_ns, found.acquisition, list(found.differences)) == (
            expected.found_ns,
            expected.acquisition,
            list(expected.differences),
        )
        assert (list(found.ignored_files), found.ignored_in_all) == (
            list(expected.ignored_files),
            expected.ignored_in_all,
        )


def test_an_unknown_relay_is_told_and_nothing_is_kept(repository: Repository) -> None:
    with pytest.raises(NotFoundError, match="A3_SEL710"):
        repository.note_findings(RelayFindings(FIRST, NOW_NS, {}), RelayFindings("A3_SEL710", NOW_NS, {}))
    assert repository.relay_findings(FIRST) is None
