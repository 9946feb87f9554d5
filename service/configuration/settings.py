"""Settings of the service: built-in values, a TOML file, the environment (MCC_...), command line options.

The later one wins. docs/reference/settings.md explains every setting; a test fails when one is missing there.
"""

import os
import tomllib
from collections.abc import Collection, Mapping
from ipaddress import IPv4Address, IPv6Address
from pathlib import Path
from typing import Literal, Self

from pydantic import Field, ValidationError, ValidationInfo, field_validator
from pydantic_settings import BaseSettings, EnvSettingsSource, PydanticBaseSettingsSource, SettingsConfigDict
from pydantic_settings import SettingsError as UnreadableEnvironment

from core.units import SECONDS_PER_DAY
from service.configuration.access import AccessSettings
from service.configuration.alarms import AlarmSettings
from service.configuration.audit import AuditSettings
from service.configuration.backup import BackupSettings
from service.configuration.channels import CHANNEL_PATHS, MailChannel
from service.configuration.dask import DaskTls
from service.configuration.energy import EnergySettings
from service.configuration.gateways.settings import GatewaysSettings
from service.configuration.notifications import NotificationSettings
from service.configuration.problems import ENVIRONMENT, ConfigurationError, Problem, Problems
from service.configuration.recordings_url import BucketPlace
from service.configuration.relay_access import AbsolutePath, RelayAccess
from service.configuration.reports import ReportSettings
from service.configuration.retention import MOST_DAYS, RetentionSettings
from service.configuration.settings_problems import Sources, problems_of, unknown_variables
from service.configuration.toml_lines import TomlLines

MIB, GIB = 1024**2, 1024**3
PATHS = (
    "data_directory",
    "recordings_directory",
    "secrets_key_file",
    "scd",
    "motors",
    "tls_certificate",
    "tls_key",
)
RELAY_PATHS = ("certificate", "key", "ca", "crl", "pinned", "password_file")
GATEWAY_PATHS = ("certificate", "key", "ca", "crl", "pinned", "password_file", "trusted")
ACCESS_PATHS = ("ca", "client_secret_file")
DASK_PATHS = ("ca", "certificate", "key")


class SettingsError(ConfigurationError):
    """A setting cannot be used; it says which one, from where, what was expected and what was found."""


def settings_error(source: str, field: str, *, expected: str, found: str) -> SettingsError:
    """Return the error of one problem in the settings."""
    return SettingsError([Problem(source, field, expected, found)])


def sqlite_url(data_directory: Path) -> str:
    """Return the SQLAlchemy URL of the SQLite file in a data directory."""
    return f"sqlite:///{data_directory / 'statorwatch.sqlite'}"


class Settings(BaseSettings):
    """All settings, validated. Times are in seconds, sizes in bytes."""

    model_config = SettingsConfigDict(env_prefix="MCC_", extra="forbid", frozen=True, allow_inf_nan=False)

    data_directory: AbsolutePath = Field(default=Path("data"), validate_default=True)
    scd: AbsolutePath | None = None
    motors: AbsolutePath | None = None
    subnetwork: str | None = None
    log_format: Literal["auto", "text", "json"] = "auto"

    bind_address: IPv4Address | IPv6Address = IPv4Address("127.0.0.1")
    port: int = Field(default=8710, ge=0, le=65535)
    allowed_hosts: tuple[str, ...] = ("localhost", "127.0.0.1", "::1")
    tls_certificate: AbsolutePath | None = None
    tls_key: AbsolutePath | None = Field(default=None, validate_default=True)
    access: AccessSettings = Field(default_factory=AccessSettings)
    max_upload_bytes: int = Field(default=64 * MIB, ge=1, le=GIB)
    min_upload_rate: int = Field(default=32_768, ge=1, le=GIB)
    max_waveform_values: int = Field(default=250_000, ge=40_000, le=10_000_000)
    max_connections: int = Field(default=400, ge=1, le=65_536)
    header_timeout_s: float = Field(default=10.0, ge=0.1, le=600)
    transfer_timeout_s: float = Field(default=20.0, ge=0.1, le=600)
    idle_timeout_s: float = Field(default=5.0, ge=0.1, le=600)

    recordings_directory: AbsolutePath = Field(
        default_factory=lambda known: known["data_directory"] / "recordings"
    )
    secrets_key_file: AbsolutePath = Field(
        default_factory=lambda known: known["data_directory"] / "secrets.key"
    )
    recordings_url: str | None = Field(default=None, max_length=2000)
    database_url: str = Field(default_factory=lambda known: sqlite_url(known["data_directory"]), repr=False)

    workers: int = Field(default=2, ge=1, le=256)
    max_open_requests: int = Field(default=100, ge=1, le=10_000)
    max_queued_diagnoses: int = Field(default=500, ge=1, le=10_000)
    max_notes: int = Field(default=1000, ge=1, le=100_000)
    stale_after_days: float | None = Field(default=None, ge=0.01, le=MOST_DAYS)
    job_timeout_s: float = Field(default=60.0, ge=0.1, le=3600)
    job_attempts: int = Field(default=3, ge=1, le=20)
    job_retry_delay_s: float = Field(default=2.0, ge=0, le=3600)
    dask: DaskTls | None = None

    retention: RetentionSettings = Field(default_factory=RetentionSettings)
    backup: BackupSettings = Field(default_factory=BackupSettings)
    alarms: AlarmSettings = Field(default_factory=AlarmSettings)
    notifications: NotificationSettings = Field(default_factory=NotificationSettings)
    energy: EnergySettings = Field(default_factory=EnergySettings)
    reports: ReportSettings = Field(default_factory=ReportSettings, validate_default=True)
    audit: AuditSettings = Field(default_factory=AuditSettings)
    gateways: GatewaysSettings = Field(default_factory=GatewaysSettings)

    relays: dict[str, RelayAccess] = Field(default_factory=dict)
    relays_per_gateway: int = Field(default=250, ge=1, le=1000)
    lease_s: float = Field(default=30.0, ge=1, le=600)
    transaction_idle_s: float | None = Field(default=None, ge=0.1, le=600)
    lock_wait_s: float | None = Field(default=None, ge=0.1, le=600)
    events_directory: str = "EVENTS"
    connect_timeout_s: float = Field(default=5.0, ge=0.01, le=600)
    request_timeout_s: float = Field(default=5.0, ge=0.01, le=600)
    record_timeout_s: float = Field(default=30.0, ge=0.01, le=3600)
    poll_period_s: float = Field(default=5.0, ge=0.01, le=SECONDS_PER_DAY)
    quarantine_s: float = Field(default=60.0, ge=0.1, le=SECONDS_PER_DAY)
    long_record_days: float = Field(default=7.0, ge=0, le=365)
    long_record_s: float = Field(default=10.0, ge=1, le=30)
    text_report_period_s: float = Field(default=900.0, ge=0, le=SECONDS_PER_DAY)
    metering_period_s: float = Field(default=10.0, ge=0, le=SECONDS_PER_DAY)
    metering_sample_days: float = Field(default=1.0, ge=0.01, le=MOST_DAYS)
    metering_minute_days: float = Field(default=31.0, ge=0.01, le=MOST_DAYS)
    metering_quarter_hour_days: float = Field(default=3650.0, ge=0.01, le=MOST_DAYS)
    max_file_bytes: int = Field(default=64 * MIB, ge=1, le=GIB)
    max_relay_bytes_per_day: int = Field(default=GIB, ge=1, le=1024 * GIB)

    @field_validator("recordings_url")
    @classmethod
    def _of_a_bucket(cls, url: str | None) -> str | None:
        return None if url is None else str(BucketPlace.of(url))

    @field_validator("backup")
    @classmethod
    def _of_a_folder(cls, backup: BackupSettings, info: ValidationInfo) -> BackupSettings:
        if backup.directory is not None and info.data.get("recordings_url") is not None:
            raise ValueError(
                "no directory beside recordings_url: back-ups take recordings from a folder alone; back up"
                " the database by its own tools and then the bucket"
            )
        return backup

    @field_validator("tls_key")
    @classmethod
    def _both_for_tls(cls, key: Path | None, info: ValidationInfo) -> Path | None:
        if "tls_certificate" in info.data and (key is None) != (info.data["tls_certificate"] is None):
            raise ValueError("tls_certificate and tls_key together, or neither")
        return key

    @field_validator("transaction_idle_s", "lock_wait_s")
    @classmethod
    def _within_a_lease(cls, value: float | None, info: ValidationInfo) -> float | None:
        lease_s = info.data.get("lease_s")
        if value is not None and lease_s is not None and value >= lease_s:
            raise ValueError(f"less than lease_s, which is {lease_s:g}")
        return value

    @field_validator("reports")
    @classmethod
    def _mailed_through_mail(cls, reports: ReportSettings, info: ValidationInfo) -> ReportSettings:
        notifications = info.data.get("notifications")
        channels = notifications.channels if isinstance(notifications, NotificationSettings) else {}
        for number, mail in enumerate(reports.mails):
            for name in mail.channels:
                if not isinstance(channels.get(name), MailChannel) and notifications is not None:
                    known = [one for one, channel in channels.items() if isinstance(channel, MailChannel)]
                    raise ValueError(
                        f"channels of kind mail in mails.{number}, found {name}; there are"
                        f" {', '.join(known) or 'none'}"
                    )
        return reports

    @classmethod
    def settings_customise_sources(
        cls,
        settings_cls: type[BaseSettings],
        init_settings: PydanticBaseSettingsSource,
        env_settings: PydanticBaseSettingsSource,
        dotenv_settings: PydanticBaseSettingsSource,
        file_secret_settings: PydanticBaseSettingsSource,
    ) -> tuple[PydanticBaseSettingsSource, ...]:
        """Take the values that are given and nothing else: `load` has looked into the environment."""
        del settings_cls, env_settings, dotenv_settings, file_secret_settings
        return (init_settings,)

    @classmethod
    def load(cls, config: Path | None = None, options: Mapping[str, object] | None = None) -> Self:
        """Read a TOML file (may be None), the environment and `options` of the command line.

        Relative paths in the file start at the file's own folder. Options that are None were not given.
        Raises SettingsError.
        """
        problems = Problems()
        settings = cls.examine(config, problems, options)
        if settings is None or problems:
            raise SettingsError(problems)
        return settings

    @classmethod
    def examine(
        cls, config: Path | None, problems: Problems, options: Mapping[str, object] | None = None
    ) -> Self | None:
        """Read the same and add what is wrong to the problems; what is wrong has its default.

        None: the file cannot be read.
        """
        try:
            text = "" if config is None else _text(config)
            table = {} if config is None else _table(text, config)
        except SettingsError as error:
            problems.extend(error.problems)
            return None
        return cls._examined(table, Sources(config, TomlLines(text), options or {}), problems)

    @classmethod
    def _examined(cls, table: Mapping[str, object], sources: Sources, problems: Problems) -> Self:
        problems.extend(unknown_variables(os.environ, cls.model_fields))
        try:
            sources.environment = EnvSettingsSource(cls, env_ignore_empty=True)()
        except UnreadableEnvironment as error:
            expected = 'lists and tables as JSON, such as ["mcc"]'
            problems.add(Problem(ENVIRONMENT, "MCC_...", expected, str(error)))
        values = {**table, **sources.environment, **sources.options}
        try:
            return cls.model_validate(values)
        except ValidationError as error:
            problems.extend(problems_of(error, sources, cls))
            wrong = {str(details["loc"][0]) for details in error.errors(include_url=False)}
        return cls.model_validate({name: value for name, value in values.items() if name not in wrong})


def _text(config: Path) -> str:
    try:
        return config.read_text(encoding="utf-8")
    except FileNotFoundError as error:
        raise settings_error(str(config), "file", expected="a TOML file", found="no file") from error
    except OSError as error:
        raise settings_error(str(config), "file", expected="a readable file", found=str(error)) from error
    except UnicodeDecodeError as error:
        raise settings_error(str(config), "file", expected="valid TOML in UTF-8", found=str(error)) from error


def _table(text: str, config: Path) -> dict[str, object]:
    try:
        table: dict[str, object] = tomllib.loads(text)
    except (ValueError, RecursionError) as error:  # also of tables or numbers that Python has no room for
        raise settings_error(str(config), "file", expected="valid TOML in UTF-8", found=str(error)) from error
    for name in PATHS:
        value = table.get(name)
        if isinstance(value, str):
            table[name] = config.absolute().parent / value
    backup = table.get("backup")
    if isinstance(backup, dict) and isinstance(backup.get("directory"), str):
        table["backup"] = {**backup, "directory": config.absolute().parent / backup["directory"]}
    if isinstance(table.get("access"), dict):
        table["access"] = _anchored(table["access"], ACCESS_PATHS, config.absolute().parent)
    if isinstance(table.get("dask"), dict):
        table["dask"] = _anchored(table["dask"], DASK_PATHS, config.absolute().parent)
    _anchor_each(table, "relays", RELAY_PATHS, config.absolute().parent)
    _anchor_each(table.get("notifications"), "channels", CHANNEL_PATHS, config.absolute().parent)
    _anchor_each(table, "audit", CHANNEL_PATHS, config.absolute().parent)
    _anchor_each(table, "gateways", GATEWAY_PATHS, config.absolute().parent)
    return table


def _anchor_each(table: object, name: str, keys: Collection[str], folder: Path) -> None:
    """Let relative paths start at `folder` in each of the tables that stand below this name."""
    tables = table.get(name) if isinstance(table, dict) else None
    if isinstance(table, dict) and isinstance(tables, dict):
        table[name] = {one: _anchored(each, keys, folder) for one, each in tables.items()}


def _anchored(table: object, keys: Collection[str], folder: Path) -> object:
    """A table, and all tables in it, with relative paths at these keys that start at `folder`."""
    if not isinstance(table, dict):
        return table
    return {
        name: _paths(value, folder) if name in keys else _anchored(value, keys, folder)
        for name, value in table.items()
    }


def _paths(value: object, folder: Path) -> object:
    if isinstance(value, list):
        return [_paths(each, folder) for each in value]
    return folder / value if isinstance(value, str) else value
