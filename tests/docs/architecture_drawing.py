"""Draw the rooms of the code and write them into docs/explanation/architecture.md: `make docs`.

A room is a package; an arrow says that code of one room imports code of another. The imports are read by
grimp, the library that import-linter uses. The drawings are Mermaid flowcharts, which code hosts render.
"""

import ast
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

import grimp

from tests.docs.pages import ROOT, between_markers

PAGE = ROOT / "docs" / "explanation" / "architecture.md"
PACKAGES = ("core", "scl", "mms", "ied_sim", "service", "statorwatch_client")

Arrows = frozenset[tuple[str, str]]


@dataclass(frozen=True)
class Drawing:
    """One picture: the rooms inside `inside`, and `beside` them the packages that they stand on.

    Only a picture with packages beside has a table of its rooms: inside one their docstrings are at hand.
    """

    inside: str
    beside: tuple[str, ...] = ()


DRAWINGS = {
    "house": Drawing("service", beside=("ied_sim", "core", "scl", "mms", "statorwatch_client")),
    "collector": Drawing("service.collector"),
    "core": Drawing("core"),
    "mms": Drawing("mms"),
    "ied_sim": Drawing("ied_sim"),
}


def rooms(graph: grimp.ImportGraph, drawing: Drawing) -> list[str]:
    """Return what a drawing shows: packages, and single modules beside them."""
    children = (child for child in graph.find_children(drawing.inside) if not child.endswith("__main__"))
    return [*sorted(children), *drawing.beside]


def arrows(graph: grimp.ImportGraph, shown: Iterable[str]) -> Arrows:
    """Return which of the rooms import which others, by any of their modules."""
    room_of = {module: room for room in shown for module in {room} | graph.find_descendants(room)}
    return frozenset(
        (room, room_of[imported])
        for module, room in room_of.items()
        for imported in graph.find_modules_directly_imported_by(module)
        if room_of.get(imported, room) != room
    )


def reachable(start: str, imports: Arrows) -> set[str]:
    """Return every room that `start` imports, directly or through others."""
    found: set[str] = set()
    waiting = [start]
    while waiting:
        here = waiting.pop()
        new = {to for source, to in imports if source == here} - found
        found |= new
        waiting.extend(new)
    return found


def reduced(imports: Arrows) -> Arrows:
    """Leave out arrows that follow from others (transitive reduction); keep all arrows of a circle."""
    reach = {room: reachable(room, imports) for arrow in imports for room in arrow}

    def in_one_circle(a: str, b: str) -> bool:
        return b in reach[a] and a in reach[b]

    def follows(source: str, to: str) -> bool:
        between = (room for room in reach[source] if to in reach[room])
        return any(not in_one_circle(source, room) and not in_one_circle(room, to) for room in between)

    return frozenset(
        (source, to) for source, to in imports if in_one_circle(source, to) or not follows(source, to)
    )


def circles(imports: Arrows) -> Arrows:
    """Return the arrows that lie on a circle of imports."""
    return frozenset((source, to) for source, to in imports if source in reachable(to, imports))


def flowchart(drawing: Drawing, shown: list[str], imports: Arrows) -> Iterator[str]:
    """Yield the lines of a Mermaid flowchart."""
    yield "```mermaid"
    yield "flowchart TD"
    yield f'    subgraph {_id(drawing.inside)}_rooms["{drawing.inside}"]'
    for room in shown:
        if room not in drawing.beside:
            yield f'        {_id(room)}["{room.removeprefix(f"{drawing.inside}.")}"]'
    yield "    end"
    yield from (f'    {_id(room)}["{room}"]' for room in drawing.beside)
    yield from (f"    {_id(source)} --> {_id(to)}" for source, to in sorted(imports))
    yield "```"


def table(shown: Iterable[str]) -> Iterator[str]:
    """Yield the lines of a table that says of each room what it holds, in the words of its docstring."""
    yield "| Room | What it holds |"
    yield "|---|---|"
    yield from (f"| `{room}` | {summary(room)} |" for room in shown)


def is_in(root: Path, module: str) -> bool:
    """Return whether a folder has the package of a module."""
    return (root / module.partition(".")[0]).is_dir()


def summary(module: str) -> str:
    """Return the first line of a module's docstring."""
    path = next(root / module.replace(".", "/") for root in (ROOT, ROOT / "client") if is_in(root, module))
    source = path / "__init__.py" if path.is_dir() else path.with_suffix(".py")
    docstring = ast.get_docstring(ast.parse(source.read_text(encoding="utf-8")))
    return (docstring or "").partition("\n")[0]


def _id(room: str) -> str:
    return room.replace(".", "_")


def drawn(page: str) -> str:
    """Return the page with its drawings made anew between their markers."""
    graph = grimp.build_graph(*PACKAGES)
    for name, drawing in DRAWINGS.items():
        shown = rooms(graph, drawing)
        lines = list(flowchart(drawing, shown, reduced(arrows(graph, shown))))
        if drawing.beside:
            lines += ["", *table(shown)]
        page = between_markers(page, f"drawing {name}", lines)
    return page


def main() -> None:
    PAGE.write_text(drawn(PAGE.read_text(encoding="utf-8")), encoding="utf-8")


if __name__ == "__main__":
    main()
