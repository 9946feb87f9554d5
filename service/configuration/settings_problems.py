"""What is wrong in the settings: each problem with the file, variable or option that it comes from."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Final

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from core.error_words import nearest
from service.configuration.channel_secrets import VARIABLE, is_variable
from service.configuration.problems import ENVIRONMENT, Problem
from service.configuration.relay_access import PASSWORD_VARIABLE
from service.configuration.tables import is_table, way_and_model
from service.configuration.toml_lines import TomlLines

PREFIX: Final = "MCC_"

FURTHER_VARIABLES: Final = ("MCC_URL", "MCC_HOST_PORT", "MCC_TOKEN", "MCC_TOKEN_FILE", "MCC_CA")
"""These are no settings: what commands need to ask a service, and the port of docker-compose.yml."""

PAGE: Final = "docs/reference/settings.md"

FOLLOWS_FROM_ANOTHER: Final = "default_factory_not_called"
"""A default that is made of other settings was not made, because one of those is wrong."""


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
        if not variable.startswith(PASSWORD_VARIABLE) and not is_variable(variable):
            yield Problem(
                ENVIRONMENT,
                variable,
                f"{PREFIX} and the name of a setting of {PAGE} in capitals",
                "an unknown variable",
                nearest(variable, [*known, PASSWORD_VARIABLE, VARIABLE]),
            )


def problems_of(error: ValidationError, sources: Sources, model: type[BaseModel]) -> Iterator[Problem]:
    """Yield what the validation of the settings found wrong."""
    found = error.errors(include_url=False)
    ways = [details["loc"] for details in found]
    for details in found:
        way = details["loc"]
        # A list whose only item is wrong is told to be empty.
        follows = details["type"] == "too_short" and any(one[: len(way)] == way != one for one in ways)
        if details["type"] != FOLLOWS_FROM_ANOTHER and not follows:
            yield _problem(details, sources, model)


def _problem(details: ErrorDetails, sources: Sources, model: type[BaseModel]) -> Problem:
    setting = str(details["loc"][0]) if details["loc"] else ""
    path, holder = way_and_model(details["loc"], model) if is_table(setting, model) else ((setting,), model)
    source, field, line = sources.of(setting, path)
    if details["type"] == "extra_forbidden":
        known = [] if holder is None else [field.alias or name for name, field in holder.model_fields.items()]
        meant = nearest(str(path[-1]), known)
        return Problem(source, field, f"a setting named in {PAGE}", "another name", meant, line)
    if details["type"] == "missing":
        return Problem(source, field, "this setting", "none", line=line)
    if details["type"] in ("union_tag_invalid", "union_tag_not_found"):
        key = str(details.get("ctx", {})["discriminator"]).strip("'")
        source, field, line = sources.of(setting, (*path, key))
        return _of_kind(details, key, source, field, line)
    found = repr(details["input"])
    if setting in model.model_fields and not model.model_fields[setting].repr:
        found = f"a value of type {type(details['input']).__name__}"  # it may hold a password
    message = details["msg"].removeprefix("Input should be ").removeprefix("Value error, ")
    expected, _, said = message.partition(", found ")
    if isinstance(details["input"], dict):
        found = "a table with others"
    return Problem(source, field, expected, said or found, line=line)


def _of_kind(details: ErrorDetails, key: str, source: str, field: str, line: int | None) -> Problem:
    """Return what is wrong with the key that says of which kind a table is."""
    told = details.get("ctx", {})
    kinds = str(told.get("expected_tags", "")).replace("'", "")
    expected = f"one of {kinds}" if kinds else f"the key {key}, which says of which kind the table is"
    tag = str(told.get("tag", ""))
    meant = nearest(tag, kinds.split(", ")) if tag else None
    return Problem(source, field, expected, repr(tag) if tag else "none", meant, line)
