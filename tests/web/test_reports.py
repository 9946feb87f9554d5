"""The page of reports in a browser: chosen, pressed, and a file is there."""

from pathlib import Path

import pytest

from service.storage.records import Role
from testing.web.seeding import FAULTY
from testing.web.site import PHONE, Site


@pytest.mark.parametrize(
    ("button", "name", "begins"),
    [
        ("Get the report of the fleet", "fleet_daily_", b"%PDF"),
        ("Get the report of the motor", f"motor_{FAULTY}_", b"%PDF"),
        ("Get the report of the alarms", "alarms_", b"%PDF"),
    ],
)
def test_a_report_is_fetched_by_its_button(looked_at: Site, button: str, name: str, begins: bytes) -> None:
    page = looked_at.open(Role.VIEWER)
    page.goto("/reports")
    page.page.locator("select[name=motor]").select_option(FAULTY)
    with page.page.expect_download() as download:
        page.page.get_by_role("button", name=button).click()
    assert download.value.suggested_filename.startswith(name)
    assert Path(download.value.path()).read_bytes().startswith(begins)


def test_a_workbook_with_the_keyboard_alone_on_a_phone(looked_at: Site) -> None:
    page = looked_at.open(Role.OPERATOR)
    page.page.set_viewport_size({"width": PHONE[0], "height": PHONE[1]})
    page.goto("/reports")
    page.page.get_by_label("Over the last").focus()
    page.page.keyboard.press("ArrowDown")
    page.page.keyboard.press("Tab")
    page.page.keyboard.press("Tab")
    page.page.keyboard.press("ArrowDown")
    page.page.keyboard.press("Tab")
    with page.page.expect_download() as download:
        page.page.keyboard.press("Enter")
    assert download.value.suggested_filename.startswith("fleet_weekly_")
    assert download.value.suggested_filename.endswith(".xlsx")
