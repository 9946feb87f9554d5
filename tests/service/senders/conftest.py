import ssl
from collections.abc import Mapping
from pathlib import Path

import pytest

from service.senders.message import Line, Message
from testing.relays.certificates import Identity, identity

HOSTILE = 'P-101\r\nBcc: victim@evil.example <script>alert("1")</script> 漢字'
PICTURE = b"\x89PNG\r\n\x1a\n picture"


@pytest.fixture
def message() -> Message:
    """A message whose every text somebody hostile has written."""
    document: Mapping[str, object] = {"id": "0b1c", "type": "alarms", "subject": HOSTILE}
    return Message(
        id="0b1c",
        created_ns=1_760_000_000_123_456_789,
        severity="high",
        subject=f"[high] {HOSTILE}",
        text=f"{HOSTILE}\n.\nfrom the winding\n",
        html='<p>escaped</p><img src="cid:trend">',
        pictures={"trend": PICTURE},
        lines=(Line(f"{HOSTILE}: shorted turns", "high", {"alarm": "a1", "motor": 'P"]\\101\n'}),),
        document=document,
        thread="a1",
    )


@pytest.fixture
def authority(tmp_path: Path) -> Identity:
    return identity(tmp_path, "authority", authority=True)


@pytest.fixture
def server_context(tmp_path: Path, authority: Identity) -> ssl.SSLContext:
    own = identity(tmp_path, "server", issuer=authority)
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.load_cert_chain(own.certificate_file, own.key_file)
    return context
