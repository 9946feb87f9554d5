"""TLS towards receivers: their certificates are always checked."""

import ssl
from pathlib import Path

from service.senders.errors import SendError


def client_context(
    ca: Path | None = None, certificate: Path | None = None, key: Path | None = None
) -> ssl.SSLContext:
    """Return the context of a client. ca: the authorities that count; None: those of this machine.

    Raises SendError for files that cannot be used.
    """
    try:
        context = ssl.create_default_context(cafile=None if ca is None else str(ca))
        context.minimum_version = ssl.TLSVersion.TLSv1_2
        if certificate is not None:
            context.load_cert_chain(certificate, key)
    except (OSError, ssl.SSLError) as error:
        files = ", ".join(str(path) for path in (ca, certificate, key) if path is not None)
        raise SendError(f"{files}: expected certificates and a key (PEM), found: {error}") from error
    return context
