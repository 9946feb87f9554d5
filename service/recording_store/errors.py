"""Errors of the recording store: what cannot be stored or is damaged, and a place that does not take part."""


class RecordingStoreError(ValueError):
    """Files cannot be stored, or stored files are missing or changed."""


class StoreError(OSError):
    """The place of the recordings refuses what it is asked; no recording is at fault."""


class StoreUnreachableError(StoreError):
    """The place of the recordings does not answer, or not in time; the same may succeed later."""
