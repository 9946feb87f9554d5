from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from service.audit.entries import NO_HASH, Anchor, AuditEntry, digest, sealed
from service.audit.verification import Fault, Verification, verify

TIME_NS = 1_700_000_000_123_456_789


def chain(length: int) -> list[AuditEntry]:
    entries: list[AuditEntry] = []
    previous = NO_HASH
    for number in range(1, length + 1):
        entry = AuditEntry(
            number=number,
            time_ns=TIME_NS + number,
            actor="anna",
            origin="10.0.0.7",
            roles="ENGINEER OPERATOR",
            action="note-added",
            subject_kind="motor",
            subject=f"PUMP-{number}",
            before=None,
            after='{"text":"bearing changed"}',
            previous=previous,
            hash="",
        )
        entries.append(sealed(entry))
        previous = entries[-1].hash
    return entries


def head_of(entries: list[AuditEntry]) -> Anchor:
    return Anchor(entries[-1].number, entries[-1].hash) if entries else Anchor(0, NO_HASH)


def verified(
    entries: list[AuditEntry], *, of: list[AuditEntry], anchors: list[Anchor] | None = None
) -> Verification:
    """Verify what is there now; `of` is what was written, whose end the head still tells."""
    return verify(lambda: entries, head=head_of(of), anchors=anchors or [])


def written_anew(entries: list[AuditEntry], number: int, *, actor: str) -> list[AuditEntry]:
    """The chain with one entry changed, and all hashes from there on computed anew."""
    done = entries[: number - 1]
    for entry in entries[number - 1 :]:
        changed = replace(entry, actor=actor) if entry.number == number else entry
        previous = done[-1].hash if done else NO_HASH
        done.append(sealed(replace(changed, previous=previous)))
    return done


def test_the_hash_of_an_entry_is_that_of_its_canonical_json() -> None:
    """The figure was computed with sha256sum; whoever verifies elsewhere relies on it."""
    (entry,) = chain(1)
    assert digest(entry) == entry.hash
    assert entry.hash == "b8c1763e662366bd7eb6d85e7d3e27bb5f37f3cfb005f6c86280cc3e3b908070"


@pytest.mark.parametrize("length", [0, 1, 7])
def test_a_chain_as_it_was_written_is_right(length: int) -> None:
    entries = chain(length)
    assert verified(entries, of=entries) == Verification(length, head_of(entries))


@settings(max_examples=30)
@given(data=st.data())
def test_a_change_of_any_value_is_found(data: st.DataObject) -> None:
    entries = chain(5)
    number = data.draw(st.integers(1, 5))
    name = data.draw(
        st.sampled_from(["actor", "origin", "roles", "action", "subject_kind", "subject", "before", "after"])
    )
    entry = entries[number - 1]
    value = data.draw(st.text().filter(lambda text: text != getattr(entry, name)))
    changed = [*entries]
    change: dict[str, Any] = {name: value}
    changed[number - 1] = replace(entry, **change)
    found = verified(changed, of=entries)
    assert (found.fault, found.number) == (Fault.CHANGED, number)


@pytest.mark.parametrize("number", [1, 3, 5])
def test_a_change_of_the_time_is_found(number: int) -> None:
    entries = chain(5)
    changed = [*entries]
    changed[number - 1] = replace(entries[number - 1], time_ns=TIME_NS)
    found = verified(changed, of=entries)
    assert (found.fault, found.number) == (Fault.CHANGED, number)


@pytest.mark.parametrize("number", [1, 3, 4])
def test_a_changed_entry_with_a_hash_of_its_own_is_found(number: int) -> None:
    entries = chain(5)
    changed = [*entries]
    changed[number - 1] = sealed(replace(entries[number - 1], actor="bert"))
    found = verified(changed, of=entries)
    assert (found.fault, found.number) == (Fault.CHANGED, number)


def test_a_changed_last_entry_with_a_hash_of_its_own_is_not_the_head() -> None:
    entries = chain(5)
    found = verified(written_anew(entries, 5, actor="bert"), of=entries)
    assert (found.fault, found.number) == (Fault.CHANGED, 5)


@pytest.mark.parametrize(("first", "last"), [(1, 1), (2, 2), (2, 4), (4, 4)])
def test_removed_entries_are_found(first: int, last: int) -> None:
    entries = chain(5)
    found = verified([e for e in entries if not first <= e.number <= last], of=entries)
    assert (found.fault, found.number) == (Fault.REMOVED, first)
    assert f"{first} to {last} were" in str(found.message) or f"entry {first} was" in str(found.message)


@pytest.mark.parametrize("number", [1, 2, 4])
def test_a_removed_entry_whose_place_others_took_is_found(number: int) -> None:
    entries = chain(5)
    left = [entry for entry in entries if entry.number != number]
    found = verified([entry.at(place) for place, entry in enumerate(left, 1)], of=entries)
    assert (found.fault, found.number) == (Fault.REMOVED, number)


@pytest.mark.parametrize("number", [1, 3, 5])
@pytest.mark.parametrize("has_its_hash", [True, False])
def test_an_entry_put_in_is_found(number: int, *, has_its_hash: bool) -> None:
    entries = chain(5)
    before = entries[number - 2].hash if number > 1 else NO_HASH
    put_in = replace(entries[0].at(number), actor="mallory", previous=before)
    put_in = sealed(put_in) if has_its_hash else put_in
    now = [*entries[: number - 1], put_in, *(entry.at(entry.number + 1) for entry in entries[number - 1 :])]
    found = verified(now, of=entries)
    assert (found.fault, found.number) == (Fault.INSERTED, number)


def test_an_entry_put_in_behind_the_head_is_found() -> None:
    entries = chain(5)
    found = verified(chain(6), of=entries)
    assert (found.fault, found.number) == (Fault.INSERTED, 6)


@pytest.mark.parametrize(("one", "other"), [(1, 2), (2, 4), (4, 5), (1, 5)])
def test_entries_in_another_order_are_found(one: int, other: int) -> None:
    entries = chain(5)
    now = [*entries]
    now[one - 1], now[other - 1] = entries[other - 1].at(one), entries[one - 1].at(other)
    found = verified(now, of=entries)
    assert (found.fault, found.number) == (Fault.REORDERED, one)


def test_lines_in_another_order_are_found() -> None:
    entries = chain(5)
    found = verify(lambda: [entries[index] for index in (0, 1, 3, 2, 4)])
    assert (found.fault, found.number) == (Fault.REORDERED, 3)
    found = verify(lambda: [entries[index] for index in (0, 1, 1, 2)])
    assert (found.fault, found.number) == (Fault.REORDERED, 3)


@pytest.mark.parametrize("left", [0, 1, 4])
def test_an_end_that_was_cut_off_is_found_by_the_head(left: int) -> None:
    entries = chain(5)
    found = verified(entries[:left], of=entries)
    assert (found.fault, found.number) == (Fault.CUT_OFF, left + 1)


def test_an_end_cut_off_with_its_head_is_found_by_an_anchor_alone() -> None:
    entries = chain(5)
    assert verified(entries[:3], of=entries[:3]).fault is None
    found = verified(entries[:3], of=entries[:3], anchors=[head_of(entries)])
    assert (found.fault, found.number) == (Fault.CUT_OFF, 4)
    assert "the anchor" in str(found.message)


@pytest.mark.parametrize("number", [1, 3, 5])
def test_a_chain_computed_anew_is_found_by_an_anchor_alone(number: int) -> None:
    entries = chain(5)
    anew = written_anew(entries, number, actor="bert")
    assert verified(anew, of=anew).fault is None
    found = verified(anew, of=anew, anchors=[head_of(entries)])
    assert (found.fault, found.number) == (Fault.REPLACED, 5)
    older = verified(anew, of=anew, anchors=[head_of(entries), head_of(entries[:number])])
    assert older.number == number, "the older anchor says more exactly where"


def test_a_part_of_a_chain_is_right_behind_its_start() -> None:
    entries = chain(5)
    assert verify(lambda: entries[2:], start=head_of(entries[:2])).fault is None
    assert verify(lambda: entries[2:]).fault is Fault.REMOVED
