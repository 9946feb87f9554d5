"""The page about the pages names every one of them, with who may see it, and its pictures are there."""

import re

from service.access.permissions import Permission
from testing.web.pages import routes
from tests.docs.pages import ROOT

PAGE = ROOT / "docs" / "web.md"
PARTS = {
    *(
        "/live",
        "/motors/{name}/trend",
        "/recordings/{recording_id}/phasors",
        "/recordings/{recording_id}/model",
    ),
    *("/reports/fleet", "/reports/motor", "/reports/alarms"),
}
"""What pages fetch, and the files of reports."""


def test_every_page_is_named_with_who_may_see_it() -> None:
    rows = re.findall(
        r"^\| `(/[^`]*)` \| .* \| (?:`(\w+)`|everybody) \|$", PAGE.read_text(encoding="utf-8"), re.M
    )
    told = {path: Permission(needed) if needed else None for path, needed in rows}
    assert told == {path: needed for path, needed in routes().items() if path not in PARTS}


def test_its_pictures_are_there() -> None:
    names = re.findall(r"\]\((images/web/[\w-]+\.png)\)", PAGE.read_text(encoding="utf-8"))
    assert len(names) >= 5
    for name in names:
        picture = (PAGE.parent / name).read_bytes()
        assert picture.startswith(b"\x89PNG")
        assert len(picture) < 250_000, f"{name} is large for a repository"
