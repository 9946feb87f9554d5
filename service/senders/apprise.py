"""Whatever else Apprise reaches: over a hundred services, by addresses in a file (extra `notify`)."""

import logging

from service.configuration.channel_secrets import urls
from service.configuration.channels import AppriseChannel
from service.senders.errors import SendError
from service.senders.message import Message

LONGEST_BODY = 3000
MISSING = 'expected the Python package apprise, found none: pip install "statorwatch[notify]"'


async def send_by_apprise(name: str, channel: AppriseChannel, message: Message) -> None:
    """Send a message to each address of the channel. Raises SendError, ChannelSecretError."""
    try:
        import apprise
    except ModuleNotFoundError as error:
        raise SendError(f"channel {name}: {MISSING}") from error
    logging.getLogger("apprise").setLevel(logging.CRITICAL)  # its lines show parts of the addresses
    known = apprise.Apprise()
    for number, url in enumerate(urls(name, channel), start=1):
        if not known.add(url):
            raise SendError(f"channel {name}: line {number} of its addresses is none that Apprise knows")
    kind = apprise.NotifyType.FAILURE if message.severity == "critical" else apprise.NotifyType.WARNING
    if message.severity == "info":
        kind = apprise.NotifyType.INFO
    sent = await known.async_notify(
        title=message.subject,
        body=message.text[:LONGEST_BODY],
        notify_type=kind,
        body_format=apprise.NotifyFormat.TEXT,
        interpret_escapes=False,
    )
    if not sent:
        raise SendError(f"channel {name}: one of its services did not take the message, says Apprise")
