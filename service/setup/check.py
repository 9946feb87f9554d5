"""Checks the files of a plant before a service runs on them: all that is wrong, at once.

The same readers serve as in the service, so what passes here is not refused there.
"""

import os
from dataclasses import dataclass
from pathlib import Path

from mms import CredentialFileError
from service.configuration.problems import Problem, Problems
from service.configuration.relay_access import AccessError, clear_passwords, credentials
from service.configuration.settings import Settings
from service.notifications.checking import channel_problems, report_problems, route_problems, warnings
from service.plant import Plant
from service.plant.files import examine_plant
from service.recording_store.errors import StoreError
from service.recording_store.opening import own_folders, require_usable, store_warnings
from service.storage import StorageError, connect


@dataclass(frozen=True, slots=True)
class CheckedPlant:
    """What the files came to.

    settings, plant: as far as they can be read, None where they cannot.
    problems: what is wrong; a service does not start.
    warnings: what is odd, in words; a service starts.
    """

    settings: Settings | None
    plant: Plant | None
    problems: tuple[Problem, ...]
    warnings: tuple[str, ...]


def check(config: Path | None) -> CheckedPlant:
    """Read the settings, the plant and the credentials of its relays."""
    problems = Problems()
    settings = Settings.examine(config, problems)
    if settings is None:
        return CheckedPlant(None, None, tuple(problems), ())
    plant = examine_plant(settings, problems)
    source = "settings" if config is None else str(config)
    problems.extend(_database(settings, source))
    problems.extend(_directories(settings, source))
    problems.extend(_recordings(settings, source))
    problems.warnings.extend(store_warnings(settings))
    problems.extend(channel_problems(settings.notifications, source))
    if plant is not None:
        sites = [site.name for site in plant.sites]
        motors = [motor.name for motor in plant.motors]
        problems.extend(route_problems(settings.notifications, sites, source))
        problems.extend(report_problems(settings.reports, sites, motors, source))
        problems.warnings.extend(warnings(settings.notifications, sites))
        names = [relay.name for relay in plant.relays]
        for name in names:
            problems.extend(_credentials(settings, name))
        problems.warnings.extend(
            f"relay {name}: its password goes over the network in clear: configure TLS for it"
            for name in clear_passwords(settings.relays, names)
        )
    in_order = sorted(problems, key=lambda problem: (problem.source, problem.line or 0))
    return CheckedPlant(settings, plant, tuple(in_order), tuple(problems.warnings))


def _database(settings: Settings, source: str) -> list[Problem]:
    """Return what is wrong with the URL. The database itself is not asked."""
    try:
        connect(settings.database_url).dispose()
    except StorageError as error:
        return [_of_text(source, "database_url", str(error))]
    return []


def _directories(settings: Settings, source: str) -> list[Problem]:
    """Return the folders that cannot be made or written to."""
    problems = []
    for name, folder in {"data_directory": settings.data_directory, **own_folders(settings)}.items():
        existing = next(each for each in (folder, *folder.parents) if each.exists())
        if not existing.is_dir() or not os.access(existing, os.W_OK):
            expected = f"a folder that user {os.getuid()} may write to"
            problems.append(Problem(source, name, expected, f"{existing}, which is none"))
    return problems


def _recordings(settings: Settings, source: str) -> list[Problem]:
    """Return why the store of the recordings cannot be used. An S3-compatible store itself is not asked."""
    try:
        require_usable(settings)
    except StoreError as error:
        return [_of_text(source, "recordings_url", str(error))]
    return []


def _credentials(settings: Settings, relay: str) -> list[Problem]:
    try:
        own = credentials(settings.relays, relay)
        if own.tls is not None:
            own.tls.check()
    except CredentialFileError as error:
        return [Problem(str(error.path), f"relays.{relay}", error.expected, error.found)]
    except AccessError as error:
        return [_of_text("environment", f"relays.{relay}", str(error))]
    return []


def _of_text(source: str, field: str, text: str) -> Problem:
    """Return the problem that an error tells as "expected ..., found ..."."""
    expected, found, rest = text.partition("expected ")[2].partition(", found ")
    return Problem(source, field, expected or text, rest if found else "something else")
