"""How far each test file is from what changed, by imports."""

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from os.path import commonpath
from pathlib import PurePosixPath

import grimp


@dataclass(frozen=True, slots=True)
class Reached:
    """A test file that a change can break. distance: how many imports lead from it to what changed."""

    file: str
    distance: int


def imports_of(graph: grimp.ImportGraph) -> dict[str, set[str]]:
    """Return for each module those that import it, and the tests that its fixtures serve."""
    importers = {module: set(graph.find_modules_that_directly_import(module)) for module in graph.modules}
    for module in graph.modules:
        if module.endswith(".conftest"):
            folder = module.removesuffix("conftest")
            importers[module] |= {one for one in graph.modules if one.startswith(folder) and is_test(one)}
    return importers


def is_test(module: str) -> bool:
    """Tell whether pytest collects a module."""
    return module.rpartition(".")[2].startswith("test_")


def reached_tests(changed: Collection[str], importers: Mapping[str, Iterable[str]]) -> list[Reached]:
    """Return the test files that a change of modules can break, nearest first.

    After tests that changed themselves come those of the changed module's own room, however far by imports.
    """
    distances = dict.fromkeys(changed, 0)
    edge = list(changed)
    while edge:
        following = []
        for module in edge:
            for importer in importers[module]:
                if importer not in distances:
                    distances[importer] = distances[module] + 1
                    following.append(importer)
        edge = following
    rooms = [f"tests/{module.replace('.', '/')}" for module in changed]
    found = [
        Reached(module.replace(".", "/") + ".py", distance)
        for module, distance in distances.items()
        if is_test(module)
    ]
    own = tuple(f"{room.rpartition('/')[0]}/" for room in rooms)
    return sorted(found, key=lambda one: (_rank(one, own), -_shared(one.file, rooms), one.file))


def _rank(one: Reached, own: tuple[str, ...]) -> tuple[bool, int]:
    return one.distance > 0 and not one.file.startswith(own), one.distance


def _shared(file: str, rooms: Iterable[str]) -> int:
    """Return how many folders a file shares with the nearest of the rooms that tests mirror."""
    return max(len(PurePosixPath(commonpath([file, room])).parts) for room in rooms)
