"""What a lenient reader mends, and says so; what a strict reader refuses; and what both only warn of."""

from core.recordings.errors import RecordingError

MOST_NOTES = 20
MOST_REPAIRS = 10_000
"""A file wrong in more places is none that can be mended."""


class Repairs:
    """What was mended in one file, of a strict reader nothing ever, and what it is only warned of.

    Parameters
    ----------
    lenient : bool
        Whether anything may be mended.
    """

    def __init__(self, *, lenient: bool) -> None:
        self._lenient = lenient
        self._first: dict[str, str] = {}
        self._alike: dict[str, int] = {}
        self._count = 0
        self._warnings: dict[str, None] = {}

    def warn(self, sentence: str) -> None:
        """Note what departs from the standard and changes no value; the strict reader goes on, too.

        Parameters
        ----------
        sentence : str
            What was found, and how it is read.
        """
        if len(self._warnings) < MOST_NOTES:
            self._warnings[sentence] = None

    @property
    def warnings(self) -> tuple[str, ...]:
        """The warnings, each once."""
        return tuple(self._warnings)

    def mend(self, fault: RecordingError, mended: str) -> None:
        """Note a fault and what is done about it.

        Parameters
        ----------
        fault : RecordingError
            The error a strict reader raises.
        mended : str
            What is done about it, in words.

        Raises
        ------
        RecordingError
            If the reader is strict, or there are too many faults.
        """
        self._count += 1
        if not self._lenient or self._count > MOST_REPAIRS:
            raise fault
        if mended in self._first:
            self._alike[mended] = self._alike.get(mended, 0) + 1
        elif len(self._first) < MOST_NOTES:
            self._first[mended] = f"{fault}: {mended}"

    @property
    def notes(self) -> tuple[str, ...]:
        """One sentence for each kind of repair, in the order of the file; further ones alike are counted."""
        return tuple(
            note + (f" (so are {self._alike[mended]} more)" if mended in self._alike else "")
            for mended, note in self._first.items()
        )
