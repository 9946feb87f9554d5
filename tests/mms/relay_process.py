"""`python -m tests.mms.relay_process FILE_ROOT`: a relay; prints its port and serves until its input ends."""

import sys
from pathlib import Path

from tests.mms.relays import start_relay


def main() -> None:
    with start_relay(file_root=Path(sys.argv[1])) as server:
        print(server.port, flush=True)  # noqa: T201 (the parent reads it)
        sys.stdin.read()


if __name__ == "__main__":
    main()
