"""Apprise, with its own plug-in for an HTTP server of ours."""

import json

import pytest

from service.configuration.channels import AppriseChannel
from service.senders.errors import SendError
from service.senders.message import Message
from service.senders.sending import send
from testing.service.receivers import http_receiver

pytestmark = pytest.mark.filterwarnings("ignore:'imghdr' is deprecated")
"""Said of a module that Apprise imports."""

CHANNEL = AppriseChannel.model_validate({"kind": "apprise"})


def test_every_address_gets_the_message(message: Message, monkeypatch: pytest.MonkeyPatch) -> None:
    with http_receiver() as receiver:
        monkeypatch.setenv(
            "MCC_NOTIFY_URLS_CHAT",
            f"# two\njson://127.0.0.1:{receiver.port}/a\njson://127.0.0.1:{receiver.port}/b\n",
        )
        send("chat", CHANNEL, "", message)
        assert sorted(posted.path for posted in receiver.requests) == ["/a", "/b"]
        assert "shorted" not in json.loads(receiver.requests[0].body)["title"]
        receiver.statuses = [500, 500]
        with pytest.raises(SendError, match="did not take the message, says Apprise"):
            send("chat", CHANNEL, "", message)


def test_an_address_that_is_none_is_not_shown(message: Message, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MCC_NOTIFY_URLS_CHAT", "nothing://S3CR3T")
    with pytest.raises(SendError, match="line 1 of its addresses") as refused:
        send("chat", CHANNEL, "", message)
    assert "S3CR3T" not in str(refused.value)
    monkeypatch.delenv("MCC_NOTIFY_URLS_CHAT")
    with pytest.raises(SendError, match="expected urls_file, or the variable MCC_NOTIFY_URLS_CHAT"):
        send("chat", CHANNEL, "", message)
