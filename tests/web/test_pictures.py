"""The pictures of the documentation show what they are of: a part of a page with its charts drawn."""

from pathlib import Path

from PIL import Image

from benchmarks.web.pictures import Picture, take
from service.storage.records import Role
from testing.web.seeding import FAULTY
from testing.web.site import PHONE, Site


def test_a_picture_of_a_part_shows_the_part_alone_with_its_chart_drawn(
    looked_at: Site, tmp_path: Path
) -> None:
    page = looked_at.open(Role.VIEWER)
    take(page, Picture("trend", f"/motors/{FAULTY}?days=all", part="#trend"), tmp_path)
    box = page.page.locator("#trend").bounding_box()
    assert box is not None
    with Image.open(tmp_path / "trend.png") as shot:
        assert abs(shot.width - box["width"]) <= 1
        assert abs(shot.height - box["height"]) <= 1
        place = page.page.locator("#trend [data-chart-place]").bounding_box()
        assert place is not None
        left, top = place["x"] - box["x"], place["y"] - box["y"]
        chart = shot.convert("RGB").crop(
            (int(left), int(top), int(left + place["width"]), int(top + place["height"]))
        )
        colours = chart.getcolors()
    assert colours is not None
    assert len(colours) > 10, "the chart is empty"


def test_a_picture_from_a_part_onwards_is_a_screen_that_begins_there(looked_at: Site, tmp_path: Path) -> None:
    page = looked_at.open(Role.VIEWER, screen=PHONE)
    take(page, Picture("phone", f"/motors/{FAULTY}", PHONE, part="#trend", onwards=True), tmp_path)
    box = page.page.locator("#trend").bounding_box()
    assert box is not None
    assert abs(box["y"]) <= 1  # of the screen: the page is scrolled
    with Image.open(tmp_path / "phone.png") as shot:
        assert shot.size == PHONE
