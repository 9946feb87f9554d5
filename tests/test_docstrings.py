"""What is public is documented: in numpydoc sections where another package calls it, in a sentence
elsewhere."""

import ast
import importlib
import inspect
import pkgutil
from collections.abc import Iterator
from enum import Enum
from functools import cache
from pathlib import Path

import pytest
from numpydoc.validate import validate

PACKAGES = ("core", "mms", "scl")
CALLERS = ("core", "mms", "scl", "ied_sim", "service", "examples")
ROOT = Path(__file__).parents[1]

NOT_REQUIRED = {
    "ES01",  # an extended summary
    "EX01",  # examples
    "SA01",  # a section See Also
    "GL01",  # a summary on the line below the quotes
}
MEMBERS = (classmethod, staticmethod, property)


def modules(package: str) -> Iterator[str]:
    """Names of the package and of its public modules."""
    yield package
    for found in pkgutil.walk_packages(importlib.import_module(package).__path__, f"{package}."):
        if not any(part.startswith("_") for part in found.name.split(".")):
            yield found.name


def public_objects(module: str) -> Iterator[tuple[str, object]]:
    """Functions and classes that a module defines, and the members of its classes."""
    for name, found in vars(importlib.import_module(module)).items():
        if name.startswith("_") or getattr(found, "__module__", None) != module:
            continue
        if inspect.isfunction(found) or inspect.isclass(found):
            yield f"{module}.{name}", found
        if inspect.isclass(found):
            for member, value in vars(found).items():
                if not member.startswith("_") and (inspect.isfunction(value) or isinstance(value, MEMBERS)):
                    yield f"{module}.{name}.{member}", value


def has_parameters_of_its_own(found: object) -> bool:
    """Whether the signature says what a user passes: not that of an Enum, a protocol or an inherited one."""
    if not inspect.isclass(found):
        return True
    if issubclass(found, Enum) or getattr(found, "_is_protocol", False):
        return False
    return "__init__" in vars(found) or not issubclass(found, Exception)


@cache
def called_from_outside() -> frozenset[str]:
    """Modules and names in them that files of another package import."""
    found = set()
    for package in CALLERS:
        for path in (ROOT / package).rglob("*.py"):
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
                if isinstance(node, ast.ImportFrom) and node.module and not node.module.startswith(package):
                    found |= {node.module, *(f"{node.module}.{one.name}" for one in node.names)}
    return frozenset(found)


def needs_sections(name: str, module: str) -> bool:
    """Whether another package imports the object, or the class that it is a member of."""
    of_module = name.removeprefix(f"{module}.").split(".")[0]
    return f"{module}.{of_module}" in called_from_outside()


def faults(name: str, found: object, module: str) -> list[str]:
    """What numpydoc has against an object's docstring; of what its package alone calls, a sentence is
    enough."""
    if not needs_sections(name, module):
        told = inspect.getdoc(found) or ""
        return (
            [] if told.partition("\n")[0].endswith((".", ":")) else [f"{name}: no sentence says what it does"]
        )
    exempt = NOT_REQUIRED if has_parameters_of_its_own(found) else NOT_REQUIRED | {"PR01"}
    return [f"{name}: {code} {text}" for code, text in validate(name)["errors"] if code not in exempt]


@pytest.mark.parametrize("module", [module for package in PACKAGES for module in modules(package)])
def test_what_is_public_is_documented(module: str) -> None:
    found = [fault for name, each in public_objects(module) for fault in faults(name, each, module)]
    assert found == [], "\n".join(found)
