"""When things are due that each come again and again."""

from heapq import heappop, heappush


class Agenda:
    """Holds one time for each of so many places; at first all are due.

    A time that was replaced stays in the heap until it comes first there, and is dropped then: to replace it
    costs no search.

    Parameters
    ----------
    places : int
        Number of places, counted from 0.
    """

    def __init__(self, places: int) -> None:
        self._due_s = [0.0] * places
        self._heap = [(0.0, place) for place in range(places)]

    def put(self, place: int, due_s: float) -> None:
        """Set when a place is due next.

        Parameters
        ----------
        place : int
            The place.
        due_s : float
            Time [s, monotonic].
        """
        self._due_s[place] = due_s
        heappush(self._heap, (due_s, place))

    def hasten(self, place: int, due_s: float) -> None:
        """Let a place be due at this time at the latest.

        Parameters
        ----------
        place : int
            The place.
        due_s : float
            Time [s, monotonic].
        """
        if due_s < self._due_s[place]:
            self.put(place, due_s)

    def is_due(self, now_s: float) -> bool:
        """Return whether a place is due.

        Parameters
        ----------
        now_s : float
            The present [s, monotonic].

        Returns
        -------
        bool
            True if one is.
        """
        while self._heap and self._heap[0][0] != self._due_s[self._heap[0][1]]:
            heappop(self._heap)
        return bool(self._heap) and self._heap[0][0] <= now_s

    def take(self, now_s: float) -> int | None:
        """Take the place that has been due for longest; `put` says when it is due again.

        Parameters
        ----------
        now_s : float
            The present [s, monotonic].

        Returns
        -------
        int or None
            The place; None where none is due.
        """
        return heappop(self._heap)[1] if self.is_due(now_s) else None
