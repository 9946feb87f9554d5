"""What the tests of pages rest on: the browser, the seeded plant, and that what goes wrong is seen."""

import pytest

from service.storage.records import Role
from testing.web.seeding import FAULTY, STANDING
from testing.web.site import Site
from testing.web.watched_page import WatchedPage

BAD_PAGE = """<!doctype html><html lang="en"><title>t</title><img src="http://example.invalid/x.png">
<p style="color:red">x</p><script>document.title = "ran"</script><p onclick="alert(1)">y</p></html>"""


def test_the_seeded_plant_has_what_pages_show(looked_at: Site) -> None:
    conditions = looked_at.repository.conditions()
    assert conditions[FAULTY].state == "fault"
    assert conditions[FAULTY].phase is not None
    assert conditions[STANDING].state == "healthy"
    kinds = {alarm.kind for alarm in looked_at.repository.open_alarms(limit=100).items}
    assert {"condition-fault", "file-refused"} <= kinds


def test_a_login_shows_a_page_and_no_problem(looked_at: Site) -> None:
    page = looked_at.open(Role.VIEWER)
    page.goto("/alarms")
    page.require_quiet()


def test_what_goes_wrong_in_a_page_is_seen(site: Site) -> None:
    page = site.open()
    page.page.route(
        "**/bad",
        lambda route: route.fulfill(
            body=BAD_PAGE,
            content_type="text/html",
            headers={"Content-Security-Policy": "default-src 'none'; script-src 'self'; style-src 'self'"},
        ),
    )
    page.goto("/bad")
    text = "\n".join(page.problems)
    assert page.page.title() == "t", "no script of the page's own ran"
    for word in ("script-src", "style-src", "another host"):
        assert word in text
    page.problems.clear()
    with pytest.raises(AssertionError, match="html-has-lang"):
        no_language(page)
    page.problems.clear()


def no_language(page: WatchedPage) -> None:
    page.page.route("**/worse", lambda route: route.fulfill(body="<p>x</p>", content_type="text/html"))
    page.goto("/worse")
    page.require_accessible()
