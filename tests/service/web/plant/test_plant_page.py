"""The page of the plant: what the files say against what the relays say, and the limits."""

import time

import httpx
import pytest

from core.machines.parameters import Nameplate
from service.condition.motor_data import document_of
from service.configuration.alarms import AlarmSettings
from service.configuration.settings import Settings
from service.storage import Repository
from service.storage.records import RelayFindings, Sample
from service.web.plant.limits import ALARM_RULES, COLLECTING, in_words
from service.web.plant.motors import measured
from testing.service.plants import motor
from tests.service.web.pages import HOSTILE, page, words

NOW_NS = time.time_ns()
RATED = Nameplate(rated_power_W=800.0, rated_voltage_V=400.0, rated_frequency_Hz=50.0, pole_pairs=2)


def sample(**values: float) -> Sample:
    return Sample("PUMP-A1", NOW_NS, values)


@pytest.mark.parametrize(
    ("values", "voltage", "agrees"),
    [
        ({"vab_V": 398.0, "vbc_V": 400.0, "vca_V": 402.0, "frequency_Hz": 49.9}, 400.0, (True, True)),
        ({"va_V": 230.0, "vb_V": 231.0, "vc_V": 232.0}, 400.1, (True, None)),
        ({"vab_V": 230.0, "frequency_Hz": 60.0}, 230.0, (False, False)),
        ({"vab_V": 2.0, "frequency_Hz": 50.0}, 2.0, (None, None)),
        ({"ia_A": 1.0, "frequency_Hz": 50.0}, None, (None, None)),
        ({"vab_V": float("nan")}, None, (None, None)),
    ],
    ids=["agrees", "phase-voltages", "another-net", "switched-off", "currents-alone", "no-number"],
)
def test_what_is_measured_is_compared_where_there_is_voltage(
    values: dict[str, float], voltage: float | None, agrees: tuple[bool | None, bool | None]
) -> None:
    found = measured(RATED, sample(**values))
    assert found.voltage_V == (None if voltage is None else pytest.approx(voltage, abs=0.1))
    assert (found.voltage_agrees, found.frequency_agrees) == agrees
    assert found.disagrees == (agrees[0] is False or agrees[1] is False)


def test_motors_are_shown_with_file_and_relay_side_by_side(
    client: httpx.Client, repository: Repository
) -> None:
    assert "not read yet" in client.get("/plant").text
    repository.note_motors({name: document_of(motor(name)) for name in ("PUMP-A1", "FAN-A2")}, now_ns=NOW_NS)
    repository.add_samples([Sample("PUMP-A1", NOW_NS, {"vab_V": 690.0, "frequency_Hz": 50.0})])
    document = page(client.get("/plant"))
    fan, pump = (words(row, "td") for row in document.cssselect("section[aria-labelledby=motors] tbody tr"))
    assert fan[0] == "A2_SEL710"
    assert fan[1].startswith("0.8 kW, ")
    assert fan[2] == "nothing recent"
    assert pump[2].startswith("differs 690 V, 50 Hz, ")
    assert pump[4] == "0.50 %"
    only = page(client.get("/plant", params={"text": "pump", "site": "FACTORY_A"}))
    assert words(only, "section[aria-labelledby=motors] tbody th > a") == ["PUMP-A1"]
    assert "No motor is like that" in client.get("/plant", params={"text": HOSTILE}).text


def test_what_differs_from_the_files_is_told_of_visited_relays_alone(
    client: httpx.Client, repository: Repository
) -> None:
    def told() -> str:
        return words(page(client.get("/plant")), "section[aria-labelledby=compared]")[0]

    assert "0 of 2 relays were visited, so nothing can be said yet." in told()
    repository.note_findings(RelayFindings("A1_SEL710", NOW_NS, {}, []))
    assert "1 of 2 relays were visited, and each of them offers what its SCL says" in told()
    difference = {"kind": "logical-node", "expected": HOSTILE, "found": None}
    repository.note_findings(RelayFindings("A1_SEL710", NOW_NS, {}, [difference] * 5))
    document = page(client.get("/plant"))
    cells = words(document, "section[aria-labelledby=compared] td")
    assert cells == [*["logical node", HOSTILE, "nothing"] * 3, "2 more"]


def test_every_limit_of_alarms_has_its_meaning_and_value(client: httpx.Client) -> None:
    assert set(ALARM_RULES) == set(AlarmSettings.model_fields)
    assert set(COLLECTING) <= set(Settings.model_fields)
    document = page(client.get("/plant"))
    rows = {
        words(row, "th")[0]: words(row, "td")
        for row in document.cssselect("section[aria-labelledby=limits] tr")
    }
    assert rows["alarms.link_down_s"] == ["10 minutes", "a relay that does not answer for so long is told"]
    assert rows["alarms.site_lost_share"][0] == "80 %"
    assert rows["max_relay_bytes_per_day"][0] == "1.07 GB"
    assert in_words("metering_period_s", 0.5) == "0.5 s"
