"""Sends the messages of one channel, one after the other."""

import time
import uuid
from threading import Event

import structlog
from sqlalchemy.exc import SQLAlchemyError

from service.configuration.channels import Channel, MailChannel
from service.configuration.notifications import NotificationSettings
from service.notifications.messages.writing import message_of
from service.senders.errors import SendError
from service.senders.sending import send
from service.storage import Repository
from service.storage.records import Notification
from service.storage.states import NotificationState
from service.timing.backoff import Backoff

log = structlog.get_logger(__name__)

LONGEST_PAUSE_S = 3600.0
"""Before another attempt, however many failed."""


class Delivery:
    """The messages of one channel. Each attempt has a limit of time, and other channels go on meanwhile."""

    def __init__(
        self,
        name: str,
        channel: Channel,
        settings: NotificationSettings,
        repository: Repository,
        *,
        installation: str,
        stopping: Event,
        stale_after_days: float | None = None,
    ) -> None:
        """installation: begins the claims of this service, by which it knows them after it was killed."""
        self._name = name
        self._channel = channel
        self._settings = settings
        self._repository = repository
        self._installation = installation
        self._stopping = stopping
        self._stale_after_days = stale_after_days
        self._backoff = Backoff(settings.retry_delay_s, LONGEST_PAUSE_S)

    def deliver(self) -> None:
        """Send what is due. Raises sqlalchemy.exc.SQLAlchemyError."""
        while not self._stopping.is_set():
            claim = f"{self._installation} {uuid.uuid4()}"
            notification = self._repository.claim_notification(self._name, claim=claim, now_ns=time.time_ns())
            if notification is None:
                return
            self._attempt(notification, claim)

    def _attempt(self, notification: Notification, claim: str) -> None:
        """Send a message once, and note what came of it."""
        try:
            message = message_of(
                notification,
                self._settings,
                self._repository,
                stale_after_days=self._stale_after_days,
                with_pictures=isinstance(self._channel, MailChannel),
            )
            send(self._name, self._channel, notification.recipient, message)
        except SendError as error:
            self._failed(notification, claim, str(error), is_final=error.is_final)
        except SQLAlchemyError:
            # Nothing was sent: the message is not written before the database has answered.
            self._failed(notification, claim, "the database did not answer", is_final=False)
            raise
        except Exception as error:  # a message that cannot be written must not hold up those behind it
            self._failed(notification, claim, f"{type(error).__name__}: {error}", is_final=False)
            raise
        else:
            self._repository.finish_notification(notification.id, claim=claim, now_ns=time.time_ns())
            log.info(
                "message sent",
                channel=self._name,
                message=notification.id,
                about=notification.kind.value,
                attempts=notification.attempts,
            )

    def _failed(self, notification: Notification, claim: str, reason: str, *, is_final: bool) -> None:
        state = self._repository.fail_notification(
            notification.id,
            reason,
            claim=claim,
            now_ns=time.time_ns(),
            most_attempts=self._settings.attempts,
            backoff=self._backoff,
            is_final=is_final,
        )
        words = "message given up" if state is NotificationState.DEAD else "message not sent, trying again"
        log.warning(
            words,
            channel=self._name,
            message=notification.id,
            attempts=notification.attempts,
            reason=reason,
        )
