"""One attempt to send a message, through whichever kind of channel."""

import asyncio

from core.error_words import one_line
from service.configuration.channel_secrets import ChannelSecretError
from service.configuration.channels import (
    AppriseChannel,
    Channel,
    CommandChannel,
    MailChannel,
    SyslogChannel,
    WebhookChannel,
)
from service.senders.apprise import send_by_apprise
from service.senders.command import run_command
from service.senders.errors import SendError
from service.senders.mail import send_mail
from service.senders.message import Message
from service.senders.syslog import send_syslog
from service.senders.webhook import post_webhook

LONGEST_REASON = 500


def recipients(channel: Channel) -> tuple[str, ...]:
    """Return to whom a channel sends separately: mail addresses; other kinds have one receiver, ""."""
    return channel.to if isinstance(channel, MailChannel) else ("",)


def send(name: str, channel: Channel, recipient: str, message: Message) -> None:
    """Send a message within the channel's time. Raises SendError."""
    try:
        asyncio.run(_send_in_time(name, channel, recipient, message))
    except ChannelSecretError as error:
        raise SendError(str(error)) from error
    except SendError as error:
        raise SendError(one_line(str(error))[:LONGEST_REASON], is_final=error.is_final) from error


async def _send_in_time(name: str, channel: Channel, recipient: str, message: Message) -> None:
    try:
        async with asyncio.timeout(channel.timeout_s):
            await _send(name, channel, recipient, message)
    except TimeoutError as error:
        raise SendError(f"no answer within {channel.timeout_s:g} s") from error


async def _send(name: str, channel: Channel, recipient: str, message: Message) -> None:
    match channel:
        case MailChannel():
            await send_mail(name, channel, recipient, message)
        case WebhookChannel():
            await post_webhook(name, channel, message)
        case SyslogChannel():
            await send_syslog(channel, message)
        case CommandChannel():
            await run_command(channel, message)
        case AppriseChannel():
            await send_by_apprise(name, channel, message)
