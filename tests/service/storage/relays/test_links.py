"""What a gateway notes of many links at once."""

import pytest

from service.storage import NotFoundError, Repository
from service.storage.records import LinkNote, LinkTraffic
from service.storage.repository.relays.leases import GATEWAY_GONE
from service.storage.states import LinkState
from testing.service.plants import NOW_NS, SECOND_NS

FIRST, SECOND = "A1_SEL710", "A2_SEL710"


def note(relay: str, second: int, state: LinkState | None, reason: str | None = None) -> LinkNote:
    return LinkNote(
        relay,
        NOW_NS + second * SECOND_NS,
        LinkTraffic(connections=1),
        None,
        day=7,
        day_bytes=100,
        state=state,
        reason=reason,
    )


def reasons(repository: Repository, relay: str) -> list[str | None]:
    return [change.reason for change in repository.link_changes(relay, limit=100).items]


def test_many_links_change_at_once_each_in_its_order(repository: Repository) -> None:
    repository.note_links(
        [
            note(FIRST, 1, LinkState.UP),
            note(SECOND, 1, LinkState.DOWN, "cut"),
            note(FIRST, 2, LinkState.DOWN, "refused"),
            note(SECOND, 2, LinkState.DOWN, "cut"),
        ]
    )
    assert [repository.relay(name).link_reason for name in (FIRST, SECOND)] == ["refused", "cut"]
    assert reasons(repository, FIRST) == ["refused", None]
    assert reasons(repository, SECOND) == ["cut"], "what stays as it was is no change"
    assert [repository.link_figures(name).connections for name in (FIRST, SECOND)] == [2, 2]


def test_a_state_that_waited_changes_none_once_its_gateway_was_found_dead(repository: Repository) -> None:
    for gateway in ("hung", "next"):
        repository.register_gateway(gateway, host="h", process_id=1, now_ns=NOW_NS)
    assert repository.share_relays("hung", [FIRST], most=10, problem=None).held == {FIRST}
    repository.note_links([note(FIRST, 1, LinkState.UP)], gateway="hung")
    assert repository.end_gateway("hung", now_ns=NOW_NS + 5 * SECOND_NS)
    repository.note_links([note(FIRST, 6, LinkState.DOWN, "cut")], gateway="hung")
    assert repository.relay(FIRST).link_reason == GATEWAY_GONE
    assert repository.link_figures(FIRST).connections == 2, "what went over the link counts"
    assert repository.share_relays("next", [FIRST], most=10, problem=None).held == {FIRST}
    repository.note_links([note(FIRST, 7, LinkState.UP)], gateway="next")
    repository.note_links([note(FIRST, 8, LinkState.DOWN, "cut")], gateway="hung")
    assert repository.relay(FIRST).link_state is LinkState.UP


def test_a_clock_that_was_ahead_keeps_no_link_unknown(repository: Repository) -> None:
    """The gateway before ended while the clock was an hour ahead."""
    for gateway in ("before", "after"):
        repository.register_gateway(gateway, host="h", process_id=1, now_ns=NOW_NS)
        repository.share_relays(gateway, [FIRST], most=10, problem=None)
        repository.note_links([note(FIRST, 1, LinkState.UP)], gateway=gateway)
        assert repository.relay(FIRST).link_state is LinkState.UP
        repository.end_gateway(gateway, now_ns=NOW_NS + 3600 * SECOND_NS)
        assert repository.relay(FIRST).link_state is LinkState.UNKNOWN


def test_an_unknown_relay_is_told_where_a_note_has_a_state_and_nothing_is_kept(
    repository: Repository,
) -> None:
    with pytest.raises(NotFoundError, match="A3_SEL710"):
        repository.note_links([note(FIRST, 1, LinkState.UP), note("A3_SEL710", 1, LinkState.UP)])
    assert repository.relay(FIRST).link_state is LinkState.UNKNOWN
    repository.note_links([note(FIRST, 1, LinkState.UP), note("A3_SEL710", 1, None)])
    assert repository.relay(FIRST).link_state is LinkState.UP


def test_the_oldest_changes_of_each_link_are_dropped(
    repository: Repository, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("service.storage.repository.relays.links.MOST_CHANGES", 3)
    for second in range(1, 6):
        repository.note_links(
            [note(name, second, LinkState.DOWN, f"{name} {second}") for name in (FIRST, SECOND)]
        )
    for name in (FIRST, SECOND):
        assert reasons(repository, name) == [f"{name} {second}" for second in (5, 4, 3)]
