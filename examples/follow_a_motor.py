"""A motor from Python: its trend as rows, and a recording now with its verdict.

    python examples/follow_a_motor.py http://127.0.0.1:8710 PUMP-A1 [statorwatch.token]

It needs the package statorwatch-client (or statorwatch, which brings it along) and nothing else.
"""

import sys
import time
from pathlib import Path

from statorwatch_client import Client

LONGEST_S = 120.0
ENDED = ("diagnosed", "failed", "skipped")


def main(url: str, motor: str, token_file: str | None = None) -> int:
    token = None if token_file is None else Path(token_file).read_text(encoding="utf-8").strip()
    with Client(url, token=token) as plant:
        for point in plant.iter_trend(motor, limit=1000):
            print(point["time"], point["value"], point["verdict"], sep="\t")
        request = plant.request_event_report(motor)
        until_s = time.monotonic() + LONGEST_S
        while request["state"] not in ENDED and time.monotonic() < until_s:
            time.sleep(0.5)
            request = plant.get_event_report(request["id"])
        if request["state"] != "diagnosed" or request["recording_id"] is None:
            print(f"{motor}: {request['state']}: {request['reason']}")
            return 1
        diagnosis = plant.get_recording(request["recording_id"])["diagnosis"]
        print(f"{motor}: {'no diagnosis' if diagnosis is None else diagnosis['verdict']}")
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
