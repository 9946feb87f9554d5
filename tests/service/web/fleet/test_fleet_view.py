"""The fleet is worked out and written once for all who look at the same time."""

import threading
from concurrent.futures import ThreadPoolExecutor

from markupsafe import Markup

from service.api import ApiContext
from service.web.fleet.filters import FleetFilter
from service.web.fleet.fleet import MOST_PARTS, Fleet, FleetView, WrittenPart


def test_many_who_look_at_once_have_it_written_once(context: ApiContext) -> None:
    fleet = Fleet(context.repository, context.settings)
    written: list[str] = []
    together = threading.Barrier(20)

    def write(view: FleetView) -> WrittenPart:
        written.append(view.stamp)
        return WrittenPart(Markup("all"), Markup("motors"), b"")

    def look(stamp: str) -> WrittenPart:
        together.wait(timeout=10)
        return fleet.part(stamp, FleetFilter(), write)

    with ThreadPoolExecutor(20) as viewers:
        for stamp in ("one", "two"):
            assert {part.text for part in viewers.map(look, [stamp] * 20)} == {"allmotors"}
    assert written == ["one", "two"]


def test_what_is_kept_does_not_grow_with_what_people_type(context: ApiContext) -> None:
    fleet = Fleet(context.repository, context.settings)
    number = 0

    def write(_view: FleetView) -> WrittenPart:
        nonlocal number
        number += 1
        return WrittenPart(Markup(""), Markup(""), b"")

    for _ in range(2):
        for at in range(MOST_PARTS + 1):
            fleet.part("one", FleetFilter(text=str(at)), write)
    assert number > MOST_PARTS + 1, "the first were given up for later ones"
    assert len(fleet._parts) <= MOST_PARTS
