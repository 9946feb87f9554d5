"""Each place is taken when it is due, at the time that was set last."""

from hypothesis import given
from hypothesis import strategies as st

from mms.server.agenda import Agenda

PLACES = 4
times = st.integers(0, 9).map(float)


@given(st.lists(st.tuples(st.sampled_from(["put", "hasten", "take"]), st.integers(0, PLACES - 1), times)))
def test_it_does_as_a_list_that_is_searched(steps: list[tuple[str, int, float]]) -> None:
    agenda, due_s = Agenda(PLACES), [0.0] * PLACES
    for what, place, time_s in steps:
        if what == "put":
            agenda.put(place, time_s)
            due_s[place] = time_s
        elif what == "hasten":
            agenda.hasten(place, time_s)
            due_s[place] = min(due_s[place], time_s)
        else:
            assert agenda.is_due(time_s) == any(due <= time_s for due in due_s)
            taken = agenda.take(time_s)
            if taken is None:
                assert min(due_s) > time_s
            else:
                assert due_s[taken] == min(due_s)
                agenda.put(taken, time_s + 1.0)
                due_s[taken] = time_s + 1.0
