"""`python -m testing.relays.process FILE_ROOT [CERTIFICATES]`: a relay, over TLS with a Pki's certificates.

It prints its port and serves until its input ends.
"""

import sys
from pathlib import Path

from mms import TlsConfiguration
from testing.relays.serving import start_relay


def main() -> None:
    tls = None
    if len(sys.argv) > 2:
        folder = Path(sys.argv[2])
        tls = TlsConfiguration(
            certificate=folder / "relay.pem",
            key=folder / "relay.key",
            pinned=(folder / "client.pem",),
            ca=folder / "authority.pem",
        )
    with start_relay(file_root=Path(sys.argv[1]), tls=tls) as server:
        print(server.port, flush=True)  # noqa: T201 (the parent reads it)
        sys.stdin.read()


if __name__ == "__main__":
    main()
