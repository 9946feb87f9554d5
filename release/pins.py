"""Pinned packages, as pip reads them: constraints.txt for who develops, requirements.txt for the image."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

_PIN = re.compile(r"(?P<name>[A-Za-z0-9._-]+)(?:\[[^]]*\])?==(?P<version>[^\s;\\]+)")
_HASH = re.compile(r"--hash=sha256:([0-9a-f]{64})")


class PinError(ValueError):
    """A line is no pin."""


@dataclass(frozen=True, slots=True)
class Pin:
    """A package of one version. sha256: of each of its files; none where the file names no hashes."""

    name: str
    version: str
    sha256: tuple[str, ...]


def read_pins(path: Path) -> Sequence[Pin]:
    """Return the pins of a file. Raises PinError, OSError."""
    pins = []
    for line in path.read_text(encoding="utf-8").replace("\\\n", " ").splitlines():
        text = line.partition(" #")[0].strip()
        if not text or text.startswith("#"):
            continue
        found = _PIN.match(text)
        if found is None:
            raise PinError(f"{path}: expected lines such as numpy==2.3.1, found {text[:80]!r}")
        pins.append(Pin(normalised(found["name"]), found["version"], tuple(_HASH.findall(text))))
    return pins


def normalised(name: str) -> str:
    """Return a package's name as registries compare it."""
    return re.sub(r"[-_.]+", "-", name).lower()
