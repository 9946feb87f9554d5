"""A service as a process tells of its alarms: `mcc notify test`, and a mail for relays that do not answer."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from service.client.rest_client import ServiceClient
from testing.service.processes import running_service, switched_off_plant
from testing.service.receivers import mail_server
from testing.waiting import wait_until
from tests.service.notifications.conftest import mail_channel


@pytest.mark.campaign
@pytest.mark.timeout(300)
def test_a_service_sends_tests_and_alarms(tmp_path: Path) -> None:
    with mail_server() as mailbox:
        table = {
            "gather_s": 0.5,
            "channels": {"shift": mail_channel(mailbox.port)},
            "routes": [{"channels": ["shift"], "kinds": ["link-down", "site-lost", "alarm-flood"]}],
        }
        settings = {
            "MCC_NOTIFICATIONS": json.dumps(table),
            "MCC_ALARMS": '{"link_down_s": 1}',
            "MCC_CONNECT_TIMEOUT_S": "0.5",
        }
        with running_service(tmp_path, switched_off_plant(tmp_path), **settings) as service:
            others = {name: value for name, value in os.environ.items() if not name.startswith("MCC_")}
            asked = subprocess.run(
                [sys.executable, "-m", "service.cli", "notify", "test", "--url", service.url],
                env=others,
                capture_output=True,
                text=True,
                check=False,
            )
            assert (asked.returncode, asked.stdout) == (0, "shift: shift@plant.example: sent\n"), asked.stderr
            wait_until(lambda: len(mailbox.mails) >= 2, "a mail about the relays")
            with ServiceClient(service.url) as client:
                sent = list(client.items("/notifications", state="sent"))
        assert {one["kind"] for one in sent} >= {"test", "alarms"}
        assert "FACTORY" in str(mailbox.mails[1]["Subject"])
