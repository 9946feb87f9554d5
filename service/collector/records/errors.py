"""What a relay's records can do wrong that is no fault of MMS."""


class RecordTooLargeError(ValueError):
    """The relay lists a file that is larger than a setting allows."""


class RecordReplacedError(ValueError):
    """The relay changed a record, or put another one in its place, while it was fetched."""
