"""The example of a receiver takes what the service sends, once, and nothing else."""

import base64
import os
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest

from examples.webhook_receiver import NotOursError, checked, key_of
from service.configuration.channels import WebhookChannel
from service.senders.message import Message
from service.senders.sending import send
from service.senders.webhook import signature_headers

EXAMPLE = Path(__file__).parents[2] / "examples" / "webhook_receiver.py"
SECRET = f"whsec_{base64.b64encode(bytes(range(32))).decode()}"
BODY = b'{"type": "test"}'
NOW_S = 1_760_000_000


@pytest.fixture
def receiver() -> Iterator[tuple["subprocess.Popen[str]", str]]:
    """The example at a free port, and its address."""
    environment = {**os.environ, "WEBHOOK_SECRET": SECRET}
    command = [sys.executable, str(EXAMPLE), "0"]
    with subprocess.Popen(
        command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
    ) as process:
        assert process.stdout is not None
        yield process, process.stdout.readline().removeprefix("listening at ").strip()
        process.kill()


def test_it_prints_a_message_once(
    receiver: tuple["subprocess.Popen[str]", str], monkeypatch: pytest.MonkeyPatch
) -> None:
    process, url = receiver
    channel = WebhookChannel.model_validate({"kind": "webhook", "url": url})
    monkeypatch.setenv("MCC_NOTIFY_SECRET_CMMS", SECRET)
    for name in ("a1", "a1", "b2"):
        document = {"type": "test", "subject": f"message {name}"}
        send("cmms", channel, "", Message(name, 0, "info", "", "", (), document))
    forged = httpx.post(url, content=BODY, headers=signature_headers("c3", int(time.time()), BODY, b"x" * 32))
    assert forged.status_code == 401
    process.kill()
    assert process.stdout is not None
    assert process.stdout.read() == "test: message a1\ntest: message b2\n"


@pytest.mark.parametrize(
    "change",
    [
        {"webhook-id": "other"},
        {"webhook-timestamp": str(NOW_S + 1)},
        {"webhook-timestamp": "٣"},
        {"webhook-timestamp": ""},
        {"webhook-signature": ""},
        {"webhook-signature": "v1,AAAA v1a,BBBB"},
    ],
)
def test_what_was_changed_on_its_way_is_refused(change: dict[str, str]) -> None:
    key = key_of(SECRET)
    headers = dict(signature_headers("a1", NOW_S, BODY, key))
    assert checked(key, headers, BODY, NOW_S + 299) == "a1"
    with pytest.raises(NotOursError):
        checked(key, {**headers, **change}, BODY, NOW_S)
    with pytest.raises(NotOursError, match="signature"):
        checked(key, headers, BODY + b" ", NOW_S)
    with pytest.raises(NotOursError, match="within 300 s"):
        checked(key, headers, BODY, NOW_S + 301)
