"""What the settings say is to be backed up, and where a back-up is put."""

from pathlib import Path

from service.backup.making import Source
from service.backup.restoring import Place
from service.configuration.settings import Settings
from service.recording_store.opening import folder_of


def source_of(settings: Settings, settings_file: Path | None) -> Source:
    """Return what a back-up of this service consists of. Raises StoreError (it is not all in files)."""
    files = {"settings.toml": settings_file, "plant.scd": settings.scd, "motors.toml": settings.motors}
    return Source(
        database_url=settings.database_url,
        recordings=folder_of(settings),
        configuration={name: path for name, path in files.items() if path is not None and path.is_file()},
    )


def place_of(settings: Settings) -> Place:
    """Return where these settings have the data of the service. Raises StoreError (as above)."""
    return Place(settings.data_directory, settings.database_url, folder_of(settings))
