"""Every page is there for those who may see it, and for nobody else."""

from collections.abc import Iterator

import httpx
import pytest
from fastapi.routing import iter_route_contexts

from service.access.permissions import PERMISSIONS_OF, Permission
from service.api import ApiContext
from service.api.access.requirements import requirement_of
from service.client.credentials import bearer
from service.storage import Repository
from service.storage.records import Role
from service.web.app import create_site
from service.web.navigation import PAGES
from testing.service.accounts import auditor, token_of
from tests.docs.role_tables import is_page
from tests.service.api.serving import serving
from tests.service.web.pages import page, words

HTML = {"Accept": "text/html"}


def _pages(context: ApiContext) -> Iterator[tuple[str, str, Permission]]:
    for route in iter_route_contexts(create_site(context).routes):
        needed = requirement_of(route.dependencies)
        if needed is not None and is_page(str(route.path)):
            for method in sorted(route.methods or ()):
                yield method, str(route.path), needed


@pytest.mark.parametrize("role", Role)
def test_each_role_gets_what_it_may_see(context: ApiContext, repository: Repository, role: Role) -> None:
    with serving(create_site(context), as_somebody=False) as client:
        for method, path, needed in _pages(context):
            if path == "/live":  # it does not end
                continue
            headers = bearer(token_of(repository, role, name=role.lower())) | HTML  # some routes end it
            path = path.replace("{", "").replace("}", "")
            answer = client.request(method, path, headers=headers)
            refused = answer.status_code == 403 or answer.headers.get("location") == "/account"
            is_account = path in ("/account", "/logout")
            may = needed in PERMISSIONS_OF[role]
            assert refused is not may or is_account, (method, path, answer.status_code)
            assert answer.status_code < 500, (method, path)


@pytest.mark.parametrize("role", Role)
def test_each_role_begins_at_a_page_it_may_see(
    context: ApiContext, repository: Repository, role: Role
) -> None:
    with serving(create_site(context), as_somebody=False) as client:
        headers = bearer(token_of(repository, role, name=role.lower())) | HTML
        answer = client.get("/", headers=headers, follow_redirects=True)
        assert answer.status_code == 200, answer.url


def test_every_link_at_the_top_leads_to_a_page(client: httpx.Client, repository: Repository) -> None:
    reads = auditor(repository)
    for place in PAGES:
        headers = reads if place.needed is Permission.AUDIT else {}
        assert client.get(place.path, headers=headers).status_code == 200, place.path


def test_settings_lead_to_the_pages_of_those_who_look(client: httpx.Client, repository: Repository) -> None:
    document = page(client.get("/plant"))
    assert words(document, "nav[aria-label=Pages] a") == [
        "Fleet", "Alarms", "Recordings", "Relays", "Reports", "Settings", "Help",
    ]  # fmt: skip
    assert words(document, "nav[aria-label=Pages] [aria-current]") == ["Settings"]
    assert words(document, "nav[aria-label=Settings] a") == ["Plant", "Notifications", "People", "Account"]
    assert words(document, "nav[aria-label=Settings] [aria-current]") == ["Plant"]
    assert not page(client.get("/")).cssselect("nav[aria-label=Settings]")
