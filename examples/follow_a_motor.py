"""A motor from Python: its trend, and with --record a recording now and its verdict.

    python examples/follow_a_motor.py http://127.0.0.1:8710 PUMP-A1 statorwatch.token [--record]

It needs the package statorwatch-client (statorwatch brings it along) and nothing else. Without access
control any file will do for the token.
"""

import sys
import time
from pathlib import Path

from statorwatch_client import Client

LONGEST_S = 120.0


def print_trend(plant: Client, motor: str) -> None:
    for point in plant.iter_trend(motor, limit=1000):
        print(point["time"], point["value"], point["verdict"], sep="\t")


def record(plant: Client, motor: str) -> str:
    """Have a recording made, and return its verdict, or why there is none."""
    request = plant.request_event_report(motor)
    until_s = time.monotonic() + LONGEST_S
    while request["state"] not in ("diagnosed", "failed", "skipped"):
        if time.monotonic() > until_s:
            return f"no verdict within {LONGEST_S:g} s, so far {request['state']}"
        time.sleep(0.5)
        request = plant.get_event_report(request["id"])
    if request["recording_id"] is None:
        return f"{request['state']}: {request['reason']}"
    diagnosis = plant.get_recording(request["recording_id"])["diagnosis"]
    return "not diagnosed" if diagnosis is None else diagnosis["verdict"]


def main() -> None:
    url, motor, token_file, *wishes = sys.argv[1:]
    with Client(url, token=Path(token_file).read_text(encoding="utf-8").strip()) as plant:
        print_trend(plant, motor)
        if "--record" in wishes:
            print(f"{motor}: {record(plant, motor)}")


if __name__ == "__main__":
    main()
