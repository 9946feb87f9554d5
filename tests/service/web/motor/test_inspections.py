"""What inspections found, on the page of a motor and on that of reports."""

import httpx

from service.storage import Repository
from testing.service.conditions import FAULT, tell
from testing.service.pictures import JPEG_BYTES, SMALL_PNG
from tests.service.web.motor.recorded import MOTOR, know
from tests.service.web.pages import addresses, page, words

HERE = f"/motors/{MOTOR}"
LOGBOOK = f"{HERE}/logbook"
FOUND = {"outcome": "other-cause", "cause": "a loose terminal", "text": "terminal box <b>opened</b>"}


def test_a_person_tells_with_pictures_what_was_found(client: httpx.Client, repository: Repository) -> None:
    know(repository)
    tell(repository, FAULT)
    assert words(page(client.get(LOGBOOK)), "#inspections .notes li") == []
    files = [("pictures", ("a.png", SMALL_PNG, "image/png")), ("pictures", ("b.svg", JPEG_BYTES, "x/y"))]
    answer = client.post(f"{HERE}/inspections", data=FOUND, files=files)
    assert answer.headers["location"] == f"{LOGBOOK}?done=inspection-kept"

    document = page(client.get(LOGBOOK))
    (told,) = words(document, "#inspections .notes li")
    assert "Other cause: a loose terminal · finding: shorted turns" in told
    assert "terminal box <b>opened</b>" in told
    pictures = [str(one.get("src")) for one in document.cssselect("#inspections img")]
    assert len(pictures) == 2
    assert [client.get(one).headers["content-type"] for one in pictures] == ["image/png", "image/jpeg"]

    year, *cells = words(page(client.get("/reports")), "#inspections-found tbody td")
    assert len(year) == 4
    assert cells == ["FACTORY_A", "shorted turns", "0", "1", "0", "0"]

    (withdrawal,) = addresses(document, "#inspections form[action$='/withdrawal']")
    client.post(withdrawal, data={"reason": "wrong motor"})
    assert "withdrawn" in words(page(client.get(LOGBOOK)), "#inspections .notes li")[0]
    assert words(page(client.get("/reports")), "#inspections-found tbody tr") == []


def test_a_form_without_pictures_as_browsers_send_it(client: httpx.Client, repository: Repository) -> None:
    know(repository)
    part = '--x\r\nContent-Disposition: form-data; name="{}"\r\n\r\n{}\r\n'
    empty = (
        '--x\r\nContent-Disposition: form-data; name="pictures"; filename=""\r\n'
        "Content-Type: application/octet-stream\r\n\r\n\r\n--x--\r\n"
    )
    told = {"outcome": "nothing-found", "text": "tested", "kind": "", "cause": "", "alarm": "", "time": ""}
    body = "".join(part.format(*one) for one in told.items()) + empty
    answer = client.post(
        f"{HERE}/inspections", content=body, headers={"Content-Type": "multipart/form-data; boundary=x"}
    )
    assert answer.status_code == 303, answer.text
    (kept,) = repository.inspections(MOTOR, limit=10).items
    assert (kept.kind, kept.pictures) == ("none", 0)


def test_what_is_no_picture_keeps_nothing(client: httpx.Client, repository: Repository) -> None:
    know(repository)
    tell(repository, FAULT)
    files = {"pictures": ("a.png", b"<script>", "image/png")}
    assert client.post(f"{HERE}/inspections", data=FOUND, files=files).status_code == 422
    assert repository.inspections(MOTOR, limit=10).items == ()
