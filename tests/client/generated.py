"""What the client package has from the service's OpenAPI document, file by file.

The types of all documents come from datamodel-code-generator. The functions, one a route, are written here:
generators that write whole clients leave out files and pages, and need fifty thousand lines for the rest.
"""

import json
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from service.api import ApiContext, create_app
from service.configuration.settings import Settings
from service.recording_store.folder import FolderStore
from service.storage import Repository, connect
from tests.client.operations import operations_module
from tests.docs.pages import ROOT

PACKAGE = ROOT / "client/statorwatch_client"
MARK = "# Generated from the service's OpenAPI document by `make client`. Do not edit.\n"


def openapi_document() -> dict[str, Any]:
    """Return the document of a service with the settings that it has by default."""
    with tempfile.TemporaryDirectory() as folder:
        engine = connect(f"sqlite:///{folder}/unused.db")
        context = ApiContext(
            Settings(data_directory=Path(folder)), Repository(engine), FolderStore(Path(folder))
        )
        try:
            return create_app(context).openapi()
        finally:
            engine.dispose()


def files() -> dict[str, str]:
    """Return the generated modules by their names."""
    document = openapi_document()
    return {
        "models.py": _tidy(_models(document)),
        "operations.py": _tidy(MARK + operations_module(document, asynchronous=False)),
        "async_operations.py": _tidy(MARK + operations_module(document, asynchronous=True)),
    }


def _models(document: Mapping[str, Any]) -> str:
    with tempfile.TemporaryDirectory() as folder:
        source, target = Path(folder, "openapi.json"), Path(folder, "models.py")
        source.write_text(json.dumps(document))
        words = [
            *(
                sys.executable,
                "-m",
                "datamodel_code_generator",
                "--input",
                str(source),
                "--output",
                str(target),
            ),
            *("--input-file-type", "openapi", "--output-model-type", "typing.TypedDict"),
            *("--target-python-version", "3.11", "--enum-field-as-literal", "all", "--use-union-operator"),
            *("--use-standard-collections", "--use-schema-description"),
            *("--formatters", "builtin", "--custom-file-header", f'{MARK}"""The documents of the API."""'),
        ]
        subprocess.run(words, check=True, capture_output=True, text=True)
        written = target.read_text()
    # For pydantic, and for closed types, the generator wants a TypedDict that Python 3.11 has not.
    written = written.replace("from typing_extensions import TypedDict", "from typing import TypedDict")
    return written.replace("(TypedDict, closed=True)", "(TypedDict)")


def _tidy(source: str) -> str:
    """Return a module as ruff would have it."""
    for words in (("check", "--select", "I", "--fix-only"), ("format",)):
        done = subprocess.run(
            [str(Path(sys.executable).with_name("ruff")), *words, "--stdin-filename", f"{PACKAGE}/x.py", "-"],
            input=source,
            check=True,
            capture_output=True,
            text=True,
        )
        source = done.stdout
    return source
