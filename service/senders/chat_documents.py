"""Messages as chat services take them. Names and notes in them are shown as they are, never as markup."""

from collections.abc import Mapping

from service.senders.message import Message

LONGEST_TEXT = 3000
"""Both services refuse or cut longer ones."""


def slack_document(message: Message) -> Mapping[str, object]:
    """Return the body of an incoming webhook of Slack, or of Mattermost and others that take the same."""
    return {"text": f"{_escaped(message.subject)}\n{_escaped(message.text[:LONGEST_TEXT])}", "mrkdwn": False}


def teams_document(message: Message) -> Mapping[str, object]:
    """Return the body of a webhook of Teams (a workflow that posts an adaptive card)."""
    title = {"type": "TextRun", "text": message.subject, "weight": "bolder"}
    body = [{"type": "RichTextBlock", "inlines": [title]}]
    body += [
        {"type": "RichTextBlock", "inlines": [{"type": "TextRun", "text": line}]}
        for line in message.text[:LONGEST_TEXT].splitlines()
        if line.strip()
    ]
    card = {
        "$schema": "http://adaptivecards.io/schemas/adaptive-card.json",
        "type": "AdaptiveCard",
        "version": "1.4",
        "body": body,
    }
    content_type = "application/vnd.microsoft.card.adaptive"
    return {"type": "message", "attachments": [{"contentType": content_type, "content": card}]}


def _escaped(text: str) -> str:
    """Return a text in which nothing names a channel, a person or a link."""
    return text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")
