"""The one error of this package."""


class ServiceError(RuntimeError):
    """The service did not do what it was asked.

    Parameters
    ----------
    message : str
        What failed, for a person.
    status : int or None
        The HTTP status; None where the service did not answer.
    """

    def __init__(self, message: str, *, status: int | None = None) -> None:
        super().__init__(message)
        self.status = status
