import tomllib
from collections.abc import Iterator

import pytest

from service.configuration.toml_lines import TomlLines

TEXT = """# a plant
scd = "plant.scd"
"data directory" = 'x'
text = \"\"\"
port = 1
\"\"\"
site.name.long = 1

[[motor]]
name = "P-1"   # [[motor]]

[motor.nameplate]
rated_power_W = 4000

[[motor]]
name = "P-2"
parts = [{ name = "x" }]

[motor.nameplate]
rated_power_W = 5000

[relays."A 1".tls]
pinned = ["a", "b"]
key = "k"

[relays.B]
tls = { certificate = "c", key = "d" }
"""


@pytest.mark.parametrize(
    ("path", "line"),
    [
        (("scd",), 2),
        (("data directory",), 3),
        (("port",), None),
        (("site", "name", "long"), 7),
        (("motor", 0), 9),
        (("motor", 0, "name"), 10),
        (("motor", 0, "nameplate", "rated_power_W"), 13),
        (("motor", 1, "name"), 16),
        (("motor", 1, "nameplate"), 19),
        (("motor", 1, "nameplate", "rated_power_W"), 20),
        (("motor", 1, "nameplate", "missing"), 19),
        (("motor", 1, "missing"), 15),
        (("relays", "A 1", "tls", "key"), 24),
        (("relays", "B", "tls", "key"), 27),
        (("missing",), None),
    ],
)
def test_the_line_of_a_key(path: tuple[str | int, ...], line: int | None) -> None:
    assert TomlLines(TEXT).line(*path) == line


def keys(value: object, path: tuple[str | int, ...] = ()) -> Iterator[tuple[str | int, ...]]:
    """The paths of all tables and keys, but those inside of lists of values."""
    if isinstance(value, dict):
        for key, each in value.items():
            yield (*path, key)
            yield from keys(each, (*path, key))
    if isinstance(value, list) and path[-1:] == ("motor",):
        for number, each in enumerate(value):
            yield from keys(each, (*path, number))


def test_every_key_has_a_line_that_names_it() -> None:
    lines = TEXT.splitlines()
    found = list(keys(tomllib.loads(TEXT)))
    assert len(found) > 20
    for path in found:
        line = TomlLines(TEXT).line(*path)
        assert line is not None, path
        assert isinstance(path[-1], int) or path[-1] in lines[line - 1], path
