"""Topics whose latest message the broker keeps. They are known after the gateway has gone and come back."""

from collections.abc import Collection
from pathlib import Path

from service.gateways.kept_file import KeptFileError, read_kept, write_kept

TOPICS = "mqtt-topics.json"


class KeptTopics:
    """A topic is noted before its first message, and forgotten after the message that takes it away."""

    def __init__(self, data_directory: Path) -> None:
        """Raises KeptFileError."""
        self._file = data_directory / TOPICS
        found = read_kept(self._file)
        topics = [] if found is None else found.get("topics")
        if not isinstance(topics, list) or not all(isinstance(topic, str) for topic in topics):
            raise KeptFileError(f"{self._file}: expected topics, found another document")
        self._topics = frozenset[str](topics)

    def gone(self, topics: Collection[str]) -> list[str]:
        """Return the topics that the broker keeps and that are not among these."""
        return sorted(self._topics.difference(topics))

    def add(self, topics: Collection[str]) -> None:
        """Note these topics. Raises OSError."""
        self._keep(self._topics.union(topics))

    def forget(self, topics: Collection[str]) -> None:
        """Forget these topics. Raises OSError."""
        self._keep(self._topics.difference(topics))

    def _keep(self, topics: frozenset[str]) -> None:
        if topics != self._topics:
            write_kept(self._file, {"topics": sorted(topics)})
            self._topics = topics
