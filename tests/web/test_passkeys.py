"""Passkeys in a browser, with a device that it plays itself (WebDriver's virtual authenticator)."""

import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, CDPSession, expect

from service.access.passwords import hashed
from service.storage.records import Role
from testing.ports import free_port
from testing.service.accounts import TESTS
from testing.web.site import PHONE, Site, running_site
from testing.web.watched_page import WatchedPage

PASSWORD = "correct horse battery"  # noqa: S105 - of nobody
WITH_PASSKEY = "Log in with password and passkey"
NOT_HERE = "Passkeys are added at"


@pytest.fixture
def site(seeded: Path, tmp_path: Path, browser: Browser) -> Iterator[Site]:
    """A site that people reach at a name: addresses of numbers have no passkeys."""
    data = shutil.copytree(seeded, tmp_path / "data")
    port = free_port()
    address = {"address": f"http://localhost:{port}"}
    with running_site(data, browser, host="localhost", port=port, notifications=address) as site:
        site.repository.add_user("anna", [Role.OPERATOR], password=hashed(PASSWORD), by=TESTS, now_ns=1)
        yield site
        problems = site.close_pages()
        assert not problems, "\n".join(problems)


class Device:
    """The device of a page. It has a passkey for whoever asks, and somebody is there."""

    def __init__(self, page: WatchedPage) -> None:
        self._tools: CDPSession = page.page.context.new_cdp_session(page.page)
        self._tools.send("WebAuthn.enable")
        options = {
            "protocol": "ctap2",
            "transport": "internal",
            "hasResidentKey": True,
            "hasUserVerification": True,
            "isUserVerified": True,
            "automaticPresenceSimulation": True,
        }
        made = self._tools.send("WebAuthn.addVirtualAuthenticator", {"options": options})
        self._device = made["authenticatorId"]

    def passkeys(self) -> list[dict[str, Any]]:
        found = self._tools.send("WebAuthn.getCredentials", {"authenticatorId": self._device})
        return list(found["credentials"])

    def take(self, passkey: dict[str, Any]) -> None:
        """Have a passkey of another device, as it was there."""
        self._tools.send("WebAuthn.addCredential", {"authenticatorId": self._device, "credential": passkey})

    def forget(self) -> None:
        self._tools.send("WebAuthn.clearCredentials", {"authenticatorId": self._device})


def log_in(page: WatchedPage, button: str = "Log in") -> None:
    page.goto("/login")
    page.page.get_by_label("Name").fill("anna")
    page.page.get_by_label("Password").fill(PASSWORD)
    page.page.get_by_role("button", name=button, exact=True).click()


def add(page: WatchedPage, label: str) -> None:
    form = page.page.locator("form[action='/account/passkeys']")
    form.get_by_label("Name of the new passkey").fill(label)
    form.get_by_label("Password now").fill(PASSWORD)
    form.get_by_role("button", name="Add a passkey").click()


def test_a_passkey_is_added_used_named_and_removed(site: Site) -> None:
    page = site.open()
    device = Device(page)
    log_in(page)
    page.goto("/account")
    page.require_accessible()
    add(page, "blue key")
    expect(page.page.locator("main li code")).to_have_count(10)
    page.require_accessible()
    page.goto("/account")
    expect(page.page.locator("main")).to_contain_text("Recovery codes left: 10")
    page.page.set_viewport_size({"width": PHONE[0], "height": PHONE[1]})
    page.require_no_sideways_scroll()
    page.require_accessible()
    assert [one["rpId"] for one in device.passkeys()] == ["localhost"]

    page.page.get_by_role("button", name="Log out").click()
    page.page.wait_for_url("**/login*")
    with page.accepting(401):
        log_in(page)
        expect(page.page.get_by_role("alert")).to_contain_text("the second factor is wrong, used or missing")
    page.require_accessible()
    log_in(page, WITH_PASSKEY)
    page.page.wait_for_url(f"{site.url}/")
    (kept,) = site.repository.passkeys("anna")
    assert (kept.label, kept.used_ns is not None, kept.signatures > 1) == ("blue key", True, True)

    page.goto("/account")
    page.page.get_by_label("Password now, to remove one").fill(PASSWORD)
    page.page.get_by_role("button", name="Remove blue key").click()
    expect(page.page.locator("#messages")).to_contain_text("The passkey is removed")
    assert not site.repository.user("anna").has_second_factor
    page.require_quiet()


def test_a_copy_of_a_device_that_is_behind_gets_nobody_in(site: Site) -> None:
    page, thief = site.open(), site.open()
    device, copy = Device(page), Device(thief)
    log_in(page)
    page.goto("/account")
    add(page, "blue key")
    expect(page.page.locator("main li code")).to_have_count(10)
    (stolen,) = device.passkeys()
    log_in(page, WITH_PASSKEY)
    page.page.wait_for_url(f"{site.url}/")
    copy.take(stolen)
    with thief.accepting(401):
        log_in(thief, WITH_PASSKEY)
        expect(thief.page.get_by_role("alert")).to_contain_text("the second factor is wrong")
    with site.repository.audit_trail() as trail:
        reasons = [str(entry.after) for entry in trail.entries() if entry.action == "login-failed"]
    assert "somebody may have a copy of it" in reasons[-1]


def test_a_device_without_the_passkey_and_a_wrong_password_are_told_in_words(site: Site) -> None:
    page = site.open()
    device = Device(page)
    log_in(page)
    page.goto("/account")
    form = page.page.locator("form[action='/account/passkeys']")
    form.get_by_label("Name of the new passkey").fill("blue key")
    form.get_by_label("Password now").fill("wrong")
    with page.accepting(401):
        form.get_by_role("button", name="Add a passkey").click()
        expect(page.page.get_by_role("alert")).to_contain_text("the name or the password is wrong")
    form.get_by_label("Password now").fill(PASSWORD)
    form.get_by_role("button", name="Add a passkey").click()
    expect(page.page.locator("main li code")).to_have_count(10)
    page.goto("/account")
    add(page, "the same again")
    expect(page.page.get_by_role("alert")).to_contain_text("This device has a passkey of yours already")
    device.forget()
    log_in(page, WITH_PASSKEY)
    expect(page.page.get_by_role("alert")).to_contain_text("No passkey was used")


def test_where_no_passkey_can_be_used_the_page_says_so_and_a_login_is_as_before(site: Site) -> None:
    elsewhere = site.open()
    port = site.url.rpartition(":")[2]
    elsewhere.url = f"http://127.0.0.1:{port}"
    log_in(elsewhere)
    elsewhere.page.wait_for_url(f"{elsewhere.url}/")
    without_scripts = site.open(user="anna", javascript=False)
    for page in (elsewhere, without_scripts):
        page.goto("/account")
        expect(page.page.get_by_text(NOT_HERE)).to_contain_text(site.url)
        expect(page.page.get_by_role("button", name="Add a passkey")).to_have_count(0)
        page.goto("/login")
        expect(page.page.get_by_role("button", name=WITH_PASSKEY)).to_have_count(0)
        expect(page.page.get_by_role("button", name="Log in", exact=True)).to_be_visible()
