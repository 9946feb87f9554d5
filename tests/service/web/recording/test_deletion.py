"""Who deletes a recording on its page has it back by a click for ten minutes."""

import httpx

from service.api import ApiContext
from service.storage import Repository
from testing.service.diagnosed import add_diagnosed
from testing.service.plants import NOW_NS, healthy
from tests.service.web.pages import addresses, page, words

UNDO = "form[action$='/undo']"


def test_a_recording_is_deleted_by_a_form_and_is_back_by_a_click(
    client: httpx.Client, context: ApiContext, repository: Repository
) -> None:
    recording_id = add_diagnosed(repository, context.store, healthy(), NOW_NS, name="E1")
    here = f"/recordings/{recording_id}"
    (delete,) = addresses(page(client.get(here)), "form[action$='/deletion']")
    assert client.post(delete, data={"reason": "  "}).status_code == 422, "a reason is needed"
    answer = client.post(delete, data={"reason": "of another motor"})
    assert (answer.status_code, answer.headers["location"]) == (
        303,
        "/recordings?motor=PUMP-A1&done=recording-deleted",
    )
    assert client.get(here).status_code == 404
    listed = page(client.get(answer.headers["location"]))
    (told,) = words(listed, UNDO)
    assert told.startswith("Deleted by you: recording E1 of PUMP-A1")
    (undo,) = addresses(listed, UNDO)
    answer = client.post(undo)
    assert (answer.status_code, answer.headers["location"]) == (303, f"{here}?done=deletion-undone")
    assert client.get(here).status_code == 200
    assert addresses(page(client.get("/recordings")), UNDO) == []


def test_somebody_elses_deletion_has_no_button(
    client: httpx.Client, context: ApiContext, repository: Repository
) -> None:
    recording_id = add_diagnosed(repository, context.store, healthy(), NOW_NS, name="E1")
    repository.delete_recording(recording_id, "a slip", now_ns=2**62)
    assert addresses(page(client.get("/recordings")), UNDO) == []
