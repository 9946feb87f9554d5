"""What is wrong in the settings: each problem with the file, variable or option that it comes from."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, Final

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from core.error_words import nearest
from service.configuration.alarms import AlarmSettings
from service.configuration.backup import BackupSettings
from service.configuration.problems import ENVIRONMENT, Problem
from service.configuration.relay_access import PASSWORD_VARIABLE, RelayAccess, RelayTls
from service.configuration.retention import RetentionSettings
from service.configuration.toml_lines import TomlLines

PREFIX: Final = "MCC_"

FURTHER_VARIABLES: Final = ("MCC_URL", "MCC_HOST_PORT")
"""These are no settings: the address that commands ask, and the port that docker-compose.yml publishes."""

PAGE: Final = "docs/reference/settings.md"

FOLLOWS_FROM_ANOTHER: Final = "default_factory_not_called"
"""A default that is made of other settings was not made, because one of those is wrong."""

TABLES: Final[Mapping[str, tuple[Any, ...]]] = {
    "relays": (None, None, RelayAccess, RelayTls),
    "backup": (None, BackupSettings),
    "alarms": (None, AlarmSettings),
    "retention": (None, RetentionSettings),
}
"""Models of the tables in the settings, by the depth of their keys."""


class Sources:
    """Where values come from; the later one wins."""

    def __init__(self, config: Path | None, lines: TomlLines, options: Mapping[str, object]) -> None:
        """Begin with a file, or None, and options of a command line; an option that is None was not given."""
        self.config = config
        self.lines = lines
        self.environment: Mapping[str, object] = {}
        self.options = {name: value for name, value in options.items() if value is not None}

    def of(self, setting: str, path: tuple[str | int, ...]) -> tuple[str, str, int | None]:
        """Return the source of a setting, how the key is called there, and its line in a file."""
        field = ".".join(map(str, path))
        if setting in self.options:
            return "command line", field, None
        if setting in self.environment:
            return ENVIRONMENT, field.replace(setting, f"{PREFIX}{setting.upper()}", 1), None
        if self.config is not None:
            return str(self.config), field, self.lines.line(*path)
        return "settings", field, None


def unknown_variables(variables: Mapping[str, str], settings: Mapping[str, object]) -> Iterator[Problem]:
    """Yield the variables of the environment that are named like settings and are none.

    Their values are not told: one may be a password whose variable is misspelt.
    """
    known = [*(f"{PREFIX}{name.upper()}" for name in settings), *FURTHER_VARIABLES]
    for variable in sorted(variables):
        if not variable.upper().startswith(PREFIX) or variable.upper() in known:
            continue
        if not variable.startswith(PASSWORD_VARIABLE):
            yield Problem(
                ENVIRONMENT,
                variable,
                f"{PREFIX} and the name of a setting of {PAGE} in capitals",
                "an unknown variable",
                nearest(variable, [*known, PASSWORD_VARIABLE]),
            )


def problems_of(error: ValidationError, sources: Sources, model: type[Any]) -> Iterator[Problem]:
    """Yield what the validation of the settings found wrong."""
    for details in error.errors(include_url=False):
        if details["type"] != FOLLOWS_FROM_ANOTHER:
            yield _problem(details, sources, model)


def _problem(details: ErrorDetails, sources: Sources, model: type[Any]) -> Problem:
    setting = str(details["loc"][0]) if details["loc"] else ""
    depth = None if setting in TABLES else 1
    path = details["loc"][:depth]
    source, field, line = sources.of(setting, path)
    if details["type"] == "extra_forbidden":
        known = _known(path, model)
        meant = nearest(str(path[-1]), known)
        return Problem(source, field, f"a setting named in {PAGE}", "another name", meant, line)
    if details["type"] == "missing":
        return Problem(source, field, "this setting", "none", line=line)
    found = repr(details["input"])
    if setting in model.model_fields and not model.model_fields[setting].repr:
        found = f"a value of type {type(details['input']).__name__}"  # it may hold a password
    expected = details["msg"].removeprefix("Input should be ")
    return Problem(source, field, expected, found, line=line)


def _known(path: tuple[str | int, ...], model: type[Any]) -> list[str]:
    """Return the names that a key beside this one may have."""
    tables = TABLES.get(str(path[0]), ())
    beside = tables[len(path) - 1] if 1 < len(path) <= len(tables) else model
    return [] if beside is None else list(beside.model_fields)
