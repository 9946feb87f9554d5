"""A page of recordings, each with its verdict."""

from service.api.context import ApiContext
from service.api.pages import Page, page
from service.api.recordings.schemas import ListedRecording
from service.storage.records import Page as StoredPage
from service.storage.records import RecordingEntry


def listed(context: ApiContext, recordings: StoredPage[RecordingEntry]) -> Page[ListedRecording]:
    """Return a page of recordings with the verdict of each, asked for at once."""
    verdicts = context.repository.verdicts([one.id for one in recordings.items])

    def with_verdict(one: RecordingEntry) -> ListedRecording:
        found = ListedRecording.model_validate(one)
        found.verdict = verdicts.get(one.id)
        return found

    return page(recordings, with_verdict)
