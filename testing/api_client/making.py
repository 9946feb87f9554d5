"""Makes the modules of the client that follow from the OpenAPI document."""

import json
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from testing.api_client.document import Json, openapi_document
from testing.api_client.operations import operations_module

PACKAGE = Path(__file__).parents[2] / "statorwatch_client"
ROOT = PACKAGE.parent
MODELS_HEAD = '"""The documents of the API. Made by `make client`; not to be edited."""'
GENERATOR = (
    *("--input-file-type", "openapi", "--output-model-type", "typing.TypedDict"),
    *("--target-python-version", "3.11", "--use-standard-collections", "--use-union-operator"),
    *("--disable-timestamp", "--use-schema-description", "--enum-field-as-literal", "all"),
    *("--formatters", "builtin", "--custom-file-header", MODELS_HEAD),
)


def written_modules() -> dict[str, str]:
    """Return the text of each module, by name."""
    document = openapi_document()
    texts = {"models.py": _models(document), "operations.py": operations_module(document)}
    return {name: _formatted(name, text) for name, text in texts.items()}


def _models(document: Json) -> str:
    with TemporaryDirectory(prefix="statorwatch-client-") as name:
        given, made = Path(name, "openapi.json"), Path(name, "models.py")
        given.write_text(json.dumps(_open(document)), encoding="utf-8")
        files = ["--input", str(given), "--output", str(made)]
        command = [sys.executable, "-m", "datamodel_code_generator", *files, *GENERATOR]
        subprocess.run(command, check=True, cwd=ROOT)
        return made.read_text(encoding="utf-8").replace("from typing_extensions import", "from typing import")


def _open(part: object) -> object:
    """Return a part of the document without "no other fields", which no TypedDict of Python 3.11 can say."""
    if isinstance(part, dict):
        return {
            key: _open(value)
            for key, value in part.items()
            if not (key == "additionalProperties" and value is False)
        }
    return [_open(each) for each in part] if isinstance(part, list) else part


def _formatted(name: str, text: str) -> str:
    for command in (["check", "--fix", "--quiet", "--unfixable", "D"], ["format", "--quiet"]):
        done = subprocess.run(
            [sys.executable, "-m", "ruff", *command, "--stdin-filename", PACKAGE / name, "-"],
            input=text, capture_output=True, text=True, check=False, cwd=ROOT,
        )  # fmt: skip
        if not done.stdout:
            raise RuntimeError(f"{name}: ruff cannot read what was made of it: {done.stderr}")
        text = done.stdout
    return text
