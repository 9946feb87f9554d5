"""What a newcomer sees within a minute of `mcc demo`."""

from pathlib import Path

import pytest
from playwright.sync_api import Browser

from testing.web.demo_walk import PAGE, Walk, find_what_to_do, follow, look_at_every_page, running_demo
from testing.web.site import DESKTOP

pytestmark = [pytest.mark.campaign, pytest.mark.timeout(600)]


def test_the_first_line_leads_to_what_to_do_in_two_clicks(browser: Browser, tmp_path: Path) -> None:
    with running_demo(tmp_path) as demo:
        assert demo.first_line.startswith(PAGE)
        walk = Walk()
        page = follow(browser, demo.first_line.removeprefix(PAGE), DESKTOP)
        assert find_what_to_do(page, walk) == "COMPRESSOR-B2"
        assert walk.clicks == 2
        look_at_every_page(page, "COMPRESSOR-B2")
        page.page.context.close()
