"""Have the relay of a motor make a recording, and wait for the verdict.

pip install ./client
python examples/trigger_and_wait.py http://127.0.0.1:8710 PUMP-A1 [TOKEN-FILE]
"""

import sys
import time
from pathlib import Path
from uuid import uuid4

from statorwatch_client import Client, ProblemError

POLL_PERIOD_S = 0.5
PATIENCE_S = 120.0


def main() -> None:
    url, motor, *token_file = sys.argv[1:]
    token = Path(token_file[0]).read_text().strip() if token_file else None
    with Client(url, token=token) as service:
        try:
            # With the same key again, e.g. after a broken connection, nothing new is requested.
            request = service.request_event_report(motor, idempotency_key=str(uuid4()))
        except ProblemError as error:
            sys.exit(f"refused with HTTP status {error.status}: {error}")
        deadline_s = time.monotonic() + PATIENCE_S
        while request["state"] not in ("diagnosed", "failed", "skipped") and time.monotonic() < deadline_s:
            time.sleep(POLL_PERIOD_S)
            request = service.get_event_report(request["id"])
        if request["state"] != "diagnosed" or request["recording_id"] is None:
            sys.exit(f"{motor}: {request['state']}: {request['reason'] or 'no verdict in time'}")
        diagnosis = service.get_recording(request["recording_id"])["diagnosis"]
        if diagnosis is not None:
            level = "" if diagnosis["mu_f"] is None else f", {diagnosis['mu_f']:.3%} of the turns"
            print(f"{motor}: {diagnosis['verdict']} {diagnosis['phase'] or ''}".rstrip() + level)
        with service.download_recording(request["recording_id"]) as archive:
            print(f"{archive.name}: {len(archive.read())} bytes")


if __name__ == "__main__":
    main()
