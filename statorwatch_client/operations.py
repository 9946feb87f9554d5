"""Every operation of the API as a method. Made by `make client`; not to be edited."""

# ruff: noqa: E501
from __future__ import annotations

from typing import TYPE_CHECKING, BinaryIO, Literal, cast

from statorwatch_client.transport import Transport, segment

if TYPE_CHECKING:  # types alone, which need not be made at each start of a program
    from collections.abc import Iterator, Mapping, Sequence
    from datetime import datetime

    from statorwatch_client import models


class Operations:
    """The operations of the API. Each raises ServiceError where the service does not do what it is asked.

    Parameters
    ----------
    transport : Transport
        Sends the requests.
    """

    def __init__(self, transport: Transport) -> None:
        self.transport = transport

    def list_sites(self, *, limit: int | None = None, cursor: str | None = None) -> models.PageSite:
        """Return the sites (substations of the plant's SCD), by name.

        Parameters
        ----------
        limit : int or None
            Most items of this page.
        cursor : str or None
            `next_cursor` of the page before; without: the first page.

        Returns
        -------
        PageSite
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.PageSite",
            self.transport.document("GET", "/api/v1/sites", query={"limit": limit, "cursor": cursor}),
        )

    def iter_sites(self, *, limit: int | None = None) -> Iterator[models.Site]:
        """Return the sites (substations of the plant's SCD), by name.

        Parameters
        ----------
        limit : int or None
            Most items of this page.

        Yields
        ------
        Site
            Every item, page after page.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        cursor: str | None = None
        while True:
            page = self.list_sites(limit=limit, cursor=cursor)
            yield from self.transport.listed(page, "/api/v1/sites")
            cursor = page.get("next_cursor")
            if cursor is None:
                return

    def list_motors(
        self, *, health: bool | None = None, limit: int | None = None, cursor: str | None = None
    ) -> models.PageListedMotor:
        """Return the motors, by name.

        Parameters
        ----------
        health : bool or None
            With the health of each, as `motors/{name}/health`.
        limit : int or None
            Most items of this page.
        cursor : str or None
            `next_cursor` of the page before; without: the first page.

        Returns
        -------
        PageListedMotor
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.PageListedMotor",
            self.transport.document(
                "GET", "/api/v1/motors", query={"health": health, "limit": limit, "cursor": cursor}
            ),
        )

    def iter_motors(
        self, *, health: bool | None = None, limit: int | None = None
    ) -> Iterator[models.ListedMotor]:
        """Return the motors, by name.

        Parameters
        ----------
        health : bool or None
            With the health of each, as `motors/{name}/health`.
        limit : int or None
            Most items of this page.

        Yields
        ------
        ListedMotor
            Every item, page after page.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        cursor: str | None = None
        while True:
            page = self.list_motors(health=health, limit=limit, cursor=cursor)
            yield from self.transport.listed(page, "/api/v1/motors")
            cursor = page.get("next_cursor")
            if cursor is None:
                return

    def get_motor(self, name: str) -> models.Motor:
        """Return one motor.

        Parameters
        ----------
        name : str
            Its name.

        Returns
        -------
        Motor
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast("models.Motor", self.transport.document("GET", f"/api/v1/motors/{segment(name)}"))

    def get_health(self, name: str) -> models.Health:
        """Return a motor's condition, what its latest recording says by itself, and whether its relay answers.

        Parameters
        ----------
        name : str
            Its name.

        Returns
        -------
        Health
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast("models.Health", self.transport.document("GET", f"/api/v1/motors/{segment(name)}/health"))

    def get_trend(
        self,
        name: str,
        *,
        quantity: Literal["mu_f", "theta_f", "load_level", "condition_level", "change"] | None = None,
        from_: datetime | str | None = None,
        to: datetime | str | None = None,
        limit: int | None = None,
        cursor: str | None = None,
    ) -> models.PageTrendPoint:
        """Return one figure for each recording of a motor, oldest first.

        The figures of the motor's condition, as it was seen from that recording on, are `condition_level`
        and `change`; the others are what the recording says by itself. A file has them all, whatever
        `quantity` is.

        Parameters
        ----------
        name : str
            Its name.
        quantity : Literal["mu_f", "theta_f", "load_level", "condition_level", "change"] or None
            Quantity.
        from_ : datetime | str or None
            First time.
        to : datetime | str or None
            First time not to be included.
        limit : int or None
            Most items of this page.
        cursor : str or None
            `next_cursor` of the page before; without: the first page.

        Returns
        -------
        PageTrendPoint
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.PageTrendPoint",
            self.transport.document(
                "GET",
                f"/api/v1/motors/{segment(name)}/trend",
                query={"quantity": quantity, "from": from_, "to": to, "limit": limit, "cursor": cursor},
            ),
        )

    def iter_trend(
        self,
        name: str,
        *,
        quantity: Literal["mu_f", "theta_f", "load_level", "condition_level", "change"] | None = None,
        from_: datetime | str | None = None,
        to: datetime | str | None = None,
        limit: int | None = None,
    ) -> Iterator[models.TrendPoint]:
        """Return one figure for each recording of a motor, oldest first.

        The figures of the motor's condition, as it was seen from that recording on, are `condition_level`
        and `change`; the others are what the recording says by itself. A file has them all, whatever
        `quantity` is.

        Parameters
        ----------
        name : str
            Its name.
        quantity : Literal["mu_f", "theta_f", "load_level", "condition_level", "change"] or None
            Quantity.
        from_ : datetime | str or None
            First time.
        to : datetime | str or None
            First time not to be included.
        limit : int or None
            Most items of this page.

        Yields
        ------
        TrendPoint
            Every item, page after page.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        cursor: str | None = None
        while True:
            page = self.get_trend(name, quantity=quantity, from_=from_, to=to, limit=limit, cursor=cursor)
            yield from self.transport.listed(page, f"/api/v1/motors/{segment(name)}/trend")
            cursor = page.get("next_cursor")
            if cursor is None:
                return

    def list_recordings_of_motor(
        self,
        name: str,
        *,
        operation: models.Operation | None = None,
        limit: int | None = None,
        cursor: str | None = None,
    ) -> models.PageListedRecording:
        """Return the recordings of a motor, latest first.

        Parameters
        ----------
        name : str
            Its name.
        operation : Operation or None
            What the motor does in them.
        limit : int or None
            Most items of this page.
        cursor : str or None
            `next_cursor` of the page before; without: the first page.

        Returns
        -------
        PageListedRecording
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.PageListedRecording",
            self.transport.document(
                "GET",
                f"/api/v1/motors/{segment(name)}/recordings",
                query={"operation": operation, "limit": limit, "cursor": cursor},
            ),
        )

    def iter_recordings_of_motor(
        self, name: str, *, operation: models.Operation | None = None, limit: int | None = None
    ) -> Iterator[models.ListedRecording]:
        """Return the recordings of a motor, latest first.

        Parameters
        ----------
        name : str
            Its name.
        operation : Operation or None
            What the motor does in them.
        limit : int or None
            Most items of this page.

        Yields
        ------
        ListedRecording
            Every item, page after page.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        cursor: str | None = None
        while True:
            page = self.list_recordings_of_motor(name, operation=operation, limit=limit, cursor=cursor)
            yield from self.transport.listed(page, f"/api/v1/motors/{segment(name)}/recordings")
            cursor = page.get("next_cursor")
            if cursor is None:
                return

    def get_condition(self, name: str, *, history: int | None = None) -> models.ConditionDetails:
        """Return the condition of a motor over time, with what was said from each of its latest records on.

        Parameters
        ----------
        name : str
            Its name.
        history : int or None
            With so many of the latest records.

        Returns
        -------
        ConditionDetails
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.ConditionDetails",
            self.transport.document(
                "GET", f"/api/v1/motors/{segment(name)}/condition", query={"history": history}
            ),
        )

    def list_condition_history(
        self, name: str, *, limit: int | None = None, cursor: str | None = None
    ) -> models.PageConditionChange:
        """Return the changes of a motor's condition with what caused each, latest first.

        Parameters
        ----------
        name : str
            Its name.
        limit : int or None
            Most items of this page.
        cursor : str or None
            `next_cursor` of the page before; without: the first page.

        Returns
        -------
        PageConditionChange
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.PageConditionChange",
            self.transport.document(
                "GET",
                f"/api/v1/motors/{segment(name)}/condition/history",
                query={"limit": limit, "cursor": cursor},
            ),
        )

    def iter_condition_history(
        self, name: str, *, limit: int | None = None
    ) -> Iterator[models.ConditionChange]:
        """Return the changes of a motor's condition with what caused each, latest first.

        Parameters
        ----------
        name : str
            Its name.
        limit : int or None
            Most items of this page.

        Yields
        ------
        ConditionChange
            Every item, page after page.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        cursor: str | None = None
        while True:
            page = self.list_condition_history(name, limit=limit, cursor=cursor)
            yield from self.transport.listed(page, f"/api/v1/motors/{segment(name)}/condition/history")
            cursor = page.get("next_cursor")
            if cursor is None:
                return

    def list_notes(
        self, name: str, *, limit: int | None = None, cursor: str | None = None
    ) -> models.PageNote:
        """Return what people told of a motor, and what its files told, latest first.

        Parameters
        ----------
        name : str
            Its name.
        limit : int or None
            Most items of this page.
        cursor : str or None
            `next_cursor` of the page before; without: the first page.

        Returns
        -------
        PageNote
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.PageNote",
            self.transport.document(
                "GET", f"/api/v1/motors/{segment(name)}/notes", query={"limit": limit, "cursor": cursor}
            ),
        )

    def iter_notes(self, name: str, *, limit: int | None = None) -> Iterator[models.Note]:
        """Return what people told of a motor, and what its files told, latest first.

        Parameters
        ----------
        name : str
            Its name.
        limit : int or None
            Most items of this page.

        Yields
        ------
        Note
            Every item, page after page.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        cursor: str | None = None
        while True:
            page = self.list_notes(name, limit=limit, cursor=cursor)
            yield from self.transport.listed(page, f"/api/v1/motors/{segment(name)}/notes")
            cursor = page.get("next_cursor")
            if cursor is None:
                return

    def add_note(self, name: str, *, document: models.NoteRequest) -> models.Note:
        """Keep what a person tells of a motor; its condition follows within seconds.

        All kinds but `note` change what the condition follows from, and need the permission `configure`.

        Parameters
        ----------
        name : str
            Its name.
        document : NoteRequest
            What is wanted.

        Returns
        -------
        Note
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.Note",
            self.transport.document("POST", f"/api/v1/motors/{segment(name)}/notes", json=document),
        )

    def get_note(self, name: str, note_id: str) -> models.Note:
        """Return one note.

        Parameters
        ----------
        name : str
            Its name.
        note_id : str
            Note id.

        Returns
        -------
        Note
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.Note",
            self.transport.document("GET", f"/api/v1/motors/{segment(name)}/notes/{segment(note_id)}"),
        )

    def withdraw_note(self, name: str, note_id: str, *, document: models.Withdrawal) -> models.Note:
        """Let a note that was wrong count no more; the condition follows as if nobody had told it.

        Parameters
        ----------
        name : str
            Its name.
        note_id : str
            Note id.
        document : Withdrawal
            What is wanted.

        Returns
        -------
        Note
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.Note",
            self.transport.document(
                "POST", f"/api/v1/motors/{segment(name)}/notes/{segment(note_id)}/withdrawal", json=document
            ),
        )

    def restart_reference(self, name: str, *, document: models.RestartRequest) -> models.Note:
        """Take the motor for healthy as it is: its standing asymmetry is learnt anew.

        The answer is a note.

        Parameters
        ----------
        name : str
            Its name.
        document : RestartRequest
            What is wanted.

        Returns
        -------
        Note
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.Note",
            self.transport.document("POST", f"/api/v1/motors/{segment(name)}/reference", json=document),
        )

    def get_rotor(self, name: str) -> models.RotorCondition:
        """Return the condition of a motor's rotor, from all its recordings.

        Parameters
        ----------
        name : str
            Its name.

        Returns
        -------
        RotorCondition
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.RotorCondition", self.transport.document("GET", f"/api/v1/motors/{segment(name)}/rotor")
        )

    def list_rotor_trend(
        self,
        name: str,
        *,
        from_: datetime | str | None = None,
        to: datetime | str | None = None,
        limit: int | None = None,
        cursor: str | None = None,
    ) -> models.PageRotorTrendPoint:
        """Return what each recording of a motor shows of its rotor, oldest first.

        Parameters
        ----------
        name : str
            Its name.
        from_ : datetime | str or None
            First time.
        to : datetime | str or None
            First time not to be included.
        limit : int or None
            Most items of this page.
        cursor : str or None
            `next_cursor` of the page before; without: the first page.

        Returns
        -------
        PageRotorTrendPoint
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.PageRotorTrendPoint",
            self.transport.document(
                "GET",
                f"/api/v1/motors/{segment(name)}/rotor/trend",
                query={"from": from_, "to": to, "limit": limit, "cursor": cursor},
            ),
        )

    def iter_rotor_trend(
        self,
        name: str,
        *,
        from_: datetime | str | None = None,
        to: datetime | str | None = None,
        limit: int | None = None,
    ) -> Iterator[models.RotorTrendPoint]:
        """Return what each recording of a motor shows of its rotor, oldest first.

        Parameters
        ----------
        name : str
            Its name.
        from_ : datetime | str or None
            First time.
        to : datetime | str or None
            First time not to be included.
        limit : int or None
            Most items of this page.

        Yields
        ------
        RotorTrendPoint
            Every item, page after page.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        cursor: str | None = None
        while True:
            page = self.list_rotor_trend(name, from_=from_, to=to, limit=limit, cursor=cursor)
            yield from self.transport.listed(page, f"/api/v1/motors/{segment(name)}/rotor/trend")
            cursor = page.get("next_cursor")
            if cursor is None:
                return

    def list_swing_trend(
        self,
        name: str,
        *,
        from_: datetime | str | None = None,
        to: datetime | str | None = None,
        limit: int | None = None,
        cursor: str | None = None,
    ) -> models.PageSwingTrendPoint:
        """Return what each recording of a motor shows of its air gap and of a load that swings, oldest first.

        Parameters
        ----------
        name : str
            Its name.
        from_ : datetime | str or None
            First time.
        to : datetime | str or None
            First time not to be included.
        limit : int or None
            Most items of this page.
        cursor : str or None
            `next_cursor` of the page before; without: the first page.

        Returns
        -------
        PageSwingTrendPoint
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.PageSwingTrendPoint",
            self.transport.document(
                "GET",
                f"/api/v1/motors/{segment(name)}/swings/trend",
                query={"from": from_, "to": to, "limit": limit, "cursor": cursor},
            ),
        )

    def iter_swing_trend(
        self,
        name: str,
        *,
        from_: datetime | str | None = None,
        to: datetime | str | None = None,
        limit: int | None = None,
    ) -> Iterator[models.SwingTrendPoint]:
        """Return what each recording of a motor shows of its air gap and of a load that swings, oldest first.

        Parameters
        ----------
        name : str
            Its name.
        from_ : datetime | str or None
            First time.
        to : datetime | str or None
            First time not to be included.
        limit : int or None
            Most items of this page.

        Yields
        ------
        SwingTrendPoint
            Every item, page after page.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        cursor: str | None = None
        while True:
            page = self.list_swing_trend(name, from_=from_, to=to, limit=limit, cursor=cursor)
            yield from self.transport.listed(page, f"/api/v1/motors/{segment(name)}/swings/trend")
            cursor = page.get("next_cursor")
            if cursor is None:
                return

    def list_supply_trend(
        self,
        name: str,
        *,
        from_: datetime | str | None = None,
        to: datetime | str | None = None,
        limit: int | None = None,
        cursor: str | None = None,
    ) -> models.PageSupplyTrendPoint:
        """Return what each recording of a motor shows of its supply, oldest first.

        Parameters
        ----------
        name : str
            Its name.
        from_ : datetime | str or None
            First time.
        to : datetime | str or None
            First time not to be included.
        limit : int or None
            Most items of this page.
        cursor : str or None
            `next_cursor` of the page before; without: the first page.

        Returns
        -------
        PageSupplyTrendPoint
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.PageSupplyTrendPoint",
            self.transport.document(
                "GET",
                f"/api/v1/motors/{segment(name)}/supply/trend",
                query={"from": from_, "to": to, "limit": limit, "cursor": cursor},
            ),
        )

    def iter_supply_trend(
        self,
        name: str,
        *,
        from_: datetime | str | None = None,
        to: datetime | str | None = None,
        limit: int | None = None,
    ) -> Iterator[models.SupplyTrendPoint]:
        """Return what each recording of a motor shows of its supply, oldest first.

        Parameters
        ----------
        name : str
            Its name.
        from_ : datetime | str or None
            First time.
        to : datetime | str or None
            First time not to be included.
        limit : int or None
            Most items of this page.

        Yields
        ------
        SupplyTrendPoint
            Every item, page after page.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        cursor: str | None = None
        while True:
            page = self.list_supply_trend(name, from_=from_, to=to, limit=limit, cursor=cursor)
            yield from self.transport.listed(page, f"/api/v1/motors/{segment(name)}/supply/trend")
            cursor = page.get("next_cursor")
            if cursor is None:
                return

    def get_tracked_parameters(self, name: str) -> models.TrackedMotor:
        """Return resistances and inductances of a motor as its recordings tell them, and what has drifted.

        Parameters
        ----------
        name : str
            Its name.

        Returns
        -------
        TrackedMotor
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.TrackedMotor",
            self.transport.document("GET", f"/api/v1/motors/{segment(name)}/parameters"),
        )

    def list_tracked_trend(
        self,
        name: str,
        *,
        from_: datetime | str | None = None,
        to: datetime | str | None = None,
        limit: int | None = None,
        cursor: str | None = None,
    ) -> models.PageTrackedTrendPoint:
        """Return the changes of a motor's parameters after each recording, oldest first.

        Parameters
        ----------
        name : str
            Its name.
        from_ : datetime | str or None
            First time.
        to : datetime | str or None
            First time not to be included.
        limit : int or None
            Most items of this page.
        cursor : str or None
            `next_cursor` of the page before; without: the first page.

        Returns
        -------
        PageTrackedTrendPoint
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.PageTrackedTrendPoint",
            self.transport.document(
                "GET",
                f"/api/v1/motors/{segment(name)}/parameters/trend",
                query={"from": from_, "to": to, "limit": limit, "cursor": cursor},
            ),
        )

    def iter_tracked_trend(
        self,
        name: str,
        *,
        from_: datetime | str | None = None,
        to: datetime | str | None = None,
        limit: int | None = None,
    ) -> Iterator[models.TrackedTrendPoint]:
        """Return the changes of a motor's parameters after each recording, oldest first.

        Parameters
        ----------
        name : str
            Its name.
        from_ : datetime | str or None
            First time.
        to : datetime | str or None
            First time not to be included.
        limit : int or None
            Most items of this page.

        Yields
        ------
        TrackedTrendPoint
            Every item, page after page.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        cursor: str | None = None
        while True:
            page = self.list_tracked_trend(name, from_=from_, to=to, limit=limit, cursor=cursor)
            yield from self.transport.listed(page, f"/api/v1/motors/{segment(name)}/parameters/trend")
            cursor = page.get("next_cursor")
            if cursor is None:
                return

    def get_classification(self, name: str) -> models.MotorClassification:
        """Return which causes are likely for all that is known of a motor, and what is not told apart.

        Parameters
        ----------
        name : str
            Its name.

        Returns
        -------
        MotorClassification
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.MotorClassification",
            self.transport.document("GET", f"/api/v1/motors/{segment(name)}/classification"),
        )

    def get_load_profile(self, name: str, *, days: int | None = None) -> models.LoadProfile:
        """Return how a motor was loaded: hours by torque, energy, starts, hours beyond limits, and its heat.

        Parameters
        ----------
        name : str
            Its name.
        days : int or None
            Of so many days; up to 2 by minutes.

        Returns
        -------
        LoadProfile
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.LoadProfile",
            self.transport.document(
                "GET", f"/api/v1/motors/{segment(name)}/load-profile", query={"days": days}
            ),
        )

    def list_integrations(self) -> models.PageIntegration:
        """Return the gateways to other systems that the settings of this service name.

        Returns
        -------
        PageIntegration
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast("models.PageIntegration", self.transport.document("GET", "/api/v1/integrations"))

    def get_baseline(self, name: str) -> models.Baseline:
        """Return the recordings of a motor's baseline, oldest first; none where it has no baseline.

        Parameters
        ----------
        name : str
            Its name.

        Returns
        -------
        Baseline
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.Baseline", self.transport.document("GET", f"/api/v1/motors/{segment(name)}/baseline")
        )

    def set_baseline(self, name: str, *, document: models.BaselineRequest) -> models.Baseline:
        """Replace a motor's baseline by recordings known to be healthy, for diagnoses from now on.

        Recordings in doubt need a reason and who says so; both are kept, in a note of the motor too.

        Parameters
        ----------
        name : str
            Its name.
        document : BaselineRequest
            What is wanted.

        Returns
        -------
        Baseline
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.Baseline",
            self.transport.document("PUT", f"/api/v1/motors/{segment(name)}/baseline", json=document),
        )

    def drop_baseline(self, name: str, *, reason: str | None = None, by: str | None = None) -> None:
        """Delete a motor's baseline; its recordings stay, and a note of the motor keeps who did so and why.

        Parameters
        ----------
        name : str
            Its name.
        reason : str or None
            Why; it is kept.
        by : str or None
            Who says so; it is kept.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        self.transport.document(
            "DELETE", f"/api/v1/motors/{segment(name)}/baseline", query={"reason": reason, "by": by}
        )

    def list_starts(
        self, name: str, *, limit: int | None = None, cursor: str | None = None
    ) -> models.PageStartSummary:
        """Return the starts of a motor, latest first, each beside the reference.

        Parameters
        ----------
        name : str
            Its name.
        limit : int or None
            Most items of this page.
        cursor : str or None
            `next_cursor` of the page before; without: the first page.

        Returns
        -------
        PageStartSummary
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.PageStartSummary",
            self.transport.document(
                "GET", f"/api/v1/motors/{segment(name)}/starts", query={"limit": limit, "cursor": cursor}
            ),
        )

    def iter_starts(self, name: str, *, limit: int | None = None) -> Iterator[models.StartSummary]:
        """Return the starts of a motor, latest first, each beside the reference.

        Parameters
        ----------
        name : str
            Its name.
        limit : int or None
            Most items of this page.

        Yields
        ------
        StartSummary
            Every item, page after page.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        cursor: str | None = None
        while True:
            page = self.list_starts(name, limit=limit, cursor=cursor)
            yield from self.transport.listed(page, f"/api/v1/motors/{segment(name)}/starts")
            cursor = page.get("next_cursor")
            if cursor is None:
                return

    def get_start(self, name: str, recording_id: str) -> models.StartDetails:
        """Return one start with its curves, and what the motor's model tells of it.

        Parameters
        ----------
        name : str
            Its name.
        recording_id : str
            Recording id.

        Returns
        -------
        StartDetails
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.StartDetails",
            self.transport.document("GET", f"/api/v1/motors/{segment(name)}/starts/{segment(recording_id)}"),
        )

    def list_relay_events(
        self, name: str, *, limit: int | None = None, cursor: str | None = None
    ) -> models.PageRelayEventEntry:
        """Return starts, stops and trips that the relay's sequences of events told, latest first.

        Parameters
        ----------
        name : str
            Its name.
        limit : int or None
            Most items of this page.
        cursor : str or None
            `next_cursor` of the page before; without: the first page.

        Returns
        -------
        PageRelayEventEntry
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.PageRelayEventEntry",
            self.transport.document(
                "GET",
                f"/api/v1/motors/{segment(name)}/relay-events",
                query={"limit": limit, "cursor": cursor},
            ),
        )

    def iter_relay_events(self, name: str, *, limit: int | None = None) -> Iterator[models.RelayEventEntry]:
        """Return starts, stops and trips that the relay's sequences of events told, latest first.

        Parameters
        ----------
        name : str
            Its name.
        limit : int or None
            Most items of this page.

        Yields
        ------
        RelayEventEntry
            Every item, page after page.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        cursor: str | None = None
        while True:
            page = self.list_relay_events(name, limit=limit, cursor=cursor)
            yield from self.transport.listed(page, f"/api/v1/motors/{segment(name)}/relay-events")
            cursor = page.get("next_cursor")
            if cursor is None:
                return

    def import_report(
        self,
        name: str,
        *,
        text: bytes,
        date_order: models.DateOrder | None = None,
        power_unit: models.PowerUnit | None = None,
    ) -> models.ReportImport:
        """Keep what a text report of a motor's relay tells: starts, load, statistics, events.

        Parameters
        ----------
        name : str
            Its name.
        text : bytes
            The text that is sent.
        date_order : DateOrder or None
            Order of its dates: the relay's setting DATE_F.
        power_unit : PowerUnit or None
            Unit of P and Q in a load profile; without it they are left out.

        Returns
        -------
        ReportImport
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.ReportImport",
            self.transport.document(
                "POST",
                f"/api/v1/motors/{segment(name)}/reports",
                query={"date_order": date_order, "power_unit": power_unit},
                text=text,
            ),
        )

    def list_measurements(
        self,
        name: str,
        *,
        step: models.AveragingStep | None = None,
        from_: datetime | str | None = None,
        to: datetime | str | None = None,
        limit: int | None = None,
        cursor: str | None = None,
    ) -> models.PageMeasurement:
        """Return what a motor's relay measures, oldest first: currents, voltages, power and frequency.

        Parameters
        ----------
        name : str
            Its name.
        step : AveragingStep or None
            0: as sampled; 60, 900: means of so many seconds, kept for longer.
        from_ : datetime | str or None
            First time.
        to : datetime | str or None
            First time not to be included.
        limit : int or None
            Most items of this page.
        cursor : str or None
            `next_cursor` of the page before; without: the first page.

        Returns
        -------
        PageMeasurement
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.PageMeasurement",
            self.transport.document(
                "GET",
                f"/api/v1/motors/{segment(name)}/measurements",
                query={"step": step, "from": from_, "to": to, "limit": limit, "cursor": cursor},
            ),
        )

    def iter_measurements(
        self,
        name: str,
        *,
        step: models.AveragingStep | None = None,
        from_: datetime | str | None = None,
        to: datetime | str | None = None,
        limit: int | None = None,
    ) -> Iterator[models.Measurement]:
        """Return what a motor's relay measures, oldest first: currents, voltages, power and frequency.

        Parameters
        ----------
        name : str
            Its name.
        step : AveragingStep or None
            0: as sampled; 60, 900: means of so many seconds, kept for longer.
        from_ : datetime | str or None
            First time.
        to : datetime | str or None
            First time not to be included.
        limit : int or None
            Most items of this page.

        Yields
        ------
        Measurement
            Every item, page after page.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        cursor: str | None = None
        while True:
            page = self.list_measurements(name, step=step, from_=from_, to=to, limit=limit, cursor=cursor)
            yield from self.transport.listed(page, f"/api/v1/motors/{segment(name)}/measurements")
            cursor = page.get("next_cursor")
            if cursor is None:
                return

    def list_ieds(self, *, limit: int | None = None, cursor: str | None = None) -> models.PageIed:
        """Return the relays and the state of their links, by name.

        Parameters
        ----------
        limit : int or None
            Most items of this page.
        cursor : str or None
            `next_cursor` of the page before; without: the first page.

        Returns
        -------
        PageIed
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.PageIed",
            self.transport.document("GET", "/api/v1/ieds", query={"limit": limit, "cursor": cursor}),
        )

    def iter_ieds(self, *, limit: int | None = None) -> Iterator[models.Ied]:
        """Return the relays and the state of their links, by name.

        Parameters
        ----------
        limit : int or None
            Most items of this page.

        Yields
        ------
        Ied
            Every item, page after page.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        cursor: str | None = None
        while True:
            page = self.list_ieds(limit=limit, cursor=cursor)
            yield from self.transport.listed(page, "/api/v1/ieds")
            cursor = page.get("next_cursor")
            if cursor is None:
                return

    def get_ied(self, name: str) -> models.IedDetails:
        """Return one relay, with figures and history of its link and its standing alarms.

        Parameters
        ----------
        name : str
            Its name.

        Returns
        -------
        IedDetails
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast("models.IedDetails", self.transport.document("GET", f"/api/v1/ieds/{segment(name)}"))

    def release_ied(self, name: str) -> None:
        """Visit a relay again that was set aside, with a clean sheet; harmless where it was not.

        Parameters
        ----------
        name : str
            Its name.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        self.transport.document("DELETE", f"/api/v1/ieds/{segment(name)}/quarantine")

    def list_link_changes(
        self, name: str, *, limit: int | None = None, cursor: str | None = None
    ) -> models.PageLinkChange:
        """Return the changes of a relay's link with their reasons, latest first; the latest thousand are kept.

        Parameters
        ----------
        name : str
            Its name.
        limit : int or None
            Most items of this page.
        cursor : str or None
            `next_cursor` of the page before; without: the first page.

        Returns
        -------
        PageLinkChange
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.PageLinkChange",
            self.transport.document(
                "GET", f"/api/v1/ieds/{segment(name)}/link-changes", query={"limit": limit, "cursor": cursor}
            ),
        )

    def iter_link_changes(self, name: str, *, limit: int | None = None) -> Iterator[models.LinkChange]:
        """Return the changes of a relay's link with their reasons, latest first; the latest thousand are kept.

        Parameters
        ----------
        name : str
            Its name.
        limit : int or None
            Most items of this page.

        Yields
        ------
        LinkChange
            Every item, page after page.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        cursor: str | None = None
        while True:
            page = self.list_link_changes(name, limit=limit, cursor=cursor)
            yield from self.transport.listed(page, f"/api/v1/ieds/{segment(name)}/link-changes")
            cursor = page.get("next_cursor")
            if cursor is None:
                return

    def list_gateways(self) -> models.PageGateway:
        """Return the processes that visit the relays, on all hosts, by id; always one page.

        Returns
        -------
        PageGateway
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast("models.PageGateway", self.transport.document("GET", "/api/v1/gateways"))

    def list_alarms(
        self,
        *,
        ied: str | None = None,
        motor: str | None = None,
        standing: bool | None = None,
        part_of: str | None = None,
        limit: int | None = None,
        cursor: str | None = None,
    ) -> models.PageAlarm:
        """Return the alarms, over or not, latest first.

        Parameters
        ----------
        ied : str or None
            Only alarms of this relay and its motors.
        motor : str or None
            Only alarms of this motor.
        standing : bool or None
            True: those whose cause stands; false: those whose is gone; without: both.
        part_of : str or None
            Only those that this alarm tells in one line.
        limit : int or None
            Most items of this page.
        cursor : str or None
            `next_cursor` of the page before; without: the first page.

        Returns
        -------
        PageAlarm
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.PageAlarm",
            self.transport.document(
                "GET",
                "/api/v1/alarms",
                query={
                    "ied": ied,
                    "motor": motor,
                    "standing": standing,
                    "part_of": part_of,
                    "limit": limit,
                    "cursor": cursor,
                },
            ),
        )

    def iter_alarms(
        self,
        *,
        ied: str | None = None,
        motor: str | None = None,
        standing: bool | None = None,
        part_of: str | None = None,
        limit: int | None = None,
    ) -> Iterator[models.Alarm]:
        """Return the alarms, over or not, latest first.

        Parameters
        ----------
        ied : str or None
            Only alarms of this relay and its motors.
        motor : str or None
            Only alarms of this motor.
        standing : bool or None
            True: those whose cause stands; false: those whose is gone; without: both.
        part_of : str or None
            Only those that this alarm tells in one line.
        limit : int or None
            Most items of this page.

        Yields
        ------
        Alarm
            Every item, page after page.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        cursor: str | None = None
        while True:
            page = self.list_alarms(
                ied=ied, motor=motor, standing=standing, part_of=part_of, limit=limit, cursor=cursor
            )
            yield from self.transport.listed(page, "/api/v1/alarms")
            cursor = page.get("next_cursor")
            if cursor is None:
                return

    def list_open_alarms(
        self,
        *,
        site: str | None = None,
        ied: str | None = None,
        motor: str | None = None,
        state: models.AlarmState | None = None,
        limit: int | None = None,
        cursor: str | None = None,
    ) -> models.PageAlarm:
        """Return the alarms that are not over, what to act on first at the top.

        Those that nobody has taken notice of come first, then those acknowledged, those whose cause is
        gone, and those set aside; in each, the highest priority first, and of those the latest.

        Parameters
        ----------
        site : str or None
            Only alarms of this site.
        ied : str or None
            Only alarms of this relay and its motors.
        motor : str or None
            Only alarms of this motor.
        state : AlarmState or None
            Only alarms in this state.
        limit : int or None
            Most items of this page.
        cursor : str or None
            `next_cursor` of the page before; without: the first page.

        Returns
        -------
        PageAlarm
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.PageAlarm",
            self.transport.document(
                "GET",
                "/api/v1/alarms/open",
                query={
                    "site": site,
                    "ied": ied,
                    "motor": motor,
                    "state": state,
                    "limit": limit,
                    "cursor": cursor,
                },
            ),
        )

    def iter_open_alarms(
        self,
        *,
        site: str | None = None,
        ied: str | None = None,
        motor: str | None = None,
        state: models.AlarmState | None = None,
        limit: int | None = None,
    ) -> Iterator[models.Alarm]:
        """Return the alarms that are not over, what to act on first at the top.

        Those that nobody has taken notice of come first, then those acknowledged, those whose cause is
        gone, and those set aside; in each, the highest priority first, and of those the latest.

        Parameters
        ----------
        site : str or None
            Only alarms of this site.
        ied : str or None
            Only alarms of this relay and its motors.
        motor : str or None
            Only alarms of this motor.
        state : AlarmState or None
            Only alarms in this state.
        limit : int or None
            Most items of this page.

        Yields
        ------
        Alarm
            Every item, page after page.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        cursor: str | None = None
        while True:
            page = self.list_open_alarms(
                site=site, ied=ied, motor=motor, state=state, limit=limit, cursor=cursor
            )
            yield from self.transport.listed(page, "/api/v1/alarms/open")
            cursor = page.get("next_cursor")
            if cursor is None:
                return

    def get_alarm_figures(self, *, days: int | None = None) -> models.AlarmFigures:
        """Return how many alarms a day there were, the most frequent, chattering and long-standing ones.

        Parameters
        ----------
        days : int or None
            So many days of UTC, with today.

        Returns
        -------
        AlarmFigures
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.AlarmFigures",
            self.transport.document("GET", "/api/v1/alarms/figures", query={"days": days}),
        )

    def get_alarm(self, alarm_id: str) -> models.Alarm:
        """Return one alarm.

        Parameters
        ----------
        alarm_id : str
            Alarm id.

        Returns
        -------
        Alarm
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast("models.Alarm", self.transport.document("GET", f"/api/v1/alarms/{segment(alarm_id)}"))

    def list_alarm_changes(
        self, alarm_id: str, *, limit: int | None = None, cursor: str | None = None
    ) -> models.PageAlarmChange:
        """Return what happened to an alarm, and by whom, latest first; the latest thousand are kept.

        Parameters
        ----------
        alarm_id : str
            Alarm id.
        limit : int or None
            Most items of this page.
        cursor : str or None
            `next_cursor` of the page before; without: the first page.

        Returns
        -------
        PageAlarmChange
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.PageAlarmChange",
            self.transport.document(
                "GET", f"/api/v1/alarms/{segment(alarm_id)}/changes", query={"limit": limit, "cursor": cursor}
            ),
        )

    def iter_alarm_changes(self, alarm_id: str, *, limit: int | None = None) -> Iterator[models.AlarmChange]:
        """Return what happened to an alarm, and by whom, latest first; the latest thousand are kept.

        Parameters
        ----------
        alarm_id : str
            Alarm id.
        limit : int or None
            Most items of this page.

        Yields
        ------
        AlarmChange
            Every item, page after page.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        cursor: str | None = None
        while True:
            page = self.list_alarm_changes(alarm_id, limit=limit, cursor=cursor)
            yield from self.transport.listed(page, f"/api/v1/alarms/{segment(alarm_id)}/changes")
            cursor = page.get("next_cursor")
            if cursor is None:
                return

    def acknowledge_alarms(self, *, document: models.AcknowledgementRequest) -> models.Acknowledgements:
        """Take notice of several alarms, of all for which that is possible; 409 where it is for none.

        Parameters
        ----------
        document : AcknowledgementRequest
            What is wanted.

        Returns
        -------
        Acknowledgements
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.Acknowledgements",
            self.transport.document("POST", "/api/v1/alarms/acknowledgements", json=document),
        )

    def acknowledge_alarm(self, alarm_id: str, *, document: models.Remark | None = None) -> models.Alarm:
        """Take notice of an alarm.

        One whose cause is gone is over then.

        Parameters
        ----------
        alarm_id : str
            Alarm id.
        document : Remark or None
            What is wanted.

        Returns
        -------
        Alarm
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.Alarm",
            self.transport.document(
                "POST", f"/api/v1/alarms/{segment(alarm_id)}/acknowledgements", json=document
            ),
        )

    def shelve_alarm(self, alarm_id: str, *, document: models.ShelvingRequest) -> models.Alarm:
        """Set an alarm aside until a time, until its value has grown by so much, or what comes first.

        Of one that is shelved, this is the new end.

        Parameters
        ----------
        alarm_id : str
            Alarm id.
        document : ShelvingRequest
            What is wanted.

        Returns
        -------
        Alarm
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.Alarm",
            self.transport.document("PUT", f"/api/v1/alarms/{segment(alarm_id)}/shelving", json=document),
        )

    def unshelve_alarm(self, alarm_id: str, *, comment: str | None = None) -> models.Alarm:
        """End the shelving of an alarm: it calls for somebody again if its cause stands, and is over if not.

        Parameters
        ----------
        alarm_id : str
            Alarm id.
        comment : str or None
            Why; it is kept.

        Returns
        -------
        Alarm
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.Alarm",
            self.transport.document(
                "DELETE", f"/api/v1/alarms/{segment(alarm_id)}/shelving", query={"comment": comment}
            ),
        )

    def take_alarm_out_of_service(
        self, alarm_id: str, *, document: models.Remark | None = None
    ) -> models.Alarm:
        """Set an alarm aside until somebody puts it back, whatever its cause does meanwhile.

        Parameters
        ----------
        alarm_id : str
            Alarm id.
        document : Remark or None
            What is wanted.

        Returns
        -------
        Alarm
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.Alarm",
            self.transport.document(
                "PUT", f"/api/v1/alarms/{segment(alarm_id)}/out-of-service", json=document
            ),
        )

    def put_alarm_back_in_service(self, alarm_id: str, *, comment: str | None = None) -> models.Alarm:
        """Put an alarm back in service: it calls for somebody if its cause stands, and is over if not.

        Parameters
        ----------
        alarm_id : str
            Alarm id.
        comment : str or None
            Why; it is kept.

        Returns
        -------
        Alarm
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.Alarm",
            self.transport.document(
                "DELETE", f"/api/v1/alarms/{segment(alarm_id)}/out-of-service", query={"comment": comment}
            ),
        )

    def request_event_report(
        self, name: str, *, idempotency_key: str | None = None, document: models.RecordingWanted | None = None
    ) -> models.EventReport:
        """Request a recording from the motor's relay.

        Follow the request until it is diagnosed or failed. With `seconds` the relay makes a series of
        recordings that overlap, which are joined to one.

        Parameters
        ----------
        name : str
            Its name.
        idempotency_key : str or None
            The same key again gives the first recording request instead of another one.
        document : RecordingWanted or None
            What is wanted.

        Returns
        -------
        EventReport
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.EventReport",
            self.transport.document(
                "POST",
                f"/api/v1/motors/{segment(name)}/event-reports",
                headers={"idempotency-key": idempotency_key},
                json=document,
            ),
        )

    def list_event_reports(
        self, *, motor: str | None = None, limit: int | None = None, cursor: str | None = None
    ) -> models.PageEventReport:
        """Return the recording requests of one motor or of all motors, latest first.

        Parameters
        ----------
        motor : str or None
            Motor.
        limit : int or None
            Most items of this page.
        cursor : str or None
            `next_cursor` of the page before; without: the first page.

        Returns
        -------
        PageEventReport
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.PageEventReport",
            self.transport.document(
                "GET", "/api/v1/event-reports", query={"motor": motor, "limit": limit, "cursor": cursor}
            ),
        )

    def iter_event_reports(
        self, *, motor: str | None = None, limit: int | None = None
    ) -> Iterator[models.EventReport]:
        """Return the recording requests of one motor or of all motors, latest first.

        Parameters
        ----------
        motor : str or None
            Motor.
        limit : int or None
            Most items of this page.

        Yields
        ------
        EventReport
            Every item, page after page.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        cursor: str | None = None
        while True:
            page = self.list_event_reports(motor=motor, limit=limit, cursor=cursor)
            yield from self.transport.listed(page, "/api/v1/event-reports")
            cursor = page.get("next_cursor")
            if cursor is None:
                return

    def get_event_report(self, report_id: str) -> models.EventReport:
        """Return one recording request.

        Parameters
        ----------
        report_id : str
            Report id.

        Returns
        -------
        EventReport
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.EventReport",
            self.transport.document("GET", f"/api/v1/event-reports/{segment(report_id)}"),
        )

    def list_recordings(
        self,
        *,
        motor: str | None = None,
        state: models.RecordingState | None = None,
        operation: models.Operation | None = None,
        limit: int | None = None,
        cursor: str | None = None,
    ) -> models.PageListedRecording:
        """Return recordings, of one motor or of all, in one state or in any, of any operation, latest first.

        Parameters
        ----------
        motor : str or None
            Motor.
        state : RecordingState or None
            State.
        operation : Operation or None
            What the motor does in them.
        limit : int or None
            Most items of this page.
        cursor : str or None
            `next_cursor` of the page before; without: the first page.

        Returns
        -------
        PageListedRecording
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.PageListedRecording",
            self.transport.document(
                "GET",
                "/api/v1/recordings",
                query={
                    "motor": motor,
                    "state": state,
                    "operation": operation,
                    "limit": limit,
                    "cursor": cursor,
                },
            ),
        )

    def iter_recordings(
        self,
        *,
        motor: str | None = None,
        state: models.RecordingState | None = None,
        operation: models.Operation | None = None,
        limit: int | None = None,
    ) -> Iterator[models.ListedRecording]:
        """Return recordings, of one motor or of all, in one state or in any, of any operation, latest first.

        Parameters
        ----------
        motor : str or None
            Motor.
        state : RecordingState or None
            State.
        operation : Operation or None
            What the motor does in them.
        limit : int or None
            Most items of this page.

        Yields
        ------
        ListedRecording
            Every item, page after page.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        cursor: str | None = None
        while True:
            page = self.list_recordings(
                motor=motor, state=state, operation=operation, limit=limit, cursor=cursor
            )
            yield from self.transport.listed(page, "/api/v1/recordings")
            cursor = page.get("next_cursor")
            if cursor is None:
                return

    def upload_recording(
        self, *, motor: str, files: Mapping[str, bytes]
    ) -> tuple[int, models.RecordingDetails]:
        """Store the files of one recording and queue its diagnosis; one the motor has stays as it is.

        Parameters
        ----------
        motor : str
            The motor.
        files : Mapping[str, bytes]
            Contents of the files, by name.

        Returns
        -------
        tuple[int, RecordingDetails]
            HTTP status and document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        answer = self.transport.answer("POST", "/api/v1/recordings", form={"motor": motor}, files=files)
        return answer.status_code, cast("models.RecordingDetails", answer.json())

    def get_recording(self, recording_id: str) -> models.RecordingDetails:
        """Return one recording with its files and its latest diagnosis.

        Parameters
        ----------
        recording_id : str
            Recording id.

        Returns
        -------
        RecordingDetails
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.RecordingDetails",
            self.transport.document("GET", f"/api/v1/recordings/{segment(recording_id)}"),
        )

    def delete_recording(self, recording_id: str, *, reason: str) -> None:
        """Delete a recording with its files and diagnoses; it is not pulled from its relay again.

        Parameters
        ----------
        recording_id : str
            Recording id.
        reason : str
            Why, in words; it is kept with the time.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        self.transport.document(
            "DELETE", f"/api/v1/recordings/{segment(recording_id)}", query={"reason": reason}
        )

    def get_waveform(self, recording_id: str, *, points: int | None = None) -> models.Waveform:
        """Return the samples of a recording as the smallest and largest value of up to `points` intervals.

        Records of many channels have fewer intervals (setting max_waveform_values).

        Parameters
        ----------
        recording_id : str
            Recording id.
        points : int or None
            Most intervals a channel.

        Returns
        -------
        Waveform
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.Waveform",
            self.transport.document(
                "GET", f"/api/v1/recordings/{segment(recording_id)}/waveform", query={"points": points}
            ),
        )

    def download_recording(self, recording_id: str, sink: BinaryIO) -> int:
        """Return the files of a recording as they came from the relay, in a ZIP archive.

        The archive is named by the motor and the time of the recording.

        Parameters
        ----------
        recording_id : str
            Recording id.
        sink : BinaryIO
            Takes the file.

        Returns
        -------
        int
            Size of the file [bytes].

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return self.transport.save(f"/api/v1/recordings/{segment(recording_id)}/file", sink)

    def get_samples(
        self,
        recording_id: str,
        sink: BinaryIO,
        *,
        from_s: float | None = None,
        to_s: float | None = None,
        points: int | None = None,
    ) -> int:
        """Return a part of a recording as single-precision numbers: its samples, or extremes where they are more.

        Four bytes have the length of the head (unsigned, little-endian). The head is JSON; then follow the
        columns that it names, each of `count` little-endian single-precision numbers. Times count from
        `first_s`.

        Parameters
        ----------
        recording_id : str
            Recording id.
        sink : BinaryIO
            Takes the file.
        from_s : float or None
            Seconds after the first sample.
        to_s : float or None
            Seconds after the first sample.
        points : int or None
            Most values a column.

        Returns
        -------
        int
            Size of the file [bytes].

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return self.transport.save(
            f"/api/v1/recordings/{segment(recording_id)}/samples",
            sink,
            query={"from_s": from_s, "to_s": to_s, "points": points},
        )

    def get_model(
        self,
        recording_id: str,
        sink: BinaryIO,
        *,
        from_s: float | None = None,
        to_s: float | None = None,
        points: int | None = None,
    ) -> int:
        """Return the currents that the latest diagnosis's fit draws, and what they leave of the measured ones.

        As `samples`: columns of groups `measured`, `modelled` and `residual`, over the part of the
        recording that was compared. `residual_rms_A` of the head is what is left now; the diagnosis has
        that of its time.

        Parameters
        ----------
        recording_id : str
            Recording id.
        sink : BinaryIO
            Takes the file.
        from_s : float or None
            Seconds after the first sample.
        to_s : float or None
            Seconds after the first sample.
        points : int or None
            Most values a column.

        Returns
        -------
        int
            Size of the file [bytes].

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return self.transport.save(
            f"/api/v1/recordings/{segment(recording_id)}/model",
            sink,
            query={"from_s": from_s, "to_s": to_s, "points": points},
        )

    def download_csv(self, recording_id: str, sink: BinaryIO) -> int:
        """Return all samples and states of a recording as CSV, one line an instant.

        `time_s` counts from the first sample. Values are primary ones, with seven digits; what is missing
        is empty. Before a name that a spreadsheet would take for a formula stands an apostrophe.

        Parameters
        ----------
        recording_id : str
            Recording id.
        sink : BinaryIO
            Takes the file.

        Returns
        -------
        int
            Size of the file [bytes].

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return self.transport.save(f"/api/v1/recordings/{segment(recording_id)}/csv", sink)

    def get_phasors(self, recording_id: str, *, at_s: float | None = None) -> models.Phasors:
        """Return phasors and symmetrical components of the cycle around a time, or of the nearest whole one.

        Parameters
        ----------
        recording_id : str
            Recording id.
        at_s : float or None
            Seconds after the first sample.

        Returns
        -------
        Phasors
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.Phasors",
            self.transport.document(
                "GET", f"/api/v1/recordings/{segment(recording_id)}/phasors", query={"at_s": at_s}
            ),
        )

    def get_spectrum(self, recording_id: str, *, points: int | None = None) -> models.Spectrum:
        """Return the spectrum of the line currents, with the lines that matter for the motor.

        Parameters
        ----------
        recording_id : str
            Recording id.
        points : int or None
            Most values a column.

        Returns
        -------
        Spectrum
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.Spectrum",
            self.transport.document(
                "GET", f"/api/v1/recordings/{segment(recording_id)}/spectrum", query={"points": points}
            ),
        )

    def get_states(self, recording_id: str) -> models.States:
        """Return the states recorded beside the samples: contacts, relay word bits.

        Parameters
        ----------
        recording_id : str
            Recording id.

        Returns
        -------
        States
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.States",
            self.transport.document("GET", f"/api/v1/recordings/{segment(recording_id)}/states"),
        )

    def request_diagnosis(
        self, recording_id: str, *, document: models.DiagnosisRequest | None = None
    ) -> models.DiagnosisRun:
        """Queue another diagnosis of a stored recording; when done, it takes the place of the earlier one.

        Parameters
        ----------
        recording_id : str
            Recording id.
        document : DiagnosisRequest or None
            What is wanted.

        Returns
        -------
        DiagnosisRun
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.DiagnosisRun",
            self.transport.document(
                "POST", f"/api/v1/recordings/{segment(recording_id)}/diagnoses", json=document
            ),
        )

    def list_diagnoses(
        self, recording_id: str, *, limit: int | None = None, cursor: str | None = None
    ) -> models.PageDiagnosisRun:
        """Return the diagnoses of a recording, latest first.

        Parameters
        ----------
        recording_id : str
            Recording id.
        limit : int or None
            Most items of this page.
        cursor : str or None
            `next_cursor` of the page before; without: the first page.

        Returns
        -------
        PageDiagnosisRun
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.PageDiagnosisRun",
            self.transport.document(
                "GET",
                f"/api/v1/recordings/{segment(recording_id)}/diagnoses",
                query={"limit": limit, "cursor": cursor},
            ),
        )

    def iter_diagnoses(self, recording_id: str, *, limit: int | None = None) -> Iterator[models.DiagnosisRun]:
        """Return the diagnoses of a recording, latest first.

        Parameters
        ----------
        recording_id : str
            Recording id.
        limit : int or None
            Most items of this page.

        Yields
        ------
        DiagnosisRun
            Every item, page after page.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        cursor: str | None = None
        while True:
            page = self.list_diagnoses(recording_id, limit=limit, cursor=cursor)
            yield from self.transport.listed(page, f"/api/v1/recordings/{segment(recording_id)}/diagnoses")
            cursor = page.get("next_cursor")
            if cursor is None:
                return

    def get_diagnosis(self, recording_id: str, diagnosis_id: str) -> models.DiagnosisRun:
        """Return one diagnosis of a recording.

        Parameters
        ----------
        recording_id : str
            Recording id.
        diagnosis_id : str
            Diagnosis id.

        Returns
        -------
        DiagnosisRun
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.DiagnosisRun",
            self.transport.document(
                "GET", f"/api/v1/recordings/{segment(recording_id)}/diagnoses/{segment(diagnosis_id)}"
            ),
        )

    def list_job_runners(self) -> models.PageJobRunner:
        """Return the processes that have diagnoses made, on all hosts, by id; always one page.

        Returns
        -------
        PageJobRunner
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast("models.PageJobRunner", self.transport.document("GET", "/api/v1/job-runners"))

    def list_deletions(
        self, *, motor: str | None = None, limit: int | None = None, cursor: str | None = None
    ) -> models.PageDeletion:
        """Return the recordings that were deleted, of one motor or of all, latest first.

        Parameters
        ----------
        motor : str or None
            Motor.
        limit : int or None
            Most items of this page.
        cursor : str or None
            `next_cursor` of the page before; without: the first page.

        Returns
        -------
        PageDeletion
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.PageDeletion",
            self.transport.document(
                "GET", "/api/v1/deletions", query={"motor": motor, "limit": limit, "cursor": cursor}
            ),
        )

    def iter_deletions(
        self, *, motor: str | None = None, limit: int | None = None
    ) -> Iterator[models.Deletion]:
        """Return the recordings that were deleted, of one motor or of all, latest first.

        Parameters
        ----------
        motor : str or None
            Motor.
        limit : int or None
            Most items of this page.

        Yields
        ------
        Deletion
            Every item, page after page.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        cursor: str | None = None
        while True:
            page = self.list_deletions(motor=motor, limit=limit, cursor=cursor)
            yield from self.transport.listed(page, "/api/v1/deletions")
            cursor = page.get("next_cursor")
            if cursor is None:
                return

    def get_deletion(self, recording_id: str) -> models.Deletion:
        """Return what is remembered of one recording that was deleted.

        Parameters
        ----------
        recording_id : str
            Recording id.

        Returns
        -------
        Deletion
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.Deletion", self.transport.document("GET", f"/api/v1/deletions/{segment(recording_id)}")
        )

    def export_trend(
        self,
        sink: BinaryIO,
        *,
        motor: Sequence[str] | None = None,
        from_: datetime | str | None = None,
        to: datetime | str | None = None,
        format_: models.Format | None = None,
    ) -> int:
        """Return what each recording says, of one motor after another, oldest first.

        Parameters
        ----------
        sink : BinaryIO
            Takes the file.
        motor : Sequence[str] or None
            Only these, in this order; without: all.
        from_ : datetime | str or None
            First time.
        to : datetime | str or None
            First time not to be included.
        format_ : Format or None
            Without: by the header Accept, else CSV.

        Returns
        -------
        int
            Size of the file [bytes].

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return self.transport.save(
            "/api/v1/exports/trend", sink, query={"motor": motor, "from": from_, "to": to, "format": format_}
        )

    def export_measurements(
        self,
        sink: BinaryIO,
        *,
        motor: Sequence[str] | None = None,
        step: models.AveragingStep | None = None,
        from_: datetime | str | None = None,
        to: datetime | str | None = None,
        format_: models.Format | None = None,
    ) -> int:
        """Return what the relays measure all the time, of one motor after another, oldest first.

        Parameters
        ----------
        sink : BinaryIO
            Takes the file.
        motor : Sequence[str] or None
            Only these, in this order; without: all.
        step : AveragingStep or None
            0: as sampled; 60, 900: means of so many seconds, kept for longer.
        from_ : datetime | str or None
            First time.
        to : datetime | str or None
            First time not to be included.
        format_ : Format or None
            Without: by the header Accept, else CSV.

        Returns
        -------
        int
            Size of the file [bytes].

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return self.transport.save(
            "/api/v1/exports/measurements",
            sink,
            query={"motor": motor, "step": step, "from": from_, "to": to, "format": format_},
        )

    def export_recordings(
        self, sink: BinaryIO, *, motor: Sequence[str] | None = None, format_: models.Format | None = None
    ) -> int:
        """Return the recordings with their verdicts, of one motor after another or of all, latest first.

        Parameters
        ----------
        sink : BinaryIO
            Takes the file.
        motor : Sequence[str] or None
            Only these, in this order; without: all.
        format_ : Format or None
            Without: by the header Accept, else CSV.

        Returns
        -------
        int
            Size of the file [bytes].

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return self.transport.save(
            "/api/v1/exports/recordings", sink, query={"motor": motor, "format": format_}
        )

    def export_starts(
        self, sink: BinaryIO, *, motor: Sequence[str] | None = None, format_: models.Format | None = None
    ) -> int:
        """Return the starts with their figures, of one motor after another or of all, latest first.

        Parameters
        ----------
        sink : BinaryIO
            Takes the file.
        motor : Sequence[str] or None
            Only these, in this order; without: all.
        format_ : Format or None
            Without: by the header Accept, else CSV.

        Returns
        -------
        int
            Size of the file [bytes].

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return self.transport.save("/api/v1/exports/starts", sink, query={"motor": motor, "format": format_})

    def export_alarms(
        self, sink: BinaryIO, *, motor: Sequence[str] | None = None, format_: models.Format | None = None
    ) -> int:
        """Return the alarms, of one motor after another or of all, latest first.

        Parameters
        ----------
        sink : BinaryIO
            Takes the file.
        motor : Sequence[str] or None
            Only these, in this order; without: all.
        format_ : Format or None
            Without: by the header Accept, else CSV.

        Returns
        -------
        int
            Size of the file [bytes].

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return self.transport.save("/api/v1/exports/alarms", sink, query={"motor": motor, "format": format_})

    def get_fleet_report(
        self,
        sink: BinaryIO,
        *,
        period: Literal["daily", "weekly"] | None = None,
        until: datetime | str | None = None,
        site: Sequence[str] | None = None,
        format_: models.ReportFormat | None = None,
    ) -> int:
        """Return how all motors were at a time, and what happened in the day or week before.

        Parameters
        ----------
        sink : BinaryIO
            Takes the file.
        period : Literal["daily", "weekly"] or None
            Period.
        until : datetime | str or None
            Nothing later is told; without: now.
        site : Sequence[str] or None
            Only these sites; without: all.
        format_ : ReportFormat or None
            PDF, or an Excel workbook.

        Returns
        -------
        int
            Size of the file [bytes].

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return self.transport.save(
            "/api/v1/reports/fleet",
            sink,
            query={"period": period, "until": until, "site": site, "format": format_},
        )

    def get_motor_report(
        self,
        name: str,
        sink: BinaryIO,
        *,
        until: datetime | str | None = None,
        format_: models.ReportFormat | None = None,
    ) -> int:
        """Return all of one motor until a time, with its pictures.

        Parameters
        ----------
        name : str
            Its name.
        sink : BinaryIO
            Takes the file.
        until : datetime | str or None
            Nothing later is told; without: now.
        format_ : ReportFormat or None
            PDF, or an Excel workbook.

        Returns
        -------
        int
            Size of the file [bytes].

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return self.transport.save(
            f"/api/v1/reports/motors/{segment(name)}", sink, query={"until": until, "format": format_}
        )

    def get_alarms_report(
        self,
        sink: BinaryIO,
        *,
        month: str | None = None,
        site: Sequence[str] | None = None,
        format_: models.ReportFormat | None = None,
    ) -> int:
        """Return all calls of alarms in a month, and what became of each until the month's end or now.

        Parameters
        ----------
        sink : BinaryIO
            Takes the file.
        month : str or None
            Such as 2026-11, in the time zone of the settings; without: this one.
        site : Sequence[str] or None
            Only these sites; without: all.
        format_ : ReportFormat or None
            PDF, or an Excel workbook.

        Returns
        -------
        int
            Size of the file [bytes].

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return self.transport.save(
            "/api/v1/reports/alarms", sink, query={"month": month, "site": site, "format": format_}
        )

    def list_notifications(
        self,
        *,
        state: models.NotificationState | None = None,
        channel: str | None = None,
        alarm: str | None = None,
        limit: int | None = None,
        cursor: str | None = None,
    ) -> models.PageNotification:
        """Return the messages, latest first: what was sent to whom, what waits, and what was given up.

        Parameters
        ----------
        state : NotificationState or None
            Only those in this state.
        channel : str or None
            Only those of this channel of the settings.
        alarm : str or None
            Only those that told of this alarm.
        limit : int or None
            Most items of this page.
        cursor : str or None
            `next_cursor` of the page before; without: the first page.

        Returns
        -------
        PageNotification
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.PageNotification",
            self.transport.document(
                "GET",
                "/api/v1/notifications",
                query={"state": state, "channel": channel, "alarm": alarm, "limit": limit, "cursor": cursor},
            ),
        )

    def iter_notifications(
        self,
        *,
        state: models.NotificationState | None = None,
        channel: str | None = None,
        alarm: str | None = None,
        limit: int | None = None,
    ) -> Iterator[models.Notification]:
        """Return the messages, latest first: what was sent to whom, what waits, and what was given up.

        Parameters
        ----------
        state : NotificationState or None
            Only those in this state.
        channel : str or None
            Only those of this channel of the settings.
        alarm : str or None
            Only those that told of this alarm.
        limit : int or None
            Most items of this page.

        Yields
        ------
        Notification
            Every item, page after page.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        cursor: str | None = None
        while True:
            page = self.list_notifications(
                state=state, channel=channel, alarm=alarm, limit=limit, cursor=cursor
            )
            yield from self.transport.listed(page, "/api/v1/notifications")
            cursor = page.get("next_cursor")
            if cursor is None:
                return

    def get_notification(self, notification_id: str) -> models.NotificationDetails:
        """Return one message, with the alarms that it tells of.

        Parameters
        ----------
        notification_id : str
            Notification id.

        Returns
        -------
        NotificationDetails
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.NotificationDetails",
            self.transport.document("GET", f"/api/v1/notifications/{segment(notification_id)}"),
        )

    def retry_notification(self, notification_id: str) -> models.Notification:
        """Try a message again that was given up; 409 where it was not.

        Parameters
        ----------
        notification_id : str
            Notification id.

        Returns
        -------
        Notification
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.Notification",
            self.transport.document("POST", f"/api/v1/notifications/{segment(notification_id)}/attempts"),
        )

    def list_channels(self) -> models.PageNotificationChannel:
        """Return the channels of the settings; always one page.

        Returns
        -------
        PageNotificationChannel
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.PageNotificationChannel", self.transport.document("GET", "/api/v1/notification-channels")
        )

    def send_test(self, name: str) -> models.PageNotification:
        """Have a test message sent to each receiver of a channel; it is tried once.

        What becomes of it is seen in `notifications/{notification_id}`.

        Parameters
        ----------
        name : str
            Its name.

        Returns
        -------
        PageNotification
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.PageNotification",
            self.transport.document("POST", f"/api/v1/notification-channels/{segment(name)}/tests"),
        )

    def list_audit_entries(
        self,
        *,
        actor: str | None = None,
        action: models.AuditAction | None = None,
        subject: str | None = None,
        from_: datetime | str | None = None,
        to: datetime | str | None = None,
        limit: int | None = None,
        cursor: str | None = None,
    ) -> models.PageAuditEntry:
        """Return who changed what, latest first.

        Parameters
        ----------
        actor : str or None
            Actor.
        action : AuditAction or None
            Action.
        subject : str or None
            Name or id of what was changed.
        from_ : datetime | str or None
            First time.
        to : datetime | str or None
            First time not to be included.
        limit : int or None
            Most items of this page.
        cursor : str or None
            `next_cursor` of the page before; without: the first page.

        Returns
        -------
        PageAuditEntry
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.PageAuditEntry",
            self.transport.document(
                "GET",
                "/api/v1/audit/entries",
                query={
                    "actor": actor,
                    "action": action,
                    "subject": subject,
                    "from": from_,
                    "to": to,
                    "limit": limit,
                    "cursor": cursor,
                },
            ),
        )

    def iter_audit_entries(
        self,
        *,
        actor: str | None = None,
        action: models.AuditAction | None = None,
        subject: str | None = None,
        from_: datetime | str | None = None,
        to: datetime | str | None = None,
        limit: int | None = None,
    ) -> Iterator[models.AuditEntry]:
        """Return who changed what, latest first.

        Parameters
        ----------
        actor : str or None
            Actor.
        action : AuditAction or None
            Action.
        subject : str or None
            Name or id of what was changed.
        from_ : datetime | str or None
            First time.
        to : datetime | str or None
            First time not to be included.
        limit : int or None
            Most items of this page.

        Yields
        ------
        AuditEntry
            Every item, page after page.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        cursor: str | None = None
        while True:
            page = self.list_audit_entries(
                actor=actor, action=action, subject=subject, from_=from_, to=to, limit=limit, cursor=cursor
            )
            yield from self.transport.listed(page, "/api/v1/audit/entries")
            cursor = page.get("next_cursor")
            if cursor is None:
                return

    def get_audit_head(self) -> models.AuditState:
        """Return number and hash of the last entry.

        Keep them elsewhere to verify the trail against.

        Returns
        -------
        AuditState
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast("models.AuditState", self.transport.document("GET", "/api/v1/audit/head"))

    def export_audit_trail(self, *, first: int | None = None, last: int | None = None) -> Iterator[str]:
        """Return all entries, oldest first, one a line of canonical JSON: what was hashed, and the hash.

        What is added while the answer is sent is not in it.

        Parameters
        ----------
        first : int or None
            Number of the first entry.
        last : int or None
            Number of the last; without: the latest.

        Returns
        -------
        str
            The lines, while they come.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return self.transport.lines("/api/v1/audit/export", query={"first": first, "last": last})

    def verify_audit_trail(
        self, *, number: int | None = None, hash_: str | None = None
    ) -> models.AuditVerification:
        """Read the whole trail, and return whether every entry is as it was written.

        A trail that was computed anew, or whose end was cut off together with its head, is found only with
        an entry that was kept elsewhere: its number and its hash.

        Parameters
        ----------
        number : int or None
            An entry that was kept elsewhere.
        hash_ : str or None
            And its hash.

        Returns
        -------
        AuditVerification
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.AuditVerification",
            self.transport.document(
                "GET", "/api/v1/audit/verification", query={"number": number, "hash": hash_}
            ),
        )

    def list_backups(self, *, limit: int | None = None, cursor: str | None = None) -> models.PageBackup:
        """Return the back-ups of the service's data, latest first.

        Parameters
        ----------
        limit : int or None
            Most items of this page.
        cursor : str or None
            `next_cursor` of the page before; without: the first page.

        Returns
        -------
        PageBackup
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.PageBackup",
            self.transport.document("GET", "/api/v1/backups", query={"limit": limit, "cursor": cursor}),
        )

    def iter_backups(self, *, limit: int | None = None) -> Iterator[models.Backup]:
        """Return the back-ups of the service's data, latest first.

        Parameters
        ----------
        limit : int or None
            Most items of this page.

        Yields
        ------
        Backup
            Every item, page after page.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        cursor: str | None = None
        while True:
            page = self.list_backups(limit=limit, cursor=cursor)
            yield from self.transport.listed(page, "/api/v1/backups")
            cursor = page.get("next_cursor")
            if cursor is None:
                return

    def get_login_ways(self) -> models.LoginWays:
        """Return how one logs in here.

        Returns
        -------
        LoginWays
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast("models.LoginWays", self.transport.document("GET", "/api/v1/login"))

    def log_in(self, *, document: models.LoginRequest) -> models.Account:
        """Begin a session, with a name and a password; the answer's cookie is its secret.

        Parameters
        ----------
        document : LoginRequest
            What is wanted.

        Returns
        -------
        Account
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast("models.Account", self.transport.document("POST", "/api/v1/login", json=document))

    def log_out(self) -> None:
        """End the session that the request has; harmless without one.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        self.transport.document("POST", "/api/v1/logout")

    def get_account(self) -> models.Account:
        """Return who asks, and what they may do.

        Returns
        -------
        Account
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast("models.Account", self.transport.document("GET", "/api/v1/account"))

    def change_password(self, *, document: models.PasswordChange) -> None:
        """Change the own password; all own sessions end, this one too.

        Parameters
        ----------
        document : PasswordChange
            What is wanted.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        self.transport.document("PUT", "/api/v1/account/password", json=document)

    def list_own_tokens(self, *, limit: int | None = None, cursor: str | None = None) -> models.PageToken:
        """Return the own tokens, without their secrets.

        Parameters
        ----------
        limit : int or None
            Most items of this page.
        cursor : str or None
            `next_cursor` of the page before; without: the first page.

        Returns
        -------
        PageToken
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.PageToken",
            self.transport.document(
                "GET", "/api/v1/account/tokens", query={"limit": limit, "cursor": cursor}
            ),
        )

    def iter_own_tokens(self, *, limit: int | None = None) -> Iterator[models.Token]:
        """Return the own tokens, without their secrets.

        Parameters
        ----------
        limit : int or None
            Most items of this page.

        Yields
        ------
        Token
            Every item, page after page.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        cursor: str | None = None
        while True:
            page = self.list_own_tokens(limit=limit, cursor=cursor)
            yield from self.transport.listed(page, "/api/v1/account/tokens")
            cursor = page.get("next_cursor")
            if cursor is None:
                return

    def add_own_token(self, *, document: models.TokenRequest) -> models.NewToken:
        """Make a token that may do no more than who asks for it.

        Its secret is shown this once.

        Parameters
        ----------
        document : TokenRequest
            What is wanted.

        Returns
        -------
        NewToken
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.NewToken", self.transport.document("POST", "/api/v1/account/tokens", json=document)
        )

    def revoke_own_token(self, token_id: str) -> None:
        """End one of the own tokens.

        Parameters
        ----------
        token_id : str
            Token id.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        self.transport.document("DELETE", f"/api/v1/account/tokens/{segment(token_id)}")

    def list_tokens(self, *, limit: int | None = None, cursor: str | None = None) -> models.PageToken:
        """Return the tokens of all users, without their secrets.

        Parameters
        ----------
        limit : int or None
            Most items of this page.
        cursor : str or None
            `next_cursor` of the page before; without: the first page.

        Returns
        -------
        PageToken
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.PageToken",
            self.transport.document("GET", "/api/v1/tokens", query={"limit": limit, "cursor": cursor}),
        )

    def iter_tokens(self, *, limit: int | None = None) -> Iterator[models.Token]:
        """Return the tokens of all users, without their secrets.

        Parameters
        ----------
        limit : int or None
            Most items of this page.

        Yields
        ------
        Token
            Every item, page after page.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        cursor: str | None = None
        while True:
            page = self.list_tokens(limit=limit, cursor=cursor)
            yield from self.transport.listed(page, "/api/v1/tokens")
            cursor = page.get("next_cursor")
            if cursor is None:
                return

    def add_token(self, name: str, *, document: models.TokenRequest) -> models.NewToken:
        """Make a token of a user, such as one that stands for a program.

        Its secret is shown this once.

        Parameters
        ----------
        name : str
            Its name.
        document : TokenRequest
            What is wanted.

        Returns
        -------
        NewToken
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.NewToken",
            self.transport.document("POST", f"/api/v1/users/{segment(name)}/tokens", json=document),
        )

    def revoke_token(self, token_id: str) -> None:
        """End a token of whomever.

        Parameters
        ----------
        token_id : str
            Token id.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        self.transport.document("DELETE", f"/api/v1/tokens/{segment(token_id)}")

    def list_users(self, *, limit: int | None = None, cursor: str | None = None) -> models.PageUser:
        """Return the users, by name.

        Parameters
        ----------
        limit : int or None
            Most items of this page.
        cursor : str or None
            `next_cursor` of the page before; without: the first page.

        Returns
        -------
        PageUser
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.PageUser",
            self.transport.document("GET", "/api/v1/users", query={"limit": limit, "cursor": cursor}),
        )

    def iter_users(self, *, limit: int | None = None) -> Iterator[models.User]:
        """Return the users, by name.

        Parameters
        ----------
        limit : int or None
            Most items of this page.

        Yields
        ------
        User
            Every item, page after page.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        cursor: str | None = None
        while True:
            page = self.list_users(limit=limit, cursor=cursor)
            yield from self.transport.listed(page, "/api/v1/users")
            cursor = page.get("next_cursor")
            if cursor is None:
                return

    def add_user(self, *, document: models.UserRequest) -> models.User:
        """Make a user.

        Parameters
        ----------
        document : UserRequest
            What is wanted.

        Returns
        -------
        User
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast("models.User", self.transport.document("POST", "/api/v1/users", json=document))

    def get_user(self, name: str) -> models.User:
        """Return one user.

        Parameters
        ----------
        name : str
            Its name.

        Returns
        -------
        User
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast("models.User", self.transport.document("GET", f"/api/v1/users/{segment(name)}"))

    def change_user(self, name: str, *, document: models.UserChange) -> models.User:
        """Change a user's name or roles, disable or enable them; other roles end their sessions.

        Parameters
        ----------
        name : str
            Its name.
        document : UserChange
            What is wanted.

        Returns
        -------
        User
            The document.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        return cast(
            "models.User", self.transport.document("PATCH", f"/api/v1/users/{segment(name)}", json=document)
        )

    def delete_user(self, name: str) -> None:
        """Delete a user with their sessions and tokens; what they did stays in the audit trail.

        Parameters
        ----------
        name : str
            Its name.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        self.transport.document("DELETE", f"/api/v1/users/{segment(name)}")

    def set_password(self, name: str, *, document: models.NewPassword) -> None:
        """Give a user another password; their sessions end.

        Parameters
        ----------
        name : str
            Its name.
        document : NewPassword
            What is wanted.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        self.transport.document("PUT", f"/api/v1/users/{segment(name)}/password", json=document)

    def end_sessions(self, name: str) -> None:
        """End all sessions of a user; their tokens stay.

        Parameters
        ----------
        name : str
            Its name.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        self.transport.document("DELETE", f"/api/v1/users/{segment(name)}/sessions")

    def unlock_user(self, name: str) -> None:
        """Forget the failed logins of a user, so that they may try again at once.

        Parameters
        ----------
        name : str
            Its name.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        self.transport.document("DELETE", f"/api/v1/users/{segment(name)}/lock")
