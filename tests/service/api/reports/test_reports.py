"""Reports over REST: made of what is asked for, one at a time, and refused in words."""

import asyncio

import httpx
import pytest

from service.api import ApiContext
from service.api.limits.admission import Admission

REPORTS = "/api/v1/reports"
XLSX = "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet"


@pytest.mark.parametrize(
    ("path", "name"),
    [
        ("fleet", "fleet_daily_"),
        ("fleet?period=weekly&site=FACTORY_A", "fleet_weekly_"),
        ("motors/PUMP-A1", "motor_PUMP-A1_"),
        ("alarms?month=2025-10", "alarms_2025-10.pdf"),
        ("alarms", "alarms_"),
    ],
)
def test_each_report_as_pdf(client: httpx.Client, path: str, name: str) -> None:
    answer = client.get(f"{REPORTS}/{path}")
    assert answer.status_code == 200, answer.text
    assert answer.headers["content-type"] == "application/pdf"
    assert answer.headers["content-disposition"].startswith(f'attachment; filename="{name}')
    assert answer.headers["cache-control"] == "no-store"
    assert answer.content.startswith(b"%PDF")


def test_a_workbook(client: httpx.Client) -> None:
    answer = client.get(f"{REPORTS}/fleet", params={"format": "xlsx"})
    assert answer.headers["content-type"] == XLSX
    assert answer.content.startswith(b"PK")


def test_until_a_time_in_the_past(client: httpx.Client) -> None:
    answers = [client.get(f"{REPORTS}/fleet", params={"until": "2025-10-09T09:00:00Z"}) for _ in range(2)]
    assert "2025-10-09-09-00" in answers[0].headers["content-disposition"]
    assert answers[0].content == answers[1].content


@pytest.mark.parametrize(
    ("path", "status", "words"),
    [
        ("motors/PUMP-A9", 404, "PUMP-A9"),
        ("fleet?period=yearly", 422, "query.period"),
        ("fleet?until=2999-01-01T00:00:00Z", 422, "query.until: lies ahead"),
        ("fleet?until=0001-01-01T00:00:00Z", 422, "expected a time after 1970-01-31"),
        ("motors/PUMP-A1?until=1970-01-01T00:00:00Z", 422, "expected a time after 1970-01-31"),
        ("fleet?site=FACTORY_X", 422, "query.site: there is no site 'FACTORY_X' (did you mean FACTORY_A?)"),
        ("alarms?month=2025-13", 422, "query.month: expected a month such as 2026-11"),
        ("alarms?month=2199-01", 422, "query.month: 2199-01 has not begun"),
        ("fleet?format=doc", 422, "query.format"),
        ("fleet?whatever=1", 422, "whatever"),
    ],
)
def test_what_cannot_be_made_is_told(client: httpx.Client, path: str, status: int, words: str) -> None:
    answer = client.get(f"{REPORTS}/{path}")
    assert answer.status_code == status
    assert words in answer.json()["detail"] + str(answer.json().get("errors"))


def test_one_report_is_made_at_a_time(client: httpx.Client, context: ApiContext) -> None:
    full = Admission("reports", 1, wait_s=0.05)
    asyncio.run(full._turns.acquire())
    object.__setattr__(context, "reports", full)
    answer = client.get(f"{REPORTS}/fleet")
    assert answer.status_code == 503
    assert "1 reports are under way" in answer.json()["detail"]
