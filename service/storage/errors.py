"""Errors of the storage, in words for the person who asked."""

from collections.abc import Sequence

from service.storage.alarm_transitions import possible_for_people
from service.storage.records import BaselineDoubt
from service.storage.states import AlarmEvent, AlarmKind, AlarmState


class StorageError(Exception):
    """The database refused what was asked of it."""


class NotFoundError(StorageError):
    """There is no such thing: `kind` ("motor", "recording", ...) and the name or id asked for.

    nearest: the name that was meant, perhaps.
    """

    def __init__(self, kind: str, name: str, *, nearest: str | None = None) -> None:
        self.kind = kind
        self.name = name
        self.nearest = nearest
        hint = "" if nearest is None else f"; did you mean {nearest!r}?"
        super().__init__(f"there is no {kind} {name[:100]!r}{hint}")


class OutOfServiceError(StorageError):
    """What left the plant is remembered, and nothing more can be asked of it."""

    def __init__(self, kind: str, name: str) -> None:
        self.kind = kind
        self.name = name
        super().__init__(
            f"{kind} {name} is out of service: it is not in the plant's files any more; put it back there "
            "(settings scd and motors) and start the service again"
        )


class TooManyWaitingError(StorageError):
    """A motor has as many requests or diagnoses waiting as it may have."""

    def __init__(self, motor: str, what: str, most: int, setting: str) -> None:
        super().__init__(
            f"motor {motor} has {most} {what}, as many as it may have (setting {setting}); nothing was "
            "changed, ask again when some have ended"
        )


class TooManyTestsError(StorageError):
    """As many tests of a channel wait as may."""

    def __init__(self, channel: str, most: int) -> None:
        super().__init__(f"{most} tests of channel {channel} wait to be sent; ask again when some have ended")


class TooManyNotesError(StorageError):
    """A motor has as many notes as it may have."""

    def __init__(self, motor: str, most: int) -> None:
        super().__init__(
            f"motor {motor} has {most} notes or more, the most it may have, and notes are kept for good: "
            "raise the setting max_notes and start the service again; nothing was changed"
        )


class TooManyInspectionsError(StorageError):
    """A motor has as many inspections, or they as many pictures, as they may have."""

    def __init__(self, of: str, most: int, what: str) -> None:
        super().__init__(f"{of} has {most} {what}, the most it may have; nothing was changed")


class UserExistsError(StorageError):
    """There is a user of this name already."""

    def __init__(self, name: str) -> None:
        super().__init__(f"there is a user {name!r} already; choose another name")


class LastAdministratorError(StorageError):
    """Without this user nobody could manage users."""

    def __init__(self, name: str) -> None:
        super().__init__(
            f"user {name!r} is the last one with the role SECADM, who manages users: give it to another user "
            "first; nothing was changed"
        )


class PasskeyExistsError(StorageError):
    """A passkey is kept already, or has the name of another one of its user, or is one too many."""

    def __init__(self, label: str, most: int) -> None:
        super().__init__(
            f"no passkey {label!r} was added: expected a name that you have not used, a device that is not "
            f"registered yet, and at most {most} passkeys"
        )


class LastFactorError(StorageError):
    """The last second factor of a user whose role needs one."""

    def __init__(self, label: str) -> None:
        super().__init__(
            f"passkey {label!r} was not removed: your role needs a second factor, and it is your last one; "
            "add another passkey or an authenticator app first, or ask a SECADM for a reset"
        )


class RolesNotSeparateError(StorageError):
    """A user is to have both roles that watch each other."""

    def __init__(self, name: str) -> None:
        super().__init__(
            f"user {name!r} cannot have both SECADM and SECAUD: who manages users does not read the audit "
            "trail that tells of it; give the roles to two people; nothing was changed"
        )


class AuditorAccountError(StorageError):
    """Somebody who manages users wants what would let them read the audit trail as somebody else."""

    def __init__(self, name: str, what: str) -> None:
        super().__init__(
            f"{what} of user {name!r} is for the owner of the service's files alone, because whoever manages "
            "users must not get at the audit trail: have them run it with --config FILE on the service's "
            "machine; nothing was changed"
        )


class NotOwnPasswordError(StorageError):
    """A password is to be set in a way that is not for this user."""

    def __init__(self, name: str, instead: str) -> None:
        super().__init__(f"the password of user {name!r} is not set so: {instead}; nothing was changed")


class PasswordOfAnotherError(StorageError):
    """Somebody else knows the password of a user, who is to change it first."""

    def __init__(self, name: str, by: str) -> None:
        super().__init__(
            f"{by} gave user {name!r} their password: change it first (mcc password, or the page Account)"
        )


class TokenOfAnotherError(StorageError):
    """A token is to be made for somebody else."""

    def __init__(self, name: str) -> None:
        super().__init__(
            f"a token of user {name!r} is made by that user alone: log in as them (mcc login, then mcc token "
            "add LABEL); for a user whom nobody can log in as, the owner of the service's files does (mcc "
            "token add LABEL --user NAME --config FILE)"
        )


class WiderTokenError(StorageError):
    """A token is to outlive the token that asks for it, or to allow more."""

    def __init__(self, label: str, what: str) -> None:
        super().__init__(
            f"the token {label!r} cannot ask for a token that {what} than itself; nothing was changed"
        )


class TooManyTokensError(StorageError):
    """A user has as many tokens as one may have."""

    def __init__(self, name: str, most: int) -> None:
        super().__init__(f"user {name!r} has {most} tokens, the most one may have: revoke those not needed")


class UnusableBaselineError(StorageError):
    """A recording that cannot stand for a motor's healthy condition."""

    def __init__(self, recording_id: str, reason: str) -> None:
        super().__init__(f"recording {recording_id} cannot be part of a baseline: {reason}")


class DoubtfulBaselineError(StorageError):
    """Recordings that may show a fault are to stand for health, and nobody says why."""

    def __init__(self, motor: str, doubts: Sequence[BaselineDoubt], number: int) -> None:
        self.doubts = doubts
        super().__init__(
            f"{len(doubts)} of {number} recordings are in doubt as a baseline of motor {motor}: a fault that "
            "they have would be taken off all later diagnoses; choose healthy ones, or say why these stand "
            "for health (reason)"
        )


class RecordingInUseError(StorageError):
    """A recording that cannot be deleted now; `cause` says what uses it and what to do."""

    def __init__(self, recording_id: str, cause: str) -> None:
        super().__init__(f"recording {recording_id} cannot be deleted: {cause}")


class DeletionStaysError(StorageError):
    """A deletion that cannot be undone, or not by who asks; `cause` says why."""

    def __init__(self, recording_id: str, cause: str) -> None:
        super().__init__(f"the deletion of recording {recording_id} cannot be undone: {cause}")


class FolderGoneError(StorageError):
    """The folder of a record that was about to be added was removed meanwhile: store its files again."""

    def __init__(self, digest: str) -> None:
        super().__init__(f"the files of recording {digest} were removed meanwhile; store them again")


class UnstorableDiagnosisError(StorageError):
    """A diagnosis that no database can hold: a figure that is no number, or more text than people read."""


class RunnerEndedError(StorageError):
    """A job runner was declared dead: others do its jobs."""

    def __init__(self, runner: str) -> None:
        super().__init__(f"job runner {runner} has not renewed its lease in time; others do its jobs")


class LeaseLostError(StorageError):
    """A gateway does not hold the lease, of all its relays or of one, that it needs for what it wants."""

    def __init__(self, gateway: str, relay: str | None = None) -> None:
        self.gateway = gateway
        self.relay = relay
        what = "any lease" if relay is None else f"the lease of {relay}"
        super().__init__(f"gateway {gateway} does not hold {what} any more")


class StateConflictError(StorageError):
    """A step that does not follow from the present state, e.g. a failed request cannot be triggered."""

    def __init__(self, kind: str, name: str, *, present: str, wanted: str) -> None:
        self.kind = kind
        self.name = name
        self.present = present
        self.wanted = wanted
        super().__init__(f"{kind} {name} is {present} and cannot become {wanted}")


class AlarmActionError(StorageError):
    """What somebody wants to do about an alarm does not follow from its present state."""

    def __init__(self, alarm_id: str, event: AlarmEvent, state: AlarmState, *, why: str) -> None:
        self.alarm_id = alarm_id
        self.state = state
        self.possible = possible_for_people(state)
        can = ", ".join(DEED[event] for event in self.possible) or "nothing; it is over"
        super().__init__(
            f"alarm {alarm_id} cannot be {PARTICIPLE.get(event, event.value)}: it is {state.value} ({why}); "
            f"possible now: {can}"
        )


class AlarmCannotGrowError(StorageError):
    """An alarm is to be shelved until it grows, and its cause has no measure."""

    def __init__(self, alarm_id: str, kind: AlarmKind) -> None:
        super().__init__(
            f"alarm {alarm_id} ({kind.value}) has no value that could grow; shelve it until a time"
        )


DEED = {
    AlarmEvent.ACKNOWLEDGED: "acknowledge",
    AlarmEvent.ACKNOWLEDGEMENT_UNDONE: "undo the acknowledgement",
    AlarmEvent.SHELVED: "shelve",
    AlarmEvent.UNSHELVED: "unshelve",
    AlarmEvent.TAKEN_OUT_OF_SERVICE: "take out of service",
    AlarmEvent.PUT_BACK_IN_SERVICE: "put back in service",
}
"""What people do, in words."""

PARTICIPLE = {
    AlarmEvent.ACKNOWLEDGED: "acknowledged",
    AlarmEvent.ACKNOWLEDGEMENT_UNDONE: "made unacknowledged again",
    AlarmEvent.SHELVED: "shelved",
    AlarmEvent.UNSHELVED: "unshelved",
    AlarmEvent.TAKEN_OUT_OF_SERVICE: "taken out of service",
    AlarmEvent.PUT_BACK_IN_SERVICE: "put back in service",
}
