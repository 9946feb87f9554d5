"""`mcc notify test`: a message through each channel, and whether its receivers took it."""

import time
from collections.abc import Sequence

from rich.text import Text

from core.error_words import one_line
from service.cli.output import DONE, FAILED, CommandError, failing_clearly, print_document, results
from service.client.rest_client import Document, ServiceClient, ServiceError

POLL_PERIOD_S = 0.2
ENDED = ("sent", "dead", "withdrawn")


def send_tests(url: str, channels: Sequence[str], *, wait_s: float, as_json: bool) -> int:
    """Send a test through channels, or through all of them, and tell what came of it.

    Returns the exit code: 1 where a receiver did not take it within the time. Raises CommandError.
    """
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        names = list(channels) or [str(one["name"]) for one in service.list_channels()]
        if not names:
            raise CommandError("the settings have no [notifications.channels]: nobody is told")
        tests: list[Document] = []
        for name in names:
            tests += service.send_test(name)
        ended = _followed(service, tests, wait_s)
    if as_json:
        print_document({"notifications": ended})
    else:
        for one in ended:
            results().print(_line(one), soft_wrap=True)
    return DONE if all(one["state"] == "sent" for one in ended) else FAILED


def _followed(service: ServiceClient, tests: Sequence[Document], wait_s: float) -> list[Document]:
    """Return what became of tests within a time. Raises ServiceError."""
    deadline_s = time.monotonic() + wait_s
    found = list(tests)
    while True:
        found = [
            one
            if one["state"] in ENDED
            else {
                key: value for key, value in service.get_notification(str(one["id"])).items() if key != "told"
            }
            for one in found
        ]
        if all(one["state"] in ENDED for one in found) or time.monotonic() >= deadline_s:
            return found
        time.sleep(POLL_PERIOD_S)


def _line(test: Document) -> Text:
    receiver = f"{test['channel']}: {test['recipient']}" if test["recipient"] else str(test["channel"])
    if test["state"] == "sent":
        return Text(one_line(f"{receiver}: sent"), style="green")
    why = test["error"] or "not sent yet; mcc notify list shows what comes of it"
    return Text(one_line(f"{receiver}: {why}"), style="red")
