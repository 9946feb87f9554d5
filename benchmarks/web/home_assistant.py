"""Home Assistant with its demo: a peer that runs beside our pages.

python -m venv DIR && DIR/bin/pip install homeassistant==2024.3.3 home-assistant-frontend 'josepy<2'
python -m benchmarks.web --home-assistant DIR/bin/hass
"""

import json
import subprocess
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import httpx
from playwright.sync_api import BrowserContext, Page

from testing.ports import free_port
from testing.waiting import wait_until

LOOPBACK = "127.0.0.1"
DEVICE = "Office RGBW Lights"
"""One of its demo's."""

START_S = 300.0
"""The first start installs what the demo's integrations need."""

CONFIGURATION = """\
homeassistant:
  name: Plant
http:
  server_host: {host}
  server_port: {port}
config:
frontend:
history:
logbook:
demo:
"""


@dataclass(frozen=True, slots=True)
class Peer:
    """A running Home Assistant, and what a browser keeps in order to be logged in."""

    url: str
    tokens: str

    def enter(self, window: BrowserContext) -> None:
        """Log a browser in before its first page."""
        window.add_init_script(f"localStorage.setItem('hassTokens', {json.dumps(self.tokens)})")

    def path_of_device(self, page: Page, name: str) -> str:
        """Return the path of a device's page, as the list of devices links to it. page: logged in."""
        page.goto(f"{self.url}/config/devices/dashboard")
        page.get_by_text(name, exact=True).first.click()
        page.wait_for_url("**/config/devices/device/*")
        return page.url.removeprefix(self.url)


@contextmanager
def serving_home_assistant(command: Path) -> Iterator[Peer]:
    """Run Home Assistant with a new configuration and one user, until its demo has states."""
    port = free_port()
    url = f"http://{LOOPBACK}:{port}"
    with TemporaryDirectory(prefix="statorwatch-peer-") as name:
        folder = Path(name)
        (folder / "configuration.yaml").write_text(CONFIGURATION.format(host=LOOPBACK, port=port))
        with (folder / "log").open("wb") as log:
            process = subprocess.Popen([command, "--config", folder], stdout=log, stderr=log)
        try:
            with httpx.Client(base_url=url, trust_env=False, timeout=60.0) as client:
                wait_until(lambda: _answers(client), "Home Assistant", START_S)
                tokens = _first_user(client)
                bearer = {"Authorization": f"Bearer {tokens['access_token']}"}
                wait_until(lambda: _states(client, bearer) > 20, "the states of its demo", START_S)
            yield Peer(url, json.dumps(tokens))
        finally:
            process.terminate()
            process.wait(60)


def _answers(client: httpx.Client) -> bool:
    try:
        return client.get("/api/onboarding").is_success
    except httpx.TransportError:
        return False


def _states(client: httpx.Client, headers: Mapping[str, str]) -> int:
    return len(client.get("/api/states", headers=headers).raise_for_status().json())


def _first_user(client: httpx.Client) -> Mapping[str, Any]:
    """Go through the steps of the first start; return the tokens as the browser's page keeps them."""
    us = f"{client.base_url}/"
    user = {"client_id": us, "name": "Ada", "username": "ada", "password": "lovelace", "language": "en"}
    code = client.post("/api/onboarding/users", json=user).raise_for_status().json()["auth_code"]
    asked = {"client_id": us, "grant_type": "authorization_code", "code": code}
    tokens = client.post("/auth/token", data=asked).raise_for_status().json()
    headers = {"Authorization": f"Bearer {tokens['access_token']}"}
    for step in ("core_config", "analytics"):
        client.post(f"/api/onboarding/{step}", headers=headers).raise_for_status()
    last = {"client_id": us, "redirect_uri": us}
    client.post("/api/onboarding/integration", headers=headers, json=last).raise_for_status()
    expires_ms = 1000 * (time.time() + tokens["expires_in"])
    return {**tokens, "hassUrl": us.rstrip("/"), "clientId": us, "expires": expires_ms}
