import math
from collections.abc import Iterator, Mapping
from pathlib import Path

import pytest
from annotated_types import Ge, Le
from pydantic import ValidationError

from service.alarms.confirmation import Confirmation
from service.background.housekeeping import Housekeeping
from service.configuration.settings import Settings, SettingsError
from service.storage import Repository
from testing.service.plants import NOW_NS, SECOND_NS
from tests.service.fixtures import database_url, engine, repository

__all__ = ["database_url", "engine", "repository"]

NUMBERS = [name for name, field in Settings.model_fields.items() if field.annotation in (int, float)]


@pytest.fixture(autouse=True)
def clean_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in Settings.model_fields:
        monkeypatch.delenv(f"MCC_{name.upper()}", raising=False)


def test_built_in_values_keep_to_the_loopback() -> None:
    settings = Settings.load()
    assert (str(settings.bind_address), settings.port) == ("127.0.0.1", 8710)
    assert settings.data_directory == Path.cwd() / "data"
    assert settings.database_url == f"sqlite:///{Path.cwd() / 'data' / 'statorwatch.sqlite'}"
    assert settings.recordings_directory == Path.cwd() / "data" / "recordings"


def test_options_win_over_the_environment_and_that_over_the_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    config = tmp_path / "mcc.toml"
    config.write_text('port = 1\nworkers = 1\njob_attempts = 1\nscd = "plant.scd"\n')
    monkeypatch.setenv("MCC_PORT", "2")
    monkeypatch.setenv("MCC_WORKERS", "2")
    settings = Settings.load(config, {"port": 3, "motors": None})
    assert (settings.port, settings.workers, settings.job_attempts) == (3, 2, 1)
    assert settings.scd == tmp_path / "plant.scd", "paths in the file are meant from its folder"
    assert settings.motors is None


def test_an_empty_variable_is_none(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    config = tmp_path / "mcc.toml"
    config.write_text("workers = 3\n")
    monkeypatch.setenv("MCC_SCD", "")
    monkeypatch.setenv("MCC_WORKERS", "")
    settings = Settings.load(config)
    assert (settings.scd, settings.workers) == (None, 3)


def test_lists_in_the_environment_are_json(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MCC_ALLOWED_HOSTS", '["mcc.plant.example"]')
    assert Settings.load().allowed_hosts == ("mcc.plant.example",)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("prot = 1", "prot: expected a setting named in docs/reference/settings.md"),
        ("port = 99999", "port: expected less than or equal to 65535, found 99999"),
        ("port = ", "expected valid TOML in UTF-8"),
    ],
)
def test_what_is_wrong_is_named(tmp_path: Path, content: str, message: str) -> None:
    config = tmp_path / "mcc.toml"
    config.write_text(content)
    with pytest.raises(SettingsError, match=r"mcc\.toml") as failure:
        Settings.load(config)
    assert message in str(failure.value)


def test_a_list_in_the_environment_that_is_no_json_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MCC_ALLOWED_HOSTS", "mcc.example")
    with pytest.raises(SettingsError, match=r"allowed_hosts.*|JSON"):
        Settings.load()


def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(SettingsError, match=r"none\.toml: file: expected a TOML file, found no file"):
        Settings.load(tmp_path / "none.toml")
    with pytest.raises(SettingsError, match="expected a readable file"):
        Settings.load(tmp_path)


def test_everything_that_is_wrong_is_told_at_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    config = tmp_path / "mcc.toml"
    config.write_text(
        'scd = "plant.scd"\nwrokers = 4\nport = 99999\n\n[retention]\nhealty_days = 3\n\n'
        '[relays.A1]\npasword_file = "a"\n'
    )
    monkeypatch.setenv("MCC_WROKERS", "4")
    monkeypatch.setenv("MCC_LEASE_S", "soon")
    monkeypatch.setenv("MCC_RELAY_PASWORD_A1", "hidden")
    monkeypatch.setenv("MCC_URL", "http://mcc")
    with pytest.raises(SettingsError) as failure:
        Settings.load(config)
    page = "docs/reference/settings.md"
    variable = f"MCC_ and the name of a setting of {page} in capitals, found an unknown variable"
    assert sorted(str(failure.value).splitlines()) == sorted(
        [
            f"environment: MCC_RELAY_PASWORD_A1: expected {variable} (did you mean MCC_RELAY_PASSWORD_?)",
            f"environment: MCC_WROKERS: expected {variable} (did you mean MCC_WORKERS?)",
            "environment: MCC_LEASE_S: expected a valid number, unable to parse string as a number, "
            "found 'soon'",
            f"{config}: line 2: wrokers: expected a setting named in {page}, found another name "
            "(did you mean workers?)",
            f"{config}: line 3: port: expected less than or equal to 65535, found 99999",
            f"{config}: line 6: retention.healty_days: expected a setting named in {page}, "
            "found another name (did you mean healthy_days?)",
            f"{config}: line 9: relays.A1.pasword_file: expected a setting named in {page}, "
            "found another name (did you mean password_file?)",
        ]
    )


def test_limits_of_transactions_are_shorter_than_the_lease() -> None:
    with pytest.raises(SettingsError) as failure:
        Settings.load(None, {"lease_s": 5.0, "transaction_idle_s": 5.0, "lock_wait_s": 4.9})
    (line,) = str(failure.value).splitlines()
    assert "transaction_idle_s: expected less than lease_s, which is 5, found 5" in line


def test_a_password_in_the_url_is_not_shown() -> None:
    settings = Settings(database_url="postgresql+psycopg://mcc:0penSesame@db.example/mcc")
    assert "0penSesame" not in repr(settings)


RELAY = """
[relays.A1_SEL710]
password_file = "secrets/A1"
tls = { certificate = "mcc.pem", key = "/keys/mcc.key", ca = "ca.pem", pinned = ["old.pem", "new.pem"] }
[relays.ca]
password_file = "secrets/ca"
"""


def test_the_files_of_a_relay_are_meant_from_the_settings_folder(tmp_path: Path) -> None:
    config = tmp_path / "mcc.toml"
    config.write_text(RELAY)
    relays = Settings.load(config).relays
    assert relays["ca"].password_file == tmp_path / "secrets" / "ca", "a relay of that name is a relay"
    access = relays["A1_SEL710"]
    assert access.password_file == tmp_path / "secrets" / "A1"
    assert access.tls is not None
    assert access.tls.certificate == tmp_path / "mcc.pem"
    assert access.tls.key == Path("/keys/mcc.key")
    assert access.tls.pinned == (tmp_path / "old.pem", tmp_path / "new.pem")


def test_settings_handed_to_a_gateway_keep_their_relays(tmp_path: Path) -> None:
    config = tmp_path / "mcc.toml"
    config.write_text(RELAY)
    settings = Settings.load(config)
    assert Settings.model_validate_json(settings.model_dump_json()) == settings


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ('[relays.A1]\npassword = "hidden"', "relays.A1.password: expected a setting named in"),
        (
            '[relays.A1.tls]\npassword = "hidden"\nkey = "k"\npinned = ["p"]',
            "relays.A1.tls.certificate: expected this setting, found none",
        ),
        ('[relays.A1.tls]\ncertificate = "c"\nkey = "k"\npinned = []', "relays.A1.tls.pinned: expected"),
        ('relays = "hidden"', "relays: expected a valid dictionary"),
    ],
)
def test_what_is_wrong_with_a_relay_is_named(tmp_path: Path, content: str, message: str) -> None:
    config = tmp_path / "mcc.toml"
    config.write_text(content)
    with pytest.raises(SettingsError, match=r"mcc\.toml") as failure:
        Settings.load(config)
    assert message in str(failure.value)


def bounds(name: str) -> tuple[float, float]:
    """The least and the largest value of a setting."""
    rules = Settings.model_fields[name].metadata
    (least,) = [float(str(rule.ge)) for rule in rules if isinstance(rule, Ge)]
    (largest,) = [float(str(rule.le)) for rule in rules if isinstance(rule, Le)]
    return least, largest


@pytest.mark.parametrize("name", NUMBERS)
def test_a_number_that_is_not_finite_or_out_of_bounds_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    least, largest = bounds(name)
    config = tmp_path / "mcc.toml"
    for value in ("inf", "-inf", "nan"):
        config.write_text(f"{name} = {value}\n")
        with pytest.raises(SettingsError, match=f"(?i){name}"):
            Settings.load(config)
        with monkeypatch.context() as environment:
            environment.setenv(f"MCC_{name.upper()}", value)
            with pytest.raises(SettingsError, match=f"(?i){name}"):
                Settings.load()
    for number in (math.inf, math.nan, largest + 1, 2 * largest, least - 1, -math.inf):
        with pytest.raises(ValidationError):
            Settings.model_validate({name: number})


def numbers_of(schema: object, path: str = "") -> Iterator[tuple[str, Mapping[str, object]]]:
    """Every number of a JSON schema, with where it stands."""
    if isinstance(schema, dict):
        if schema.get("type") in ("number", "integer"):
            yield path, schema
        for key, value in schema.items():
            yield from numbers_of(value, f"{path}/{key}")
    if isinstance(schema, list):
        for number, value in enumerate(schema):
            yield from numbers_of(value, f"{path}/{number}")


def test_no_number_lacks_its_bounds() -> None:
    found = dict(numbers_of(Settings.model_json_schema()))
    assert len(found) > len(NUMBERS), "those of the tables of relays too"
    for path, schema in found.items():
        assert {"minimum", "maximum"} <= schema.keys(), path


@pytest.mark.parametrize("end", [0, 1])
def test_the_least_and_the_largest_numbers_work(repository: Repository, tmp_path: Path, end: int) -> None:
    """In a gateway, which is given the settings as JSON, and in sums of time stamps."""
    numbers = {name: bounds(name)[end] for name in NUMBERS}
    settings = Settings.model_validate({"data_directory": tmp_path, **numbers})
    assert Settings.model_validate_json(settings.model_dump_json()) == settings
    housekeeping = Housekeeping(settings, repository)
    for hours in range(3):
        passed_ns = hours * 3600 * SECOND_NS
        housekeeping.average_and_delete(NOW_NS + passed_ns, passed_ns)


def test_a_database_url_that_is_no_text_is_not_told(tmp_path: Path) -> None:
    config = tmp_path / "mcc.toml"
    config.write_text('database_url = ["postgresql://mcc:Zx9@db/mcc"]')
    with pytest.raises(
        SettingsError, match="database_url: expected a valid string, found a value of type list"
    ):
        Settings.load(config)


def test_the_directory_of_the_back_ups_is_meant_from_the_files_folder(tmp_path: Path) -> None:
    config = tmp_path / "mcc.toml"
    config.write_text('[backup]\ndirectory = "copies"\ndaily_at = "23:59"\n')
    backup = Settings.load(config).backup
    assert (backup.directory, backup.daily_at, backup.keep) == (tmp_path / "copies", "23:59", 14)
    assert Settings().backup.directory is None


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ('daily_at = "24:00"', "backup.daily_at.*: expected .*pattern"),
        ("keep = 0", "backup.keep.*: expected greater than or equal to 1"),
        ('directry = "copies"', "backup.directry.*: expected a setting named in .*directory"),
        ("directory = 5", "backup.directory.*: expected"),
    ],
)
def test_what_is_wrong_with_the_back_up_is_named(tmp_path: Path, content: str, message: str) -> None:
    config = tmp_path / "mcc.toml"
    config.write_text(f"[backup]\n{content}\n")
    with pytest.raises(SettingsError, match=message):
        Settings.load(config)


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("watch_records = 4", "alarms: expected watch_records of at most 3 \\(watch_of_records\\), found"),
        (
            "healthy_records = 1",
            "alarms: expected healthy_records of at least 2, so that 2 of 3 records do not",
        ),
        ("healty_records = 2", "alarms.healty_records: .* \\(did you mean healthy_records\\?\\)"),
    ],
)
def test_rules_of_alarms_that_contradict_each_other_are_refused(tmp_path: Path, line: str, told: str) -> None:
    config = tmp_path / "mcc.toml"
    config.write_text(f"[alarms]\n{line}\n")
    with pytest.raises(SettingsError, match=told):
        Settings.load(config)


def test_the_rules_of_alarms_follow_from_the_settings() -> None:
    alarms = Settings().alarms
    assert alarms.watch == Confirmation(2, 3, 2)
    assert alarms.fault == Confirmation(1, 1, 2)


def test_a_gateway_reads_the_settings_that_it_is_given(tmp_path: Path) -> None:
    """They go to its process as JSON."""
    config = tmp_path / "mcc.toml"
    config.write_text(
        """
[backup]
directory = "copies"
[retention]
keep_operations = ["start"]
[notifications.channels.shift]
kind = "mail"
host = "mail.example"
from = "mcc@plant.example"
to = ["shift@plant.example"]
[notifications.channels.chat]
kind = "webhook"
url = "https://chat.example/hook"
[notifications.channels.log]
kind = "syslog"
host = "log.example"
[[notifications.routes]]
channels = ["shift"]
from = "18:00"
until = "06:00"
escalations = [{ after_min = 30, channels = ["chat"] }]
[[notifications.digests]]
period = "weekly"
at = "07:30"
channels = ["log"]
"""
    )
    settings = Settings.load(config)
    assert Settings.model_validate_json(settings.model_dump_json()) == settings
