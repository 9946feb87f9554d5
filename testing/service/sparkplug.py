"""Payloads of Sparkplug B as somebody else reads and writes them: Google's protoc, with the tests' schema."""

import re
import shutil
import subprocess
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from testing.not_installed import not_installed
from testing.service.mosquitto import Heard

SCHEMA = Path(__file__).parents[2] / "tests" / "service" / "gateways" / "mqtt" / "sparkplug_b.proto"
LINE = re.compile(r'\s*(?:(?P<name>\w+): (?P<value>".*"|\S+)|(?P<begun>\w+) \{|(?P<end>\}))')

Fields = Mapping[str, list[Any]]


@dataclass(frozen=True, slots=True)
class Told:
    """A message of an edge node. fields: of the payload.  metrics: by name."""

    kind: str
    device: str
    fields: Fields

    @property
    def sequence(self) -> int | None:
        return self.fields["seq"][0] if "seq" in self.fields else None

    @property
    def metrics(self) -> Mapping[str, Fields]:
        return {metric["name"][0]: metric for metric in self.fields.get("metrics", [])}

    def value(self, name: str) -> object:
        """The value of a metric; None where it is null."""
        metric = self.metrics[name]
        (found,) = [value[0] for field, value in metric.items() if field.endswith("_value")] or [None]
        return found


def told(heard: Sequence[Heard]) -> list[Told]:
    """What an edge node told, of all that was heard."""
    found = []
    for one in list(heard):
        _, _, kind, _, *device = one.topic.split("/")
        if kind != "NCMD":
            found.append(Told(kind, "".join(device), decode(one.payload)))
    return found


def decode(payload: bytes) -> Fields:
    """The fields of a payload; a field that is repeated has all its values."""
    lines = iter(_protoc("--decode", payload).decode().splitlines())
    return _fields(lines)


def encode(text: str) -> bytes:
    """The payload of these fields, in the text format of Protocol Buffers."""
    return _protoc("--encode", text.encode())


def _fields(lines: Any) -> Fields:
    found: dict[str, list[Any]] = {}
    for line in lines:
        match = LINE.fullmatch(line)
        assert match is not None, line
        if match["end"]:
            break
        name = match["name"] or match["begun"]
        found.setdefault(name, []).append(_fields(lines) if match["begun"] else _value(match["value"]))
    return found


def _value(text: str) -> object:
    if text.startswith('"'):
        # Escapes as in C, of the bytes of UTF-8.
        return text[1:-1].encode("latin-1").decode("unicode_escape").encode("latin-1").decode()
    if text in ("true", "false"):
        return text == "true"
    return float(text) if re.search(r"[.en]", text) else int(text)


def _protoc(option: str, given: bytes) -> bytes:
    protoc = shutil.which("protoc")
    if protoc is None:
        not_installed("no protoc: apt-get install --no-install-recommends protobuf-compiler")
    command = [protoc, f"--proto_path={SCHEMA.parent}", f"{option}=Payload", SCHEMA.name]
    return subprocess.run(command, input=given, capture_output=True, check=True, timeout=30).stdout
