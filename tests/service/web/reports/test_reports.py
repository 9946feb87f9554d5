"""The page of reports: what can be had, and the files themselves."""

from dataclasses import replace
from pathlib import Path

import httpx

from service.api import ApiContext
from service.configuration.settings import Settings
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.web.app import create_site
from testing.service.plants import two_motor_plant
from tests.service.api.serving import serving
from tests.service.web.pages import HOSTILE, addresses, page, words


def test_every_report_can_be_had(client: httpx.Client) -> None:
    document = page(client.get("/reports"))
    assert addresses(document, "main form") == ["/reports/fleet", "/reports/motor", "/reports/alarms"]
    assert words(document, "select[name=motor] option") == ["FAN-A2", "PUMP-A1"]
    assert words(document, "select[name=site] option")[:2] == ["all sites", "FACTORY_A"]
    months = words(document, "select[name=month] option")
    assert len(months) == 24
    assert months == sorted(months, reverse=True)
    assert "No report is sent." in words(document, "section[aria-labelledby=mails] p")[0]
    for path in (
        "/reports/fleet?period=weekly&site=&format=pdf",
        "/reports/fleet?period=daily&site=FACTORY_A&format=xlsx",
        "/reports/motor?motor=PUMP-A1&format=pdf",
        f"/reports/alarms?month={months[0]}&site=&format=xlsx",
    ):
        answer = client.get(path)
        assert answer.status_code == 200, answer.text
        assert answer.headers["content-disposition"].startswith("attachment; ")


def test_a_report_that_cannot_be_made_is_told_on_a_page(client: httpx.Client) -> None:
    answer = client.get("/reports/motor?motor=NOBODY")
    assert answer.status_code == 404
    assert answer.headers["content-type"].startswith("text/html")
    assert "NOBODY" in answer.text


def test_hostile_names_are_words(client: httpx.Client, repository: Repository) -> None:
    plant = two_motor_plant()
    evil = replace(plant.motors[0], motor=replace(plant.motors[0].motor, name=HOSTILE))
    repository.sync_plant(replace(plant, motors=(evil, plant.motors[1])))
    assert HOSTILE in words(page(client.get("/reports")), "select[name=motor] option")
    answer = client.get("/reports/motor", params={"motor": HOSTILE})
    assert answer.status_code == 200
    assert "<" not in answer.headers["content-disposition"]


def test_who_is_sent_which_report(repository: Repository, store: RecordingStore, tmp_path: Path) -> None:
    channel = {"kind": "mail", "host": "mail.example", "from": "a@b.example", "to": ["c@b.example"]}
    weekly = {"report": "fleet", "period": "weekly", "day": "fri", "at": "06:30", "channels": ["office"]}
    settings = Settings.model_validate(
        {
            "data_directory": tmp_path,
            "notifications": {"channels": {"office": channel}},
            "reports": {"mails": [weekly, {**weekly, "report": "motor", "motors": ["PUMP-A1"]}]},
        }
    )
    with serving(create_site(ApiContext(settings, repository, store))) as client:
        client.headers["Accept"] = "text/html"
        rows = words(page(client.get("/reports")), "section[aria-labelledby=mails] tbody tr")
    assert rows == ["fleet weekly, fri, 06:30 all office PDF", "motor weekly, fri, 06:30 PUMP-A1 office PDF"]


def test_a_plant_without_motors(client: httpx.Client, repository: Repository) -> None:
    repository.sync_plant(replace(two_motor_plant(), motors=()))
    assert "The plant has no motor." in words(page(client.get("/reports")), "main p")
