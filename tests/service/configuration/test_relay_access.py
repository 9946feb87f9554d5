"""Which relay is shown what: settings, environment, and names that are no relay's."""

from pathlib import Path

import pytest

import scl
from service.configuration.relay_access import (
    PASSWORD_VARIABLE,
    RelayAccess,
    RelayTls,
    clear_passwords,
    credentials,
)
from service.configuration.settings import Settings
from service.plant import PlantError, read_plant
from tests.service.plant.test_files import DEMO_MOTORS

TLS = RelayTls(certificate=Path("c"), key=Path("k"), pinned=(Path("p"),))
PASSWORD = "OTTER-7"  # noqa: S105


def demo(relays: dict[str, RelayAccess]) -> Settings:
    return Settings(scd=scl.DEMO_PLANT_SCD, motors=DEMO_MOTORS, relays=relays)


def test_a_relay_nobody_names_is_shown_nothing() -> None:
    shown = credentials({}, "A1_SEL710")
    assert (shown.tls, shown.password, shown.spoken_password) == (None, None, None)


def test_a_password_shows_itself_to_nobody_who_prints_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "password"
    path.touch(mode=0o600)
    path.write_bytes(PASSWORD.encode() + b"\r\n")
    monkeypatch.setenv(f"{PASSWORD_VARIABLE}A2", PASSWORD)
    for shown in (credentials({"A1": RelayAccess(password_file=path)}, "A1"), credentials({}, "A2")):
        assert shown.spoken_password == PASSWORD
        assert PASSWORD not in f"{shown} {shown!r} {shown.password}"


def test_passwords_without_tls_are_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(f"{PASSWORD_VARIABLE}BY_ENVIRONMENT", PASSWORD)
    monkeypatch.setenv(f"{PASSWORD_VARIABLE}SECURED", PASSWORD)
    relays = {
        "BY_FILE": RelayAccess(password_file=tmp_path / "password"),
        "SECURED": RelayAccess(tls=TLS),
        "NONE": RelayAccess(),
    }
    found = clear_passwords(relays, ["BY_FILE", "BY_ENVIRONMENT", "SECURED", "NONE", "UNNAMED"])
    assert found == ("BY_FILE", "BY_ENVIRONMENT")


def test_the_port_of_tls_takes_the_place_of_the_scds() -> None:
    at_port = TLS.model_copy(update={"port": 3782})
    plant = read_plant(demo({"A1_SEL710": RelayAccess(tls=at_port), "A2_SEL710": RelayAccess(tls=TLS)}))
    assert (plant.relay("A1_SEL710").port, plant.relay("A2_SEL710").port) == (3782, 10211)


def test_a_name_that_is_no_relays_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(PlantError, match=r"settings: relays\.A9: expected a relay of .*A1_SEL710, A2"):
        read_plant(demo({"A9": RelayAccess()}))
    monkeypatch.setenv(f"{PASSWORD_VARIABLE}A8", PASSWORD)
    with pytest.raises(PlantError, match=rf"environment: {PASSWORD_VARIABLE}A8: expected a relay") as failure:
        read_plant(demo({}))
    assert PASSWORD not in str(failure.value)
