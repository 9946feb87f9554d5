"""Errors of back-ups: which file of which back-up, what was expected, what was found."""


class BackupError(RuntimeError):
    """A back-up cannot be made, is not whole, or cannot be restored here."""


class BackupStoppedError(BackupError):
    """The service ends while it makes a back-up."""
