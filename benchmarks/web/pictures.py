"""The pictures of the pages that stand in the documentation."""

import io
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from PIL import Image

from testing.web.site import DESKTOP, LONGEST_MS, PHONE, Screen
from testing.web.watched_page import WatchedPage

COLOURS = 128
"""Of a picture in the repository; charts and text need no more."""

FAULTY = "FAN-A2"


@dataclass(frozen=True, slots=True)
class Picture:
    """A page as it is shown.

    part: selector of what the picture is of; None for the top of the page.  onwards: the part and what is
    below it, as much as the screen shows; otherwise the part alone, all of it.
    """

    name: str
    path: str
    screen: Screen = DESKTOP
    dark: bool = False
    part: str | None = None
    onwards: bool = False


def pictures(recording: str, alarm: str, starts: str | None) -> Sequence[Picture]:
    """Return the pictures of a demo whose month is over. starts: page of a motor that was seen to start."""
    motor = f"/motors/{FAULTY}"
    return (
        Picture("fleet", "/"),
        Picture("fleet-dark", "/", dark=True),
        Picture("fleet-phone", "/", PHONE),
        Picture("motor", motor),
        Picture("motor-trend", motor, part="#trend"),
        Picture("motor-pictures", f"{motor}/stator", part="#pictures"),
        *([] if starts is None else [Picture("motor-starts", starts, part="#curves")]),
        Picture("motor-phone", motor, PHONE),
        Picture("motor-phone-trend", motor, PHONE, part="#trend", onwards=True),
        Picture("recording", recording),
        Picture("recording-model", recording, part="#model"),
        Picture("recording-phasors", recording, part="section[aria-labelledby='phasors-heading']"),
        Picture("recording-spectrum", recording, part="section[aria-labelledby='spectrum-heading']"),
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
    desktop.goto(f"/motors/{FAULTY}/recordings")
    recording = _first(desktop, "/recordings/")
    desktop.goto("/alarms")
    alarm = _first(desktop, "/alarms/")
    starts = _starts(desktop)
    if starts is None:
        print("no motor of the plant was seen to start from rest: no picture of starts")
    for picture in pictures(recording, alarm, starts):
        take(phone if picture.screen == PHONE else desktop, picture, folder)


def take(page: WatchedPage, picture: Picture, folder: Path) -> None:
    """Write one picture."""
    width, height = picture.screen
    page.page.set_viewport_size({"width": width, "height": height})
    page.page.emulate_media(color_scheme="dark" if picture.dark else "light", reduced_motion="reduce")
    page.goto(picture.path)
    page.page.wait_for_function("() => document.documentElement.dataset.ready === 'true'", timeout=LONGEST_MS)
    alone = picture.part is not None and not picture.onwards
    page.page.wait_for_function(DRAWN, arg=picture.part if alone else None, timeout=LONGEST_MS)
    part = page.page.locator(picture.part or "main").first
    if picture.part is not None:
        part.evaluate("(part) => part.scrollIntoView({ block: 'start', behavior: 'instant' })")
    shot = Image.open(io.BytesIO(part.screenshot() if alone else page.page.screenshot()))
    shot.convert("RGB").quantize(COLOURS).save(folder / f"{picture.name}.png", optimize=True)


DRAWN = """(part) => {
    const within = document.querySelector(part ?? "main");
    if (within === null) return false;
    const figures = [...within.querySelectorAll("figure[data-chart]")];
    if (within.matches("figure[data-chart]")) figures.push(within);
    const isDrawn = (canvas) => {
        const { width, height } = canvas;
        if (width === 0 || height === 0) return false;
        return canvas.getContext("2d").getImageData(0, 0, width, height).data.some((value) => value !== 0);
    };
    if (part !== null && within.querySelector("canvas, svg") === null) return false;
    return figures.every((figure) => {
        const canvas = figure.querySelector("canvas");
        return canvas !== null && isDrawn(canvas);
    });
}"""
"""Whether the charts of a part are drawn, and a part that comes later has come."""


def _starts(page: WatchedPage) -> str | None:
    """Return the page of the first motor whose starts are drawn; None where no motor has any."""
    page.goto("/starts")
    if page.page.locator("#starts table").count() == 0:
        return None
    motors = dict.fromkeys(
        one.get_attribute("href") for one in page.page.locator("#starts table a[href^='/motors/']").all()
    )
    for address in filter(None, motors):
        page.goto(address)
        if page.page.locator("#starts figure svg").count():
            return address
    return None


def _first(page: WatchedPage, beginning: str) -> str:
    """Return the address of the first link that begins so and leads to one thing."""
    links = page.page.locator(f"main a[href^='{beginning}']")
    address = links.first.get_attribute("href")
    assert address is not None
    return address
