"""The pictures of the pages that stand in the documentation."""

import io
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from PIL import Image

from testing.web.site import DESKTOP, PHONE, Screen
from testing.web.watched_page import WatchedPage

COLOURS = 128
"""Of a picture in the repository; charts and text need no more."""

FAULTY = "FAN-A2"


@dataclass(frozen=True, slots=True)
class Picture:
    """A page as it is shown. part: what is in the middle of the picture; None for the top of the page."""

    name: str
    path: str
    screen: Screen = DESKTOP
    dark: bool = False
    part: str | None = None


def pictures(recording: str, alarm: str) -> Sequence[Picture]:
    """Return the pictures of a demo whose month is over."""
    return (
        Picture("fleet", "/"),
        Picture("fleet-dark", "/", dark=True),
        Picture("fleet-phone", "/", PHONE),
        Picture("motor", f"/motors/{FAULTY}"),
        Picture("motor-phone", f"/motors/{FAULTY}", PHONE),
        Picture("recording", recording),
        Picture("recording-phone", recording, PHONE),
        Picture("alarms", "/alarms"),
        Picture("alarm", alarm),
        Picture("relays", "/relays"),
        Picture("plant", "/plant"),
        Picture("reports", "/reports"),
    )


def take_pictures(desktop: WatchedPage, phone: WatchedPage, folder: Path) -> None:
    """Write the pictures of a plant, with pages of it that are logged in."""
    folder.mkdir(parents=True, exist_ok=True)
    desktop.goto(f"/motors/{FAULTY}")
    recording = _first(desktop, "/recordings/")
    desktop.goto("/alarms")
    alarm = _first(desktop, "/alarms/")
    for picture in pictures(recording, alarm):
        take(phone if picture.screen == PHONE else desktop, picture, folder)


def take(page: WatchedPage, picture: Picture, folder: Path) -> None:
    """Write one picture."""
    width, height = picture.screen
    page.page.set_viewport_size({"width": width, "height": height})
    page.page.emulate_media(color_scheme="dark" if picture.dark else "light", reduced_motion="reduce")
    page.goto(picture.path)
    page.page.wait_for_function("() => document.documentElement.dataset.ready === 'true'")
    page.page.wait_for_timeout(500)  # charts are drawn when the browser is idle
    shot = Image.open(io.BytesIO(page.page.screenshot()))
    shot.convert("RGB").quantize(COLOURS).save(folder / f"{picture.name}.png", optimize=True)


def _first(page: WatchedPage, beginning: str) -> str:
    """Return the address of the first link that begins so and leads to one thing."""
    links = page.page.locator(f"main a[href^='{beginning}']")
    address = links.first.get_attribute("href")
    assert address is not None
    return address
