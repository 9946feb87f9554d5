"""The drawings of docs/explanation/architecture.md are those of the code."""

import grimp
import pytest

from tests.docs.architecture_drawing import (
    DRAWINGS,
    PACKAGES,
    PAGE,
    arrows,
    circles,
    drawn,
    reduced,
    rooms,
    summary,
)


@pytest.fixture(scope="module")
def graph() -> grimp.ImportGraph:
    return grimp.build_graph(*PACKAGES)


def test_the_drawings_are_those_of_the_code() -> None:
    page = PAGE.read_text(encoding="utf-8")
    assert page == drawn(page), "the rooms have changed: run `make docs` and commit the page"


@pytest.mark.parametrize("name", DRAWINGS)
def test_every_room_says_what_it_holds(graph: grimp.ImportGraph, name: str) -> None:
    assert [room for room in rooms(graph, DRAWINGS[name]) if not summary(room).endswith(".")] == []


@pytest.mark.parametrize("name", DRAWINGS)
def test_imports_between_rooms_go_one_way(graph: grimp.ImportGraph, name: str) -> None:
    assert circles(arrows(graph, rooms(graph, DRAWINGS[name]))) == frozenset()


def test_an_arrow_that_follows_from_others_is_left_out() -> None:
    chain = frozenset({("a", "b"), ("b", "c")})
    assert reduced(chain | {("a", "c")}) == chain


def test_a_circle_keeps_its_arrows() -> None:
    circle = frozenset({("a", "b"), ("b", "a")})
    assert reduced(circle | {("a", "c")}) == circle | {("a", "c")}
    assert circles(circle | {("a", "c")}) == circle
