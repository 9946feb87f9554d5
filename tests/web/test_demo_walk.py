"""What a newcomer sees within a minute of `mcc demo`."""

from pathlib import Path

import pytest
from playwright.sync_api import Browser

from testing.web.demo_walk import LIMIT_MS, PAGE, Walk, find_what_to_do, follow, running_demo
from testing.web.site import DESKTOP

pytestmark = [pytest.mark.campaign, pytest.mark.timeout(600)]


def test_the_first_line_leads_to_what_to_do_in_two_clicks(browser: Browser, tmp_path: Path) -> None:
    with running_demo(tmp_path) as demo:
        assert demo.first_line.startswith(PAGE)
        walk = Walk()
        page = follow(browser, demo.first_line.removeprefix(PAGE), DESKTOP)
        assert find_what_to_do(page, walk) == "COMPRESSOR-B2"
        assert walk.clicks == 2
        page.goto("/")
        standing = page.page.locator("table.fleet tbody tr", has_text="PUMP-B3")
        standing.get_by_text("not running").first.wait_for(timeout=LIMIT_MS)
        for path in ("/alarms", "/relays", "/plant", "/people", "/audit"):
            page.goto(path)
            assert page.page.locator("main").inner_text().count("\n") > 5
        page.goto("/starts")
        page.page.locator("main").get_by_role("link", name="PUMP-A1").first.wait_for(timeout=LIMIT_MS)
        page.require_quiet()
        page.page.context.close()
