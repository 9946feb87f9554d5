"""Whose subscription it is: it belongs to one session, and only its own client takes it to another one.

The library counts the numbers of subscriptions up from 78, and does to each what any session asks for. It
lets a session have any number of them, with any number of monitored items, as often as it likes.
"""

from collections.abc import Callable, Iterable, Iterator, MutableMapping, Sequence
from dataclasses import replace
from typing import Any, Final

from asyncua import ua
from asyncua.common.utils import ServiceError
from asyncua.server.internal_session import InternalSession, SessionState
from asyncua.server.internal_subscription import InternalSubscription

from service.gateways.opcua import limits
from service.gateways.opcua.timestamps import check_timestamps
from service.gateways.opcua.users import PlantUser

UNKNOWN: Final = ua.StatusCodes.BadSubscriptionIdInvalid
"""What is said of another's: the same as of one that there is not."""

Owners = MutableMapping[InternalSubscription, "SubscribingSession"]


class SubscribingSession(InternalSession):  # type: ignore[misc]
    """A session that has its own subscriptions, and no others.

    client_certificate: of the channel it was created on.
    """

    client_certificate: bytes | None = None

    @property
    def account_name(self) -> str | None:
        """Return whose it is; None for somebody who has not said who it is."""
        return self.user.account_name if isinstance(self.user, PlantUser) else None

    @property
    def client(self) -> tuple[str | None, bytes | None] | None:
        """Return account and certificate of its client; None where neither is known."""
        known = (self.account_name, self.client_certificate)
        return known if any(known) else None

    @property
    def is_closed(self) -> bool:
        """Return whether it has ended."""
        return bool(self.state is SessionState.Closed)

    async def close_session(self, delete_subs: bool = True) -> None:
        """End it. Subscriptions stay only where their client can be told from others."""
        await super().close_session(delete_subs or self.client is None)

    async def create_subscription(
        self, params: Any, callback: Callable[..., Any], request_callback: Callable[..., Any] | None = None
    ) -> Any:
        if len(self._held()) >= limits.SUBSCRIPTIONS:
            raise ServiceError(ua.StatusCodes.BadTooManySubscriptions)
        interval_ms = limits.interval_ms(params.RequestedPublishingInterval)
        result = await super().create_subscription(
            replace(params, RequestedPublishingInterval=interval_ms), callback, request_callback
        )
        self._owners[self._all[result.SubscriptionId]] = self
        return result

    def modify_subscription(self, params: Any) -> Any:
        self._check(params.SubscriptionId)
        return super().modify_subscription(params)

    async def delete_subscriptions(self, ids: Sequence[int]) -> list[Any]:
        own, answer = self._sorted(ids)
        return answer(await super().delete_subscriptions(own))

    async def set_publishing_mode(self, params: Any) -> list[Any]:
        own, answer = self._sorted(params.SubscriptionIds)
        return answer(await super().set_publishing_mode(replace(params, SubscriptionIds=own)))

    async def create_monitored_items(self, params: Any) -> list[Any]:
        self._check(params.SubscriptionId)
        limits.check_operations(limits.MONITOR, params.ItemsToCreate)
        check_timestamps(params.TimestampsToReturn)
        room = max(limits.MONITORED_ITEMS - _items(self._held()), 0)
        made = await super().create_monitored_items(
            replace(params, ItemsToCreate=params.ItemsToCreate[:room])
        )
        refused = ua.StatusCode(ua.StatusCodes.BadTooManyMonitoredItems)
        return [
            *made,
            *(ua.MonitoredItemCreateResult(StatusCode=refused) for _ in params.ItemsToCreate[room:]),
        ]

    async def modify_monitored_items(self, params: Any) -> list[Any]:
        self._check(params.SubscriptionId)
        limits.check_operations(limits.MONITOR, params.ItemsToModify)
        for item in params.ItemsToModify:
            wanted = item.RequestedParameters
            wanted.QueueSize = limits.queue_size(wanted.QueueSize)
        return list(await super().modify_monitored_items(params))

    async def set_monitoring_mode(self, params: Any) -> list[Any]:
        self._check(params.SubscriptionId)
        return list(await super().set_monitoring_mode(params))

    async def delete_monitored_items(self, params: Any) -> list[Any]:
        self._check(params.SubscriptionId)
        return list(await super().delete_monitored_items(params))

    def republish(self, params: Any) -> Any:
        self._check(params.SubscriptionId)
        return super().republish(params)

    def publish(self, acks: Iterable[Any] | None = None) -> tuple[int, list[Any]]:
        """Take what the client has of its own subscriptions. Return how many it has, and what was taken."""
        own = list(self.subscriptions())
        if not own:
            raise ServiceError(ua.StatusCodes.BadNoSubscription)
        results = []
        for ack in acks or ():
            is_own = self._has(ack.SubscriptionId)
            if is_own:
                self._all[ack.SubscriptionId].publish([ack.SequenceNumber])
            results.append(ua.StatusCode(ua.StatusCodes.Good if is_own else UNKNOWN))
        return len(own), results

    async def transfer_subscriptions(self, params: Any, callback: Callable[..., Any]) -> list[Any]:
        """Take over those that the same client has in another session, or had in one that is closed."""
        results = []
        for number in params.SubscriptionIds:
            refusal = self._refusal(number)
            if refusal is not None:
                results.append(ua.TransferResult(StatusCode=ua.StatusCode(refusal)))
                continue
            self._owners[self._all[number]] = self
            results += await super().transfer_subscriptions(
                replace(params, SubscriptionIds=[number]), callback
            )
        return results

    def subscriptions(self) -> Iterator[tuple[int, InternalSubscription]]:
        """Return its own, with their numbers."""
        return ((number, one) for number, one in self._all.items() if self._owners.get(one) is self)

    @property
    def _all(self) -> dict[int, InternalSubscription]:
        return self.subscription_service.subscriptions  # type: ignore[no-any-return] # of the library

    @property
    def _owners(self) -> Owners:
        return self.iserver.owners  # type: ignore[no-any-return] # of the library

    def _has(self, number: int) -> bool:
        one = self._all.get(number)
        return one is not None and self._owners.get(one) is self

    def _check(self, number: int) -> None:
        if not self._has(number):
            raise ServiceError(UNKNOWN)

    def _sorted(self, numbers: Sequence[int]) -> tuple[list[int], Callable[[Iterable[Any]], list[Any]]]:
        """Return those of this session, and what puts their results in place among the refusals."""
        is_own = [self._has(number) for number in numbers]

        def answer(results: Iterable[Any]) -> list[Any]:
            left = iter(results)
            return [next(left) if own else ua.StatusCode(UNKNOWN) for own in is_own]

        return [number for number, own in zip(numbers, is_own, strict=True) if own], answer

    def _held(self) -> list[InternalSubscription]:
        """Return its own subscriptions, and those that its client has left behind in closed sessions."""
        return [
            one
            for one in self._all.values()
            if (owner := self._owners.get(one)) is not None
            and (owner is self or (owner.is_closed and owner.client == self.client))
        ]

    def _refusal(self, number: int) -> int | None:
        """Return why a subscription is not taken over; None where it is."""
        one = self._all.get(number)
        owner = None if one is None else self._owners.get(one)
        if one is None or owner is None or self.client is None or owner.client != self.client:
            return int(UNKNOWN)
        held = self._held()
        if one in held:
            return None
        if len(held) >= limits.SUBSCRIPTIONS:
            return int(ua.StatusCodes.BadTooManySubscriptions)
        if _items([*held, one]) > limits.MONITORED_ITEMS:
            return int(ua.StatusCodes.BadTooManyMonitoredItems)
        return None


def _items(subscriptions: Iterable[InternalSubscription]) -> int:
    return sum(
        len(one.monitored_item_srv._monitored_items)  # noqa: SLF001 - the library has no other count
        for one in subscriptions
    )
