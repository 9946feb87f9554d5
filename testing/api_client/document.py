"""The OpenAPI document of the service, as `GET /api/v1/openapi.json` gives it."""

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from service.api import ApiContext, create_app
from service.configuration.settings import Settings
from service.recording_store.folder import FolderStore
from service.storage import Repository, connect

Json = dict[str, Any]


def openapi_document() -> Json:
    with TemporaryDirectory(prefix="statorwatch-openapi-") as name:
        folder = Path(name)
        engine = connect(f"sqlite:///{folder / 'empty.db'}")
        context = ApiContext(
            Settings(data_directory=folder), Repository(engine), FolderStore(folder / "recordings")
        )
        document: Json = create_app(context).openapi()
        engine.dispose()
    return document
