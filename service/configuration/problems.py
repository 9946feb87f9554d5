"""What is wrong in the files and variables that configure the service, as values and in words."""

from collections.abc import Iterable, Iterator
from contextlib import AbstractContextManager
from dataclasses import asdict, dataclass
from types import TracebackType

ENVIRONMENT = "environment"


@dataclass(frozen=True, slots=True)
class Problem:
    """One thing that is wrong.

    source: the file, or "environment".
    field: the key in it, such as "motor P-101A: schedule".
    nearest: what was probably meant; None where nothing known is like it.
    line: in the file; None where it is not known.
    """

    source: str
    field: str
    expected: str
    found: str
    nearest: str | None = None
    line: int | None = None

    def __str__(self) -> str:
        meant = "" if self.nearest is None else f" (did you mean {self.nearest}?)"
        line = "" if self.line is None else f"line {self.line}: "
        return f"{self.source}: {line}{self.field}: expected {self.expected}, found {self.found}{meant}"

    def document(self) -> dict[str, str | int | None]:
        """Return the problem as a JSON document."""
        return asdict(self)


class ConfigurationError(ValueError):
    """The configuration cannot be used. It has at least one problem, and its text has a line for each."""

    def __init__(self, problems: Iterable[Problem]) -> None:
        self.problems = tuple(problems)
        super().__init__("\n".join(map(str, self.problems)))

    @property
    def source(self) -> str:
        """Return where the first problem is."""
        return self.problems[0].source

    @property
    def field(self) -> str:
        """Return the key of the first problem."""
        return self.problems[0].field

    @property
    def expected(self) -> str:
        """Return what the first problem expected."""
        return self.problems[0].expected

    @property
    def found(self) -> str:
        """Return what the first problem found."""
        return self.problems[0].found


class Problems:
    """Problems as they are found, so that all of them can be told at once.

    warnings: what is odd and can be used all the same.
    """

    def __init__(self) -> None:
        self._found: list[Problem] = []
        self.warnings: list[str] = []

    def __bool__(self) -> bool:
        return bool(self._found)

    def __iter__(self) -> Iterator[Problem]:
        return iter(self._found)

    def add(self, problem: Problem) -> None:
        """Keep one more problem."""
        self._found.append(problem)

    def extend(self, problems: Iterable[Problem]) -> None:
        """Keep more problems."""
        self._found.extend(problems)

    def collected(self) -> AbstractContextManager[None, bool]:
        """Keep the problems that the block raises. What follows the block goes on without its result."""
        return _Collecting(self)


class _Collecting(AbstractContextManager[None, bool]):
    """A block whose ConfigurationError is kept, and ends the block alone."""

    def __init__(self, problems: Problems) -> None:
        self._problems = problems

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> bool:
        if isinstance(error, ConfigurationError):
            self._problems.extend(error.problems)
            return True
        return False
