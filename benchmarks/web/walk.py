"""The way of a newcomer through the demo: python -m benchmarks.web.walk [--pictures DIR].

It starts `mcc demo`, opens the link that the demo prints first, and goes to what has to be done, on a desktop
and, when the month is over, with the next link on a phone. With --pictures it takes the pictures of the
documentation in between.
"""

import argparse
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

from benchmarks.reporting import table
from benchmarks.web.pictures import take_pictures
from testing.web.chromium import INSTALL, chromium_path, running_browser
from testing.web.demo_walk import (
    PAGE,
    Walk,
    find_what_to_do,
    follow,
    look_at_every_page,
    on_a_phone,
    running_demo,
)
from testing.web.site import DESKTOP, PHONE


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--pictures", type=Path, help="write the pictures of the documentation here")
    arguments = parser.parse_args()
    path = chromium_path()
    if path is None:
        sys.exit(f"no chromium: {INSTALL}")
    begun_s = time.monotonic()
    with (
        TemporaryDirectory(prefix="statorwatch-walk-") as data,
        running_browser(path) as browser,
        running_demo(Path(data)) as demo,
    ):
        printed_s = time.monotonic()
        print(f"the first line after {time.monotonic() - begun_s:.1f} s: {demo.first_line}", flush=True)
        desktop = Walk()
        page = follow(browser, demo.first_line.removeprefix(PAGE), DESKTOP)
        desktop.step("the link of the first line opens the first page, logged in", clicks=1)
        name = find_what_to_do(page, desktop)
        _print("Desktop", desktop)
        opened = look_at_every_page(page, name)
        seconds = time.monotonic() - printed_s
        print(f"each of {len(opened)} pages shows something {seconds:.0f} s after the first line")
        link = demo.next_link()  # the demo prints it when the month is over
        if arguments.pictures is not None:  # before the phone's walk takes notice of the alarm that they show
            with on_a_phone(browser, page) as small:
                take_pictures(page, small, arguments.pictures)
        phone = Walk()
        small = follow(browser, link, PHONE)
        phone.step("the link opens the first page, logged in", clicks=1)
        find_what_to_do(small, phone)
        _print("Phone, 360 px", phone)


def _print(title: str, walk: Walk) -> None:
    rows: list[Sequence[str]] = [
        (f"{number}. {step.words}", str(step.clicks), f"{step.seconds:.1f} s")
        for number, step in enumerate(walk.steps, 1)
    ]
    rows.append(("in all", str(walk.clicks), f"{walk.seconds:.1f} s"))
    print(f"\n{title}\n" + "\n".join(table(("Step", "Clicks", "Time"), rows)), flush=True)


if __name__ == "__main__":
    main()
