"""Relays' passwords and keys with a real service, simulator and gateway: nothing tells them."""

import base64
import json
import os
import re
import signal
import sqlite3
from pathlib import Path

import httpx
import pytest

from service.client.credentials import headers_for
from service.client.rest_client import ServiceClient
from service.configuration.relay_access import PASSWORD_VARIABLE
from testing.relays.pki import Pki
from testing.service.processes import (
    Service,
    all_recordings,
    descendants,
    link_states,
    running_service,
    simulated_plant,
)
from testing.waiting import eventually

pytestmark = pytest.mark.timeout(300)

IN_FILE = "Zx9-in-the-file-Zx9"
IN_ENVIRONMENT = "Qy8-in-the-environment-Qy8"
WRONG = "Wv7-the-wrong-one-Wv7"
MOTOR = """
[[motor]]
ied = "{ied}"
[motor.access]
password_file = "{ied}.password"
"""
OF_RELAY = (
    'tls = {certificate = "relay.pem", key = "relay.key", ca = "authority.pem", pinned = ["client.pem"]}\n'
)


def write_secret(path: Path, content: str) -> Path:
    path.touch(mode=0o600)
    path.write_text(f"{content}\n")
    return path


def write_scenario(folder: Path) -> Path:
    """A1 wants TLS and the password of the file, A2 that of the environment."""
    write_secret(folder / "A1_SEL710.password", IN_FILE)
    write_secret(folder / "A2_SEL710.password", IN_ENVIRONMENT)
    path = folder / "scenario.toml"
    path.write_text(MOTOR.format(ied="A1_SEL710") + OF_RELAY + MOTOR.format(ied="A2_SEL710"))
    return path


def relays_setting(pki: Pki, password: Path) -> str:
    tls = {
        "certificate": str(pki.client.certificate_file),
        "key": str(pki.client.key_file),
        "ca": str(pki.authority.certificate_file),
        "pinned": [str(pki.relay.certificate_file)],
    }
    return json.dumps({"A1_SEL710": {"tls": tls, "password_file": str(password)}})


def answers(service: Service) -> list[str]:
    """Everything the API tells at paths without an argument, and at those of A1_SEL710."""
    with httpx.Client(
        base_url=service.url, headers=headers_for(service.url), trust_env=False, timeout=30
    ) as http:
        paths = http.get("/api/v1/openapi.json").raise_for_status().json()["paths"]
        asked = [path for path, methods in paths.items() if "get" in methods]
        named = [re.sub(r"\{\w+\}", "A1_SEL710", path) for path in asked]
        return [http.get(path).text for path in ("/api/v1/openapi.json", *named)]


def reason(client: ServiceClient) -> str:
    """Why the link of A1_SEL710 is down."""
    return str(client.get("/ieds/A1_SEL710")["link_reason"])


def kill_gateway(service: Service) -> None:
    """Its successor reads everything anew."""
    (gateway,) = [
        process_id
        for process_id in descendants(service.process_id)
        if b"service.collector" in Path(f"/proc/{process_id}/cmdline").read_bytes()
    ]
    os.kill(gateway, signal.SIGKILL)


def test_secrets_let_in_and_are_told_nowhere(tmp_path: Path) -> None:
    folder = tmp_path / "access"
    folder.mkdir()
    pki = Pki.make(folder)
    password = write_secret(tmp_path / "password", IN_FILE)
    settings = {
        "MCC_RELAYS": relays_setting(pki, password),
        f"{PASSWORD_VARIABLE}A2_SEL710": IN_ENVIRONMENT,
        "MCC_POLL_PERIOD_S": "0.5",
        "MCC_METERING_PERIOD_S": "0",
    }
    with (
        simulated_plant(tmp_path, ("A1_SEL710", "A2_SEL710"), write_scenario(folder)) as plant,
        running_service(tmp_path, plant.scd, **settings) as service,
        ServiceClient(service.url) as client,
    ):
        both = ("A1_SEL710", "A2_SEL710")
        assert eventually(lambda: all(link_states(client)[name] == "up" for name in both), 30)
        for motor in ("PUMP-A1", "FAN-A2"):
            client.request_recording(motor)
        assert eventually(lambda: len(stored(client)) == 2, 60)

        write_secret(password, WRONG)
        kill_gateway(service)
        assert eventually(lambda: "rejects the association: expected the password" in reason(client), 40)
        pki.client.key_file.chmod(0o644)
        assert eventually(lambda: f"chmod 600 {pki.client.key_file}" in reason(client), 40)

        told = answers(service)
        assert any("chmod 600" in answer for answer in told)
        commands = [
            Path(f"/proc/{process_id}/cmdline").read_text()
            for process_id in (service.process_id, *descendants(service.process_id))
        ]
        assert len(commands) >= 3
    log = service.log.read_text()
    assert "password goes over the network in clear" in log
    simulators = (tmp_path / "ied-sim.log").read_text()
    assert "TLS: " not in log + simulators, "the library's notes"
    dump = "\n".join(sqlite3.connect(service.data / "statorwatch.sqlite").iterdump())
    assert "chmod 600" in dump, "the link's reason is there"
    files = [path.read_bytes() for path in service.data.rglob("*") if path.is_file()]
    everything = [*(text.encode() for text in (*told, *commands, log, simulators, dump)), *files]
    for secret in secrets(pki):
        assert not [place[:200] for place in everything if secret in place]


def stored(client: ServiceClient) -> list[object]:
    states = [each["state"] for each in all_recordings(client)]
    return [state for state in states if state in ("fetched", "diagnosed")]


def secrets(pki: Pki) -> list[bytes]:
    """The passwords, also as JSON or base64 would write them, and a line of the key."""
    passwords = [each.encode() for each in (IN_FILE, IN_ENVIRONMENT, WRONG)]
    key_line = pki.client.key_file.read_bytes().splitlines()[1]
    return [*passwords, *(base64.b64encode(each).rstrip(b"=") for each in passwords), key_line]
