# Generated from the service's OpenAPI document by `make client`. Do not edit.
"""The functions of AsyncClient, one for each route."""

from __future__ import annotations

from collections.abc import AsyncIterator, Mapping, Sequence
from contextlib import AbstractAsyncContextManager
from typing import TYPE_CHECKING, Any, Literal

from statorwatch_client.requests import Request, Time, segment

if TYPE_CHECKING:
    from statorwatch_client import models
    from statorwatch_client.async_client import AsyncDownload


class AsyncOperations:
    """What a service can be asked. The class that inherits this one sends the requests."""

    async def _document(self, request: Request) -> Any:
        """Return the document that answers."""
        raise NotImplementedError

    async def _new_document(self, request: Request) -> tuple[Any, bool]:
        """Return the document that answers, and whether what it tells of is new."""
        raise NotImplementedError

    async def _done(self, request: Request) -> None:
        """Send what is answered without a document."""
        raise NotImplementedError

    def _items(self, request: Request) -> AsyncIterator[Any]:
        """Yield the items of a list, page after page."""
        raise NotImplementedError

    def _file(self, request: Request) -> AbstractAsyncContextManager[AsyncDownload]:
        """Return the file that answers, while it comes."""
        raise NotImplementedError

    def list_sites(self, *, limit: int | None = None) -> AsyncIterator[models.Site]:
        """Return the sites (substations of the plant's SCD), by name.

        Parameters
        ----------
        limit
            Most items that are asked for at once; the list goes on all the same. Without: 100.
        """
        return self._items(Request("GET", "/api/v1/sites", query={"limit": limit}))

    def list_motors(
        self, *, health: bool | None = None, limit: int | None = None
    ) -> AsyncIterator[models.ListedMotor]:
        """Return the motors, by name.

        Parameters
        ----------
        health
            With the health of each, as `motors/{name}/health`. Without: false.
        limit
            Most items that are asked for at once; the list goes on all the same. Without: 100.
        """
        return self._items(Request("GET", "/api/v1/motors", query={"health": health, "limit": limit}))

    async def get_motor(self, motor: str) -> models.Motor:
        """Return one motor, with its stator winding where that is known.

        Parameters
        ----------
        motor
            Name of the motor.
        """
        answer: models.Motor = await self._document(Request("GET", f"/api/v1/motors/{segment(motor)}"))
        return answer

    async def get_health(self, motor: str) -> models.Health:
        """Return a motor's condition, what its latest recording says by itself, and whether its relay answers.

        Parameters
        ----------
        motor
            Name of the motor.
        """
        answer: models.Health = await self._document(
            Request("GET", f"/api/v1/motors/{segment(motor)}/health")
        )
        return answer

    def get_trend(
        self,
        motor: str,
        *,
        quantity: Literal[
            "mu_f",
            "theta_f",
            "load_level",
            "condition_level",
            "change",
            "rotor_severity_dB",
            "rotor_lower_sideband_dB",
            "rotor_upper_sideband_dB",
            "load_oscillation_dB",
            "slip",
            "gap_permeance_ripple",
            "gap_lower_sideband_dB",
            "gap_upper_sideband_dB",
            "turn_load_torque",
            "turn_frequency_hz",
            "swing_load_torque",
            "swing_noise",
            "swing_frequency_hz",
            "frequency_hz",
            "voltage_deviation",
            "voltage_unbalance_iec",
            "voltage_unbalance_nema",
            "derating",
            "thd_voltage",
            "harmonic_voltage_factor",
            "current_unbalance",
            "thd_current",
            "active_power_W",
            "power_factor",
            "efficiency",
            "losses_W",
            "output_W",
            "turns_loss_W",
            "unbalance_loss_W",
            "voltage_loss_W",
            "rotor_loss_W",
            "stator_resistance_change",
            "rotor_resistance_change",
            "magnetising_inductance_change",
            "leakage_inductance_change",
        ]
        | None = None,
        from_: Time | None = None,
        to: Time | None = None,
        limit: int | None = None,
    ) -> AsyncIterator[models.TrendPoint]:
        """Return one figure for each recording of a motor, oldest first.

        `condition_level`, `change` and those that end with `_change` are what was said of the motor from that
        recording on; the others are what the recording says by itself. A file has them all, whatever `quantity`
        is.

        Parameters
        ----------
        motor
            Name of the motor.
        quantity
            `quantity` of the request. Without: mu_f.
        from_
            First time.
        to
            First time not to be included.
        limit
            Most items that are asked for at once; the list goes on all the same. Without: 100.
        """
        return self._items(
            Request(
                "GET",
                f"/api/v1/motors/{segment(motor)}/trend",
                query={"quantity": quantity, "from": from_, "to": to, "limit": limit},
            )
        )

    def get_trend_file(
        self,
        motor: str,
        *,
        quantity: Literal[
            "mu_f",
            "theta_f",
            "load_level",
            "condition_level",
            "change",
            "rotor_severity_dB",
            "rotor_lower_sideband_dB",
            "rotor_upper_sideband_dB",
            "load_oscillation_dB",
            "slip",
            "gap_permeance_ripple",
            "gap_lower_sideband_dB",
            "gap_upper_sideband_dB",
            "turn_load_torque",
            "turn_frequency_hz",
            "swing_load_torque",
            "swing_noise",
            "swing_frequency_hz",
            "frequency_hz",
            "voltage_deviation",
            "voltage_unbalance_iec",
            "voltage_unbalance_nema",
            "derating",
            "thd_voltage",
            "harmonic_voltage_factor",
            "current_unbalance",
            "thd_current",
            "active_power_W",
            "power_factor",
            "efficiency",
            "losses_W",
            "output_W",
            "turns_loss_W",
            "unbalance_loss_W",
            "voltage_loss_W",
            "rotor_loss_W",
            "stator_resistance_change",
            "rotor_resistance_change",
            "magnetising_inductance_change",
            "leakage_inductance_change",
        ]
        | None = None,
        from_: Time | None = None,
        to: Time | None = None,
        format: Literal["csv", "xlsx", "parquet"],
    ) -> AbstractAsyncContextManager[AsyncDownload]:
        """Return one figure for each recording of a motor, oldest first.

        `condition_level`, `change` and those that end with `_change` are what was said of the motor from that
        recording on; the others are what the recording says by itself. A file has them all, whatever `quantity`
        is.

        The answer is a file, which is read inside a `with` statement.

        Parameters
        ----------
        motor
            Name of the motor.
        quantity
            `quantity` of the request. Without: mu_f.
        from_
            First time.
        to
            First time not to be included.
        format
            What kind of file it is to be.
        """
        return self._file(
            Request(
                "GET",
                f"/api/v1/motors/{segment(motor)}/trend",
                query={"quantity": quantity, "from": from_, "to": to, "format": format},
            )
        )

    def list_recordings_of_motor(
        self, motor: str, *, operation: models.Operation | None = None, limit: int | None = None
    ) -> AsyncIterator[models.ListedRecording]:
        """Return the recordings of a motor, latest first.

        Parameters
        ----------
        motor
            Name of the motor.
        operation
            What the motor does in them.
        limit
            Most items that are asked for at once; the list goes on all the same. Without: 100.
        """
        return self._items(
            Request(
                "GET",
                f"/api/v1/motors/{segment(motor)}/recordings",
                query={"operation": operation, "limit": limit},
            )
        )

    def list_recordings_of_motor_file(
        self,
        motor: str,
        *,
        operation: models.Operation | None = None,
        format: Literal["csv", "xlsx", "parquet"],
    ) -> AbstractAsyncContextManager[AsyncDownload]:
        """Return the recordings of a motor, latest first.

        The answer is a file, which is read inside a `with` statement.

        Parameters
        ----------
        motor
            Name of the motor.
        operation
            What the motor does in them.
        format
            What kind of file it is to be.
        """
        return self._file(
            Request(
                "GET",
                f"/api/v1/motors/{segment(motor)}/recordings",
                query={"operation": operation, "format": format},
            )
        )

    async def get_condition(self, motor: str, *, history: int | None = None) -> models.ConditionDetails:
        """Return the condition of a motor over time, with what was said from each of its latest records on.

        Parameters
        ----------
        motor
            Name of the motor.
        history
            With so many of the latest records. Without: 20.
        """
        answer: models.ConditionDetails = await self._document(
            Request("GET", f"/api/v1/motors/{segment(motor)}/condition", query={"history": history})
        )
        return answer

    def list_condition_history(
        self, motor: str, *, limit: int | None = None
    ) -> AsyncIterator[models.ConditionChange]:
        """Return the changes of a motor's condition with what caused each, latest first.

        Parameters
        ----------
        motor
            Name of the motor.
        limit
            Most items that are asked for at once; the list goes on all the same. Without: 100.
        """
        return self._items(
            Request("GET", f"/api/v1/motors/{segment(motor)}/condition/history", query={"limit": limit})
        )

    def list_notes(self, motor: str, *, limit: int | None = None) -> AsyncIterator[models.Note]:
        """Return what people told of a motor, and what its files told, latest first.

        Parameters
        ----------
        motor
            Name of the motor.
        limit
            Most items that are asked for at once; the list goes on all the same. Without: 100.
        """
        return self._items(Request("GET", f"/api/v1/motors/{segment(motor)}/notes", query={"limit": limit}))

    async def add_note(self, motor: str, document: models.NoteRequest) -> models.Note:
        """Keep what a person tells of a motor; its condition follows within seconds.

        All kinds but `note` change what the condition follows from, and need the permission `configure`.

        Parameters
        ----------
        motor
            Name of the motor.
        document
            What is sent.
        """
        answer: models.Note = await self._document(
            Request("POST", f"/api/v1/motors/{segment(motor)}/notes", json=document)
        )
        return answer

    async def get_note(self, motor: str, note_id: str) -> models.Note:
        """Return one note.

        Parameters
        ----------
        motor
            Name of the motor.
        note_id
            As a document tells it.
        """
        answer: models.Note = await self._document(
            Request("GET", f"/api/v1/motors/{segment(motor)}/notes/{segment(note_id)}")
        )
        return answer

    async def withdraw_note(self, motor: str, note_id: str, document: models.Withdrawal) -> models.Note:
        """Let a note that was wrong count no more; the condition follows as if nobody had told it.

        Parameters
        ----------
        motor
            Name of the motor.
        note_id
            As a document tells it.
        document
            What is sent.
        """
        answer: models.Note = await self._document(
            Request(
                "POST", f"/api/v1/motors/{segment(motor)}/notes/{segment(note_id)}/withdrawal", json=document
            )
        )
        return answer

    async def restart_reference(self, motor: str, document: models.RestartRequest) -> models.Note:
        """Take the motor for healthy as it is: its standing asymmetry is learnt anew. The answer is a note.

        Parameters
        ----------
        motor
            Name of the motor.
        document
            What is sent.
        """
        answer: models.Note = await self._document(
            Request("POST", f"/api/v1/motors/{segment(motor)}/reference", json=document)
        )
        return answer

    async def undo_note(self, motor: str, note_id: str) -> models.Note:
        """Undo within ten minutes what the same account did to a note: that it was written, or retracted.

        One that was written is withdrawn; one that was retracted is kept again, as a new note of the same time.

        Parameters
        ----------
        motor
            Name of the motor.
        note_id
            As a document tells it.
        """
        answer: models.Note = await self._document(
            Request("POST", f"/api/v1/motors/{segment(motor)}/notes/{segment(note_id)}/undo")
        )
        return answer

    async def get_planned_stop(self, motor: str) -> models.PlannedStop:
        """Return when a motor stops next: by its own plan, or by that of its site where it is earlier.

        Parameters
        ----------
        motor
            Name of the motor.
        """
        answer: models.PlannedStop = await self._document(
            Request("GET", f"/api/v1/motors/{segment(motor)}/planned-stop")
        )
        return answer

    async def plan_stop(self, motor: str, document: models.StopRequest) -> models.PlannedStop:
        """Plan when a motor stops next, in place of an earlier plan; its condition answers for that time.

        Parameters
        ----------
        motor
            Name of the motor.
        document
            What is sent.
        """
        answer: models.PlannedStop = await self._document(
            Request("PUT", f"/api/v1/motors/{segment(motor)}/planned-stop", json=document)
        )
        return answer

    async def cancel_stop(self, motor: str) -> None:
        """Drop the plan of a motor's stop; that of its site stays.

        Parameters
        ----------
        motor
            Name of the motor.
        """
        await self._done(Request("DELETE", f"/api/v1/motors/{segment(motor)}/planned-stop"))

    async def get_planned_stop_of_site(self, site: str) -> models.PlannedStop:
        """Return when all motors of a site stop next.

        Parameters
        ----------
        site
            Name of the site.
        """
        answer: models.PlannedStop = await self._document(
            Request("GET", f"/api/v1/sites/{segment(site)}/planned-stop")
        )
        return answer

    async def plan_stop_of_site(self, site: str, document: models.StopRequest) -> models.PlannedStop:
        """Plan when all motors of a site stop next, in place of an earlier plan.

        Parameters
        ----------
        site
            Name of the site.
        document
            What is sent.
        """
        answer: models.PlannedStop = await self._document(
            Request("PUT", f"/api/v1/sites/{segment(site)}/planned-stop", json=document)
        )
        return answer

    async def cancel_stop_of_site(self, site: str) -> None:
        """Drop the plan of a site's stop; those of its motors stay.

        Parameters
        ----------
        site
            Name of the site.
        """
        await self._done(Request("DELETE", f"/api/v1/sites/{segment(site)}/planned-stop"))

    def list_inspections(self, motor: str, *, limit: int | None = None) -> AsyncIterator[models.Inspection]:
        """Return what inspections of a motor found, latest first; those that were withdrawn as well.

        Parameters
        ----------
        motor
            Name of the motor.
        limit
            Most items that are asked for at once; the list goes on all the same. Without: 100.
        """
        return self._items(
            Request("GET", f"/api/v1/motors/{segment(motor)}/inspections", query={"limit": limit})
        )

    async def add_inspection(self, motor: str, document: models.InspectionRequest) -> models.Inspection:
        """Keep what an inspection of a motor found. It is counted, and no judgement follows from it.

        Parameters
        ----------
        motor
            Name of the motor.
        document
            What is sent.
        """
        answer: models.Inspection = await self._document(
            Request("POST", f"/api/v1/motors/{segment(motor)}/inspections", json=document)
        )
        return answer

    async def get_inspection(self, motor: str, inspection_id: str) -> models.Inspection:
        """Return one inspection.

        Parameters
        ----------
        motor
            Name of the motor.
        inspection_id
            As a document tells it.
        """
        answer: models.Inspection = await self._document(
            Request("GET", f"/api/v1/motors/{segment(motor)}/inspections/{segment(inspection_id)}")
        )
        return answer

    async def add_inspection_picture(
        self, motor: str, inspection_id: str, content: bytes
    ) -> models.Inspection:
        """Keep a picture of an inspection, which has at most four.

        Parameters
        ----------
        motor
            Name of the motor.
        inspection_id
            As a document tells it.
        content
            A PNG or JPEG, known by its content.
        """
        answer: models.Inspection = await self._document(
            Request(
                "POST",
                f"/api/v1/motors/{segment(motor)}/inspections/{segment(inspection_id)}/pictures",
                content=content,
                headers={"Content-Type": "application/octet-stream"},
            )
        )
        return answer

    def get_inspection_picture(
        self, motor: str, inspection_id: str, number: str
    ) -> AbstractAsyncContextManager[AsyncDownload]:
        """Return a picture of an inspection.

        The answer is a file, which is read inside a `with` statement.

        Parameters
        ----------
        motor
            Name of the motor.
        inspection_id
            As a document tells it.
        number
            As a document tells it.
        """
        return self._file(
            Request(
                "GET",
                f"/api/v1/motors/{segment(motor)}/inspections/{segment(inspection_id)}/pictures/{segment(number)}",
            )
        )

    async def withdraw_inspection(
        self, motor: str, inspection_id: str, document: models.InspectionWithdrawal
    ) -> models.Inspection:
        """Let an inspection that was wrong count no more.

        Parameters
        ----------
        motor
            Name of the motor.
        inspection_id
            As a document tells it.
        document
            What is sent.
        """
        answer: models.Inspection = await self._document(
            Request(
                "POST",
                f"/api/v1/motors/{segment(motor)}/inspections/{segment(inspection_id)}/withdrawal",
                json=document,
            )
        )
        return answer

    async def get_inspection_figures(self) -> models.InspectionCounts:
        """Return how often inspections found what was said, by kind of finding, site and year."""
        answer: models.InspectionCounts = await self._document(Request("GET", "/api/v1/inspections/figures"))
        return answer

    async def get_rotor(self, motor: str) -> models.RotorCondition:
        """Return the condition of a motor's rotor, from all its recordings.

        Parameters
        ----------
        motor
            Name of the motor.
        """
        answer: models.RotorCondition = await self._document(
            Request("GET", f"/api/v1/motors/{segment(motor)}/rotor")
        )
        return answer

    def list_rotor_trend(
        self, motor: str, *, from_: Time | None = None, to: Time | None = None, limit: int | None = None
    ) -> AsyncIterator[models.RotorTrendPoint]:
        """Return what each recording of a motor shows of its rotor, oldest first.

        Parameters
        ----------
        motor
            Name of the motor.
        from_
            First time.
        to
            First time not to be included.
        limit
            Most items that are asked for at once; the list goes on all the same. Without: 100.
        """
        return self._items(
            Request(
                "GET",
                f"/api/v1/motors/{segment(motor)}/rotor/trend",
                query={"from": from_, "to": to, "limit": limit},
            )
        )

    def list_swing_trend(
        self, motor: str, *, from_: Time | None = None, to: Time | None = None, limit: int | None = None
    ) -> AsyncIterator[models.SwingTrendPoint]:
        """Return what each recording of a motor shows of its air gap and of a load that swings, oldest first.

        Parameters
        ----------
        motor
            Name of the motor.
        from_
            First time.
        to
            First time not to be included.
        limit
            Most items that are asked for at once; the list goes on all the same. Without: 100.
        """
        return self._items(
            Request(
                "GET",
                f"/api/v1/motors/{segment(motor)}/swings/trend",
                query={"from": from_, "to": to, "limit": limit},
            )
        )

    def list_supply_trend(
        self, motor: str, *, from_: Time | None = None, to: Time | None = None, limit: int | None = None
    ) -> AsyncIterator[models.SupplyTrendPoint]:
        """Return what each recording of a motor shows of its supply, oldest first.

        Parameters
        ----------
        motor
            Name of the motor.
        from_
            First time.
        to
            First time not to be included.
        limit
            Most items that are asked for at once; the list goes on all the same. Without: 100.
        """
        return self._items(
            Request(
                "GET",
                f"/api/v1/motors/{segment(motor)}/supply/trend",
                query={"from": from_, "to": to, "limit": limit},
            )
        )

    async def get_tracked_parameters(self, motor: str) -> models.TrackedMotor:
        """Return resistances and inductances of a motor as its recordings tell them, and what has drifted.

        Parameters
        ----------
        motor
            Name of the motor.
        """
        answer: models.TrackedMotor = await self._document(
            Request("GET", f"/api/v1/motors/{segment(motor)}/parameters")
        )
        return answer

    def list_tracked_trend(
        self, motor: str, *, from_: Time | None = None, to: Time | None = None, limit: int | None = None
    ) -> AsyncIterator[models.TrackedTrendPoint]:
        """Return the changes of a motor's parameters after each recording, oldest first.

        Parameters
        ----------
        motor
            Name of the motor.
        from_
            First time.
        to
            First time not to be included.
        limit
            Most items that are asked for at once; the list goes on all the same. Without: 100.
        """
        return self._items(
            Request(
                "GET",
                f"/api/v1/motors/{segment(motor)}/parameters/trend",
                query={"from": from_, "to": to, "limit": limit},
            )
        )

    async def get_classification(self, motor: str) -> models.MotorClassification:
        """Return which causes are likely for all that is known of a motor, and what is not told apart.

        Parameters
        ----------
        motor
            Name of the motor.
        """
        answer: models.MotorClassification = await self._document(
            Request("GET", f"/api/v1/motors/{segment(motor)}/classification")
        )
        return answer

    async def get_load_profile(self, motor: str, *, days: int | None = None) -> models.LoadProfile:
        """Return how a motor was loaded: hours by torque, energy, starts, hours beyond limits, and its heat.

        Parameters
        ----------
        motor
            Name of the motor.
        days
            Of so many days; up to 2 by minutes. Without: 30.
        """
        answer: models.LoadProfile = await self._document(
            Request("GET", f"/api/v1/motors/{segment(motor)}/load-profile", query={"days": days})
        )
        return answer

    async def get_losses(self, motor: str) -> models.Losses:
        """Return what a motor loses: efficiency by load, and what faults and supply cost a year.

        Parameters
        ----------
        motor
            Name of the motor.
        """
        answer: models.Losses = await self._document(
            Request("GET", f"/api/v1/motors/{segment(motor)}/losses")
        )
        return answer

    def list_integrations(self) -> AsyncIterator[models.Integration]:
        """Return the gateways to other systems that the settings of this service name."""
        return self._items(Request("GET", "/api/v1/integrations"))

    async def get_baseline(self, motor: str) -> models.Baseline:
        """Return the recordings of a motor's baseline, oldest first; none where it has no baseline.

        Parameters
        ----------
        motor
            Name of the motor.
        """
        answer: models.Baseline = await self._document(
            Request("GET", f"/api/v1/motors/{segment(motor)}/baseline")
        )
        return answer

    async def set_baseline(self, motor: str, document: models.BaselineRequest) -> models.Baseline:
        """Replace a motor's baseline by recordings known to be healthy, for diagnoses from now on.

        Recordings in doubt need a reason; it is kept with who asks, in a note of the motor too.

        Parameters
        ----------
        motor
            Name of the motor.
        document
            What is sent.
        """
        answer: models.Baseline = await self._document(
            Request("PUT", f"/api/v1/motors/{segment(motor)}/baseline", json=document)
        )
        return answer

    async def drop_baseline(
        self, motor: str, *, reason: str | None = None, on_behalf_of: str | None = None
    ) -> None:
        """Delete a motor's baseline; its recordings stay, and a note of the motor keeps who did so and why.

        Parameters
        ----------
        motor
            Name of the motor.
        reason
            Why; it is kept.
        on_behalf_of
            Whom who asks does it for; it is kept beside their account.
        """
        await self._done(
            Request(
                "DELETE",
                f"/api/v1/motors/{segment(motor)}/baseline",
                query={"reason": reason, "on_behalf_of": on_behalf_of},
            )
        )

    def list_starts(self, motor: str, *, limit: int | None = None) -> AsyncIterator[models.StartSummary]:
        """Return the starts of a motor, latest first, each beside the reference.

        Parameters
        ----------
        motor
            Name of the motor.
        limit
            Most items that are asked for at once; the list goes on all the same. Without: 100.
        """
        return self._items(Request("GET", f"/api/v1/motors/{segment(motor)}/starts", query={"limit": limit}))

    async def get_start(self, motor: str, recording_id: str) -> models.StartDetails:
        """Return one start with its curves, and what the motor's model tells of it.

        Parameters
        ----------
        motor
            Name of the motor.
        recording_id
            As a document tells it.
        """
        answer: models.StartDetails = await self._document(
            Request("GET", f"/api/v1/motors/{segment(motor)}/starts/{segment(recording_id)}")
        )
        return answer

    def list_relay_events(
        self, motor: str, *, limit: int | None = None
    ) -> AsyncIterator[models.RelayEventEntry]:
        """Return starts, stops and trips that the relay's sequences of events told, latest first.

        Parameters
        ----------
        motor
            Name of the motor.
        limit
            Most items that are asked for at once; the list goes on all the same. Without: 100.
        """
        return self._items(
            Request("GET", f"/api/v1/motors/{segment(motor)}/relay-events", query={"limit": limit})
        )

    async def import_report(
        self,
        motor: str,
        text: bytes,
        *,
        date_order: models.DateOrder | None = None,
        power_unit: models.PowerUnit | None = None,
    ) -> models.ReportImport:
        """Keep what a text report of a motor's relay tells: starts, load, statistics, events.

        Parameters
        ----------
        motor
            Name of the motor.
        text
            A report (MSR, LDP, MOT, SER), as the relay sends it or as a terminal showed it.
        date_order
            Order of its dates: the relay's setting DATE_F. Without: MDY.
        power_unit
            Unit of P and Q in a load profile; without it they are left out.
        """
        answer: models.ReportImport = await self._document(
            Request(
                "POST",
                f"/api/v1/motors/{segment(motor)}/reports",
                query={"date_order": date_order, "power_unit": power_unit},
                content=text,
                headers={"Content-Type": "text/plain"},
            )
        )
        return answer

    def list_measurements(
        self,
        motor: str,
        *,
        step: models.AveragingStep | None = None,
        from_: Time | None = None,
        to: Time | None = None,
        limit: int | None = None,
    ) -> AsyncIterator[models.Measurement]:
        """Return what a motor's relay measures, oldest first: currents, voltages, power and frequency.

        Parameters
        ----------
        motor
            Name of the motor.
        step
            0: as sampled; 60, 900: means of so many seconds, kept for longer. Without: 0.
        from_
            First time.
        to
            First time not to be included.
        limit
            Most items that are asked for at once; the list goes on all the same. Without: 100.
        """
        return self._items(
            Request(
                "GET",
                f"/api/v1/motors/{segment(motor)}/measurements",
                query={"step": step, "from": from_, "to": to, "limit": limit},
            )
        )

    def list_measurements_file(
        self,
        motor: str,
        *,
        step: models.AveragingStep | None = None,
        from_: Time | None = None,
        to: Time | None = None,
        format: Literal["csv", "xlsx", "parquet"],
    ) -> AbstractAsyncContextManager[AsyncDownload]:
        """Return what a motor's relay measures, oldest first: currents, voltages, power and frequency.

        The answer is a file, which is read inside a `with` statement.

        Parameters
        ----------
        motor
            Name of the motor.
        step
            0: as sampled; 60, 900: means of so many seconds, kept for longer. Without: 0.
        from_
            First time.
        to
            First time not to be included.
        format
            What kind of file it is to be.
        """
        return self._file(
            Request(
                "GET",
                f"/api/v1/motors/{segment(motor)}/measurements",
                query={"step": step, "from": from_, "to": to, "format": format},
            )
        )

    def list_ieds(self, *, limit: int | None = None) -> AsyncIterator[models.Ied]:
        """Return the relays and the state of their links, by name.

        Parameters
        ----------
        limit
            Most items that are asked for at once; the list goes on all the same. Without: 100.
        """
        return self._items(Request("GET", "/api/v1/ieds", query={"limit": limit}))

    async def get_ied(self, ied: str) -> models.IedDetails:
        """Return one relay, with figures and history of its link and its standing alarms.

        Parameters
        ----------
        ied
            Name of the ied.
        """
        answer: models.IedDetails = await self._document(Request("GET", f"/api/v1/ieds/{segment(ied)}"))
        return answer

    async def release_ied(self, ied: str) -> None:
        """Visit a relay again that was set aside, with a clean sheet; harmless where it was not.

        Parameters
        ----------
        ied
            Name of the ied.
        """
        await self._done(Request("DELETE", f"/api/v1/ieds/{segment(ied)}/quarantine"))

    def list_link_changes(self, ied: str, *, limit: int | None = None) -> AsyncIterator[models.LinkChange]:
        """Return the changes of a relay's link with their reasons, latest first; the latest thousand are kept.

        Parameters
        ----------
        ied
            Name of the ied.
        limit
            Most items that are asked for at once; the list goes on all the same. Without: 100.
        """
        return self._items(
            Request("GET", f"/api/v1/ieds/{segment(ied)}/link-changes", query={"limit": limit})
        )

    def list_gateways(self) -> AsyncIterator[models.Gateway]:
        """Return the processes that visit the relays, on all hosts, by id; always one page."""
        return self._items(Request("GET", "/api/v1/gateways"))

    def list_alarms(
        self,
        *,
        ied: str | None = None,
        motor: str | None = None,
        standing: bool | None = None,
        part_of: str | None = None,
        limit: int | None = None,
    ) -> AsyncIterator[models.Alarm]:
        """Return the alarms, over or not, latest first.

        Parameters
        ----------
        ied
            Only alarms of this relay and its motors.
        motor
            Only alarms of this motor.
        standing
            true: those whose cause stands; false: those whose is gone; without: both.
        part_of
            Only those that this alarm tells in one line.
        limit
            Most items that are asked for at once; the list goes on all the same. Without: 100.
        """
        return self._items(
            Request(
                "GET",
                "/api/v1/alarms",
                query={"ied": ied, "motor": motor, "standing": standing, "part_of": part_of, "limit": limit},
            )
        )

    def list_alarms_file(
        self,
        *,
        ied: str | None = None,
        motor: str | None = None,
        standing: bool | None = None,
        part_of: str | None = None,
        format: Literal["csv", "xlsx", "parquet"],
    ) -> AbstractAsyncContextManager[AsyncDownload]:
        """Return the alarms, over or not, latest first.

        The answer is a file, which is read inside a `with` statement.

        Parameters
        ----------
        ied
            Only alarms of this relay and its motors.
        motor
            Only alarms of this motor.
        standing
            true: those whose cause stands; false: those whose is gone; without: both.
        part_of
            Only those that this alarm tells in one line.
        format
            What kind of file it is to be.
        """
        return self._file(
            Request(
                "GET",
                "/api/v1/alarms",
                query={
                    "ied": ied,
                    "motor": motor,
                    "standing": standing,
                    "part_of": part_of,
                    "format": format,
                },
            )
        )

    def list_open_alarms(
        self,
        *,
        site: str | None = None,
        ied: str | None = None,
        motor: str | None = None,
        state: models.AlarmState | None = None,
        limit: int | None = None,
    ) -> AsyncIterator[models.Alarm]:
        """Return the alarms that are not over, what to act on first at the top.

        Those that nobody has taken notice of come first, then those acknowledged, those whose cause is gone, and
        those set aside; in each, the highest priority first, and of those the latest.

        Parameters
        ----------
        site
            Only alarms of this site.
        ied
            Only alarms of this relay and its motors.
        motor
            Only alarms of this motor.
        state
            Only alarms in this state.
        limit
            Most items that are asked for at once; the list goes on all the same. Without: 100.
        """
        return self._items(
            Request(
                "GET",
                "/api/v1/alarms/open",
                query={"site": site, "ied": ied, "motor": motor, "state": state, "limit": limit},
            )
        )

    def list_open_alarms_file(
        self,
        *,
        site: str | None = None,
        ied: str | None = None,
        motor: str | None = None,
        state: models.AlarmState | None = None,
        format: Literal["csv", "xlsx", "parquet"],
    ) -> AbstractAsyncContextManager[AsyncDownload]:
        """Return the alarms that are not over, what to act on first at the top.

        Those that nobody has taken notice of come first, then those acknowledged, those whose cause is gone, and
        those set aside; in each, the highest priority first, and of those the latest.

        The answer is a file, which is read inside a `with` statement.

        Parameters
        ----------
        site
            Only alarms of this site.
        ied
            Only alarms of this relay and its motors.
        motor
            Only alarms of this motor.
        state
            Only alarms in this state.
        format
            What kind of file it is to be.
        """
        return self._file(
            Request(
                "GET",
                "/api/v1/alarms/open",
                query={"site": site, "ied": ied, "motor": motor, "state": state, "format": format},
            )
        )

    async def get_alarm_figures(self, *, days: int | None = None) -> models.AlarmFigures:
        """Return how many alarms a day there were, the most frequent, chattering and long-standing ones.

        Parameters
        ----------
        days
            So many days of UTC, with today. Without: 30.
        """
        answer: models.AlarmFigures = await self._document(
            Request("GET", "/api/v1/alarms/figures", query={"days": days})
        )
        return answer

    async def get_alarm(self, alarm_id: str) -> models.Alarm:
        """Return one alarm.

        Parameters
        ----------
        alarm_id
            As a document tells it.
        """
        answer: models.Alarm = await self._document(Request("GET", f"/api/v1/alarms/{segment(alarm_id)}"))
        return answer

    def list_alarm_changes(
        self, alarm_id: str, *, limit: int | None = None
    ) -> AsyncIterator[models.AlarmChange]:
        """Return what happened to an alarm, and by whom, latest first; the latest thousand are kept.

        Parameters
        ----------
        alarm_id
            As a document tells it.
        limit
            Most items that are asked for at once; the list goes on all the same. Without: 100.
        """
        return self._items(
            Request("GET", f"/api/v1/alarms/{segment(alarm_id)}/changes", query={"limit": limit})
        )

    async def acknowledge_alarms(self, document: models.AcknowledgementRequest) -> models.Acknowledgements:
        """Take notice of several alarms, of all for which that is possible; 409 where it is for none.

        Parameters
        ----------
        document
            What is sent.
        """
        answer: models.Acknowledgements = await self._document(
            Request("POST", "/api/v1/alarms/acknowledgements", json=document)
        )
        return answer

    async def undo_acknowledgements(self, document: models.UndoRequest) -> models.UndoneAcknowledgements:
        """Have alarms call again that the same account has acknowledged in the last ten minutes.

        One whose cause went meanwhile is over, and stays so. 409 where it is possible for none.

        Parameters
        ----------
        document
            What is sent.
        """
        answer: models.UndoneAcknowledgements = await self._document(
            Request("POST", "/api/v1/alarms/acknowledgements/undo", json=document)
        )
        return answer

    async def acknowledge_alarm(self, alarm_id: str, document: models.Remark | None = None) -> models.Alarm:
        """Take notice of an alarm. One whose cause is gone is over then.

        Parameters
        ----------
        alarm_id
            As a document tells it.
        document
            What is sent.
        """
        answer: models.Alarm = await self._document(
            Request("POST", f"/api/v1/alarms/{segment(alarm_id)}/acknowledgements", json=document)
        )
        return answer

    async def shelve_alarm(self, alarm_id: str, document: models.ShelvingRequest) -> models.Alarm:
        """Set an alarm aside until a time, until its value has grown by so much, or what comes first.

        Of one that is shelved, this is the new end.

        Parameters
        ----------
        alarm_id
            As a document tells it.
        document
            What is sent.
        """
        answer: models.Alarm = await self._document(
            Request("PUT", f"/api/v1/alarms/{segment(alarm_id)}/shelving", json=document)
        )
        return answer

    async def unshelve_alarm(self, alarm_id: str, *, comment: str | None = None) -> models.Alarm:
        """End the shelving of an alarm: it calls for somebody again if its cause stands, and is over if not.

        Parameters
        ----------
        alarm_id
            As a document tells it.
        comment
            Why; it is kept.
        """
        answer: models.Alarm = await self._document(
            Request("DELETE", f"/api/v1/alarms/{segment(alarm_id)}/shelving", query={"comment": comment})
        )
        return answer

    async def take_alarm_out_of_service(
        self, alarm_id: str, document: models.Remark | None = None
    ) -> models.Alarm:
        """Set an alarm aside until somebody puts it back, whatever its cause does meanwhile.

        Parameters
        ----------
        alarm_id
            As a document tells it.
        document
            What is sent.
        """
        answer: models.Alarm = await self._document(
            Request("PUT", f"/api/v1/alarms/{segment(alarm_id)}/out-of-service", json=document)
        )
        return answer

    async def put_alarm_back_in_service(self, alarm_id: str, *, comment: str | None = None) -> models.Alarm:
        """Put an alarm back in service: it calls for somebody if its cause stands, and is over if not.

        Parameters
        ----------
        alarm_id
            As a document tells it.
        comment
            Why; it is kept.
        """
        answer: models.Alarm = await self._document(
            Request(
                "DELETE", f"/api/v1/alarms/{segment(alarm_id)}/out-of-service", query={"comment": comment}
            )
        )
        return answer

    async def request_event_report(
        self,
        motor: str,
        document: models.RecordingWanted | None = None,
        *,
        idempotency_key: str | None = None,
    ) -> models.EventReport:
        """Request a recording from the motor's relay. Follow the request until it is diagnosed or failed.

        With `seconds` the relay makes a series of recordings that overlap, which are joined to one.

        Parameters
        ----------
        motor
            Name of the motor.
        document
            What is sent.
        idempotency_key
            The same key again gives the first recording request instead of another one.
        """
        answer: models.EventReport = await self._document(
            Request(
                "POST",
                f"/api/v1/motors/{segment(motor)}/event-reports",
                json=document,
                headers={"idempotency-key": idempotency_key},
            )
        )
        return answer

    def list_event_reports(
        self, *, motor: str | None = None, limit: int | None = None
    ) -> AsyncIterator[models.EventReport]:
        """Return the recording requests of one motor or of all motors, latest first.

        Parameters
        ----------
        motor
            `motor` of the request.
        limit
            Most items that are asked for at once; the list goes on all the same. Without: 100.
        """
        return self._items(Request("GET", "/api/v1/event-reports", query={"motor": motor, "limit": limit}))

    async def get_event_report(self, report_id: str) -> models.EventReport:
        """Return one recording request.

        Parameters
        ----------
        report_id
            As a document tells it.
        """
        answer: models.EventReport = await self._document(
            Request("GET", f"/api/v1/event-reports/{segment(report_id)}")
        )
        return answer

    def list_recordings(
        self,
        *,
        motor: str | None = None,
        state: models.RecordingState | None = None,
        operation: models.Operation | None = None,
        limit: int | None = None,
    ) -> AsyncIterator[models.ListedRecording]:
        """Return recordings, of one motor or of all, in one state or in any, of any operation, latest first.

        Parameters
        ----------
        motor
            `motor` of the request.
        state
            `state` of the request.
        operation
            What the motor does in them.
        limit
            Most items that are asked for at once; the list goes on all the same. Without: 100.
        """
        return self._items(
            Request(
                "GET",
                "/api/v1/recordings",
                query={"motor": motor, "state": state, "operation": operation, "limit": limit},
            )
        )

    def list_recordings_file(
        self,
        *,
        motor: str | None = None,
        state: models.RecordingState | None = None,
        operation: models.Operation | None = None,
        format: Literal["csv", "xlsx", "parquet"],
    ) -> AbstractAsyncContextManager[AsyncDownload]:
        """Return recordings, of one motor or of all, in one state or in any, of any operation, latest first.

        The answer is a file, which is read inside a `with` statement.

        Parameters
        ----------
        motor
            `motor` of the request.
        state
            `state` of the request.
        operation
            What the motor does in them.
        format
            What kind of file it is to be.
        """
        return self._file(
            Request(
                "GET",
                "/api/v1/recordings",
                query={"motor": motor, "state": state, "operation": operation, "format": format},
            )
        )

    async def upload_recording(
        self, motor: str, files: Mapping[str, bytes]
    ) -> tuple[models.RecordingDetails, bool]:
        """Store the files of one recording and queue its diagnosis; one the motor has stays as it is.

        The second value tells whether it is new.

        Parameters
        ----------
        motor
            Name of the motor recorded.
        files
            COMTRADE: .CFG and .DAT, or .CFF; or a .CEV; or a table of samples (.CSV, .PARQUET, .MAT, .H5,
            .TDMS, .NPY, .NPZ). By their names.
        """
        answer: tuple[models.RecordingDetails, bool] = await self._new_document(
            Request("POST", "/api/v1/recordings", form={"motor": motor}, files=files)
        )
        return answer

    async def get_recording(self, recording_id: str) -> models.RecordingDetails:
        """Return one recording with its files and its latest diagnosis.

        Parameters
        ----------
        recording_id
            As a document tells it.
        """
        answer: models.RecordingDetails = await self._document(
            Request("GET", f"/api/v1/recordings/{segment(recording_id)}")
        )
        return answer

    async def delete_recording(self, recording_id: str, *, reason: str) -> None:
        """Delete a recording with its files and diagnoses; it is not pulled from its relay again.

        The same account can undo it for ten minutes.

        Parameters
        ----------
        recording_id
            As a document tells it.
        reason
            Why, in words; it is kept with the time.
        """
        await self._done(
            Request("DELETE", f"/api/v1/recordings/{segment(recording_id)}", query={"reason": reason})
        )

    async def get_waveform(self, recording_id: str, *, points: int | None = None) -> models.Waveform:
        """Return the samples of a recording as the smallest and largest value of up to `points` intervals.

        Records of many channels have fewer intervals (setting max_waveform_values).

        Parameters
        ----------
        recording_id
            As a document tells it.
        points
            Most intervals a channel. Without: 2000.
        """
        answer: models.Waveform = await self._document(
            Request("GET", f"/api/v1/recordings/{segment(recording_id)}/waveform", query={"points": points})
        )
        return answer

    def download_recording(self, recording_id: str) -> AbstractAsyncContextManager[AsyncDownload]:
        """Return the files of a recording as they came from the relay, in a ZIP archive.

        The archive is named by the motor and the time of the recording.

        The answer is a file, which is read inside a `with` statement.

        Parameters
        ----------
        recording_id
            As a document tells it.
        """
        return self._file(Request("GET", f"/api/v1/recordings/{segment(recording_id)}/file"))

    def get_samples(
        self,
        recording_id: str,
        *,
        from_s: float | None = None,
        to_s: float | None = None,
        points: int | None = None,
    ) -> AbstractAsyncContextManager[AsyncDownload]:
        """Return a part of a recording as single-precision numbers: its samples, or extremes where they are more.

        Four bytes have the length of the head (unsigned, little-endian). The head is JSON; then follow the
        columns that it names, each of `count` little-endian single-precision numbers. Times count from `first_s`.

        The answer is a file, which is read inside a `with` statement.

        Parameters
        ----------
        recording_id
            As a document tells it.
        from_s
            Seconds after the first sample.
        to_s
            Seconds after the first sample.
        points
            Most values a column. Without: 4000.
        """
        return self._file(
            Request(
                "GET",
                f"/api/v1/recordings/{segment(recording_id)}/samples",
                query={"from_s": from_s, "to_s": to_s, "points": points},
            )
        )

    def get_model(
        self,
        recording_id: str,
        *,
        from_s: float | None = None,
        to_s: float | None = None,
        points: int | None = None,
    ) -> AbstractAsyncContextManager[AsyncDownload]:
        """Return the currents that the latest diagnosis's fit draws, and what they leave of the measured ones.

        As `samples`: columns of groups `measured`, `modelled` and `residual`, over the part of the recording that
        was compared. `residual_rms_A` of the head is what is left now; the diagnosis has that of its time.

        The answer is a file, which is read inside a `with` statement.

        Parameters
        ----------
        recording_id
            As a document tells it.
        from_s
            Seconds after the first sample.
        to_s
            Seconds after the first sample.
        points
            Most values a column. Without: 4000.
        """
        return self._file(
            Request(
                "GET",
                f"/api/v1/recordings/{segment(recording_id)}/model",
                query={"from_s": from_s, "to_s": to_s, "points": points},
            )
        )

    def download_csv(self, recording_id: str) -> AbstractAsyncContextManager[AsyncDownload]:
        """Return all samples and states of a recording as CSV, one line an instant.

        `time_s` counts from the first sample. Values are primary ones, with seven digits; what is missing is
        empty. Before a name that a spreadsheet would take for a formula stands an apostrophe.

        The answer is a file, which is read inside a `with` statement.

        Parameters
        ----------
        recording_id
            As a document tells it.
        """
        return self._file(Request("GET", f"/api/v1/recordings/{segment(recording_id)}/csv"))

    async def get_phasors(self, recording_id: str, *, at_s: float | None = None) -> models.Phasors:
        """Return phasors and symmetrical components of the cycle around a time, or of the nearest whole one.

        Parameters
        ----------
        recording_id
            As a document tells it.
        at_s
            Seconds after the first sample. Without: 0.0.
        """
        answer: models.Phasors = await self._document(
            Request("GET", f"/api/v1/recordings/{segment(recording_id)}/phasors", query={"at_s": at_s})
        )
        return answer

    async def get_spectrum(self, recording_id: str, *, points: int | None = None) -> models.Spectrum:
        """Return the spectrum of the line currents, with the lines that matter for the motor.

        Parameters
        ----------
        recording_id
            As a document tells it.
        points
            Most values a column. Without: 2000.
        """
        answer: models.Spectrum = await self._document(
            Request("GET", f"/api/v1/recordings/{segment(recording_id)}/spectrum", query={"points": points})
        )
        return answer

    async def get_states(self, recording_id: str) -> models.States:
        """Return the states recorded beside the samples: contacts, relay word bits.

        Parameters
        ----------
        recording_id
            As a document tells it.
        """
        answer: models.States = await self._document(
            Request("GET", f"/api/v1/recordings/{segment(recording_id)}/states")
        )
        return answer

    async def request_diagnosis(
        self, recording_id: str, document: models.DiagnosisRequest | None = None
    ) -> models.DiagnosisRun:
        """Queue another diagnosis of a stored recording; when done, it takes the place of the earlier one.

        Parameters
        ----------
        recording_id
            As a document tells it.
        document
            What is sent.
        """
        answer: models.DiagnosisRun = await self._document(
            Request("POST", f"/api/v1/recordings/{segment(recording_id)}/diagnoses", json=document)
        )
        return answer

    def list_diagnoses(
        self, recording_id: str, *, limit: int | None = None
    ) -> AsyncIterator[models.DiagnosisRun]:
        """Return the diagnoses of a recording, latest first.

        Parameters
        ----------
        recording_id
            As a document tells it.
        limit
            Most items that are asked for at once; the list goes on all the same. Without: 100.
        """
        return self._items(
            Request("GET", f"/api/v1/recordings/{segment(recording_id)}/diagnoses", query={"limit": limit})
        )

    async def get_diagnosis(self, recording_id: str, diagnosis_id: str) -> models.DiagnosisRun:
        """Return one diagnosis of a recording.

        Parameters
        ----------
        recording_id
            As a document tells it.
        diagnosis_id
            As a document tells it.
        """
        answer: models.DiagnosisRun = await self._document(
            Request("GET", f"/api/v1/recordings/{segment(recording_id)}/diagnoses/{segment(diagnosis_id)}")
        )
        return answer

    def list_job_runners(self) -> AsyncIterator[models.JobRunner]:
        """Return the processes that have diagnoses made, on all hosts, by id; always one page."""
        return self._items(Request("GET", "/api/v1/job-runners"))

    def list_deletions(
        self, *, motor: str | None = None, limit: int | None = None
    ) -> AsyncIterator[models.Deletion]:
        """Return the recordings that were deleted, of one motor or of all, latest first.

        Parameters
        ----------
        motor
            `motor` of the request.
        limit
            Most items that are asked for at once; the list goes on all the same. Without: 100.
        """
        return self._items(Request("GET", "/api/v1/deletions", query={"motor": motor, "limit": limit}))

    async def get_deletion(self, recording_id: str) -> models.Deletion:
        """Return what is remembered of one recording that was deleted.

        Parameters
        ----------
        recording_id
            As a document tells it.
        """
        answer: models.Deletion = await self._document(
            Request("GET", f"/api/v1/deletions/{segment(recording_id)}")
        )
        return answer

    async def undo_deletion(self, recording_id: str) -> models.Recording:
        """Have a recording back that the same account has deleted in the last ten minutes.

        It has its id, files and times again, and waits for its diagnosis.

        Parameters
        ----------
        recording_id
            As a document tells it.
        """
        answer: models.Recording = await self._document(
            Request("POST", f"/api/v1/deletions/{segment(recording_id)}/undo")
        )
        return answer

    def export_trend(
        self,
        *,
        motor: Sequence[str] | None = None,
        from_: Time | None = None,
        to: Time | None = None,
        format: models.Format | None = None,
    ) -> AbstractAsyncContextManager[AsyncDownload]:
        """Return what each recording says, of one motor after another, oldest first.

        The answer is a file, which is read inside a `with` statement.

        Parameters
        ----------
        motor
            Only these, in this order; without: all.
        from_
            First time.
        to
            First time not to be included.
        format
            Without: by the header Accept, else CSV.
        """
        return self._file(
            Request(
                "GET",
                "/api/v1/exports/trend",
                query={"motor": motor, "from": from_, "to": to, "format": format},
            )
        )

    def export_measurements(
        self,
        *,
        motor: Sequence[str] | None = None,
        step: models.AveragingStep | None = None,
        from_: Time | None = None,
        to: Time | None = None,
        format: models.Format | None = None,
    ) -> AbstractAsyncContextManager[AsyncDownload]:
        """Return what the relays measure all the time, of one motor after another, oldest first.

        The answer is a file, which is read inside a `with` statement.

        Parameters
        ----------
        motor
            Only these, in this order; without: all.
        step
            0: as sampled; 60, 900: means of so many seconds, kept for longer. Without: 0.
        from_
            First time.
        to
            First time not to be included.
        format
            Without: by the header Accept, else CSV.
        """
        return self._file(
            Request(
                "GET",
                "/api/v1/exports/measurements",
                query={"motor": motor, "step": step, "from": from_, "to": to, "format": format},
            )
        )

    def export_recordings(
        self, *, motor: Sequence[str] | None = None, format: models.Format | None = None
    ) -> AbstractAsyncContextManager[AsyncDownload]:
        """Return the recordings with their verdicts, of one motor after another or of all, latest first.

        The answer is a file, which is read inside a `with` statement.

        Parameters
        ----------
        motor
            Only these, in this order; without: all.
        format
            Without: by the header Accept, else CSV.
        """
        return self._file(
            Request("GET", "/api/v1/exports/recordings", query={"motor": motor, "format": format})
        )

    def export_starts(
        self, *, motor: Sequence[str] | None = None, format: models.Format | None = None
    ) -> AbstractAsyncContextManager[AsyncDownload]:
        """Return the starts with their figures, of one motor after another or of all, latest first.

        The answer is a file, which is read inside a `with` statement.

        Parameters
        ----------
        motor
            Only these, in this order; without: all.
        format
            Without: by the header Accept, else CSV.
        """
        return self._file(Request("GET", "/api/v1/exports/starts", query={"motor": motor, "format": format}))

    def export_alarms(
        self, *, motor: Sequence[str] | None = None, format: models.Format | None = None
    ) -> AbstractAsyncContextManager[AsyncDownload]:
        """Return the alarms, of one motor after another or of all, latest first.

        The answer is a file, which is read inside a `with` statement.

        Parameters
        ----------
        motor
            Only these, in this order; without: all.
        format
            Without: by the header Accept, else CSV.
        """
        return self._file(Request("GET", "/api/v1/exports/alarms", query={"motor": motor, "format": format}))

    def export_inspections(
        self, *, motor: Sequence[str] | None = None, format: models.Format | None = None
    ) -> AbstractAsyncContextManager[AsyncDownload]:
        """Return what inspections found, of one motor after another or of all, latest first.

        The answer is a file, which is read inside a `with` statement.

        Parameters
        ----------
        motor
            Only these, in this order; without: all.
        format
            Without: by the header Accept, else CSV.
        """
        return self._file(
            Request("GET", "/api/v1/exports/inspections", query={"motor": motor, "format": format})
        )

    def get_fleet_report(
        self,
        *,
        period: Literal["daily", "weekly"] | None = None,
        until: Time | None = None,
        site: Sequence[str] | None = None,
        format: models.ReportFormat | None = None,
    ) -> AbstractAsyncContextManager[AsyncDownload]:
        """Return how all motors were at a time, and what happened in the day or week before.

        The answer is a file, which is read inside a `with` statement.

        Parameters
        ----------
        period
            `period` of the request. Without: daily.
        until
            Nothing later is told; without: now.
        site
            Only these sites; without: all.
        format
            PDF, or an Excel workbook. Without: pdf.
        """
        return self._file(
            Request(
                "GET",
                "/api/v1/reports/fleet",
                query={"period": period, "until": until, "site": site, "format": format},
            )
        )

    def get_motor_report(
        self, motor: str, *, until: Time | None = None, format: models.ReportFormat | None = None
    ) -> AbstractAsyncContextManager[AsyncDownload]:
        """Return all of one motor until a time, with its pictures.

        The answer is a file, which is read inside a `with` statement.

        Parameters
        ----------
        motor
            Name of the motor.
        until
            Nothing later is told; without: now.
        format
            PDF, or an Excel workbook. Without: pdf.
        """
        return self._file(
            Request(
                "GET", f"/api/v1/reports/motors/{segment(motor)}", query={"until": until, "format": format}
            )
        )

    def get_alarms_report(
        self,
        *,
        month: str | None = None,
        site: Sequence[str] | None = None,
        format: models.ReportFormat | None = None,
    ) -> AbstractAsyncContextManager[AsyncDownload]:
        """Return all calls of alarms in a month, and what became of each until the month's end or now.

        The answer is a file, which is read inside a `with` statement.

        Parameters
        ----------
        month
            Such as 2026-11, in the time zone of the settings; without: this one.
        site
            Only these sites; without: all.
        format
            PDF, or an Excel workbook. Without: pdf.
        """
        return self._file(
            Request("GET", "/api/v1/reports/alarms", query={"month": month, "site": site, "format": format})
        )

    def list_notifications(
        self,
        *,
        state: models.NotificationState | None = None,
        channel: str | None = None,
        alarm: str | None = None,
        limit: int | None = None,
    ) -> AsyncIterator[models.Notification]:
        """Return the messages, latest first: what was sent to whom, what waits, and what was given up.

        Parameters
        ----------
        state
            Only those in this state.
        channel
            Only those of this channel of the settings.
        alarm
            Only those that told of this alarm.
        limit
            Most items that are asked for at once; the list goes on all the same. Without: 100.
        """
        return self._items(
            Request(
                "GET",
                "/api/v1/notifications",
                query={"state": state, "channel": channel, "alarm": alarm, "limit": limit},
            )
        )

    async def get_notification(self, notification_id: str) -> models.NotificationDetails:
        """Return one message, with the alarms that it tells of.

        Parameters
        ----------
        notification_id
            As a document tells it.
        """
        answer: models.NotificationDetails = await self._document(
            Request("GET", f"/api/v1/notifications/{segment(notification_id)}")
        )
        return answer

    async def retry_notification(self, notification_id: str) -> models.Notification:
        """Try a message again that was given up; 409 where it was not.

        Parameters
        ----------
        notification_id
            As a document tells it.
        """
        answer: models.Notification = await self._document(
            Request("POST", f"/api/v1/notifications/{segment(notification_id)}/attempts")
        )
        return answer

    def list_channels(self) -> AsyncIterator[models.NotificationChannel]:
        """Return the channels of the settings; always one page."""
        return self._items(Request("GET", "/api/v1/notification-channels"))

    async def send_test(self, notification_channel: str) -> list[models.Notification]:
        """Have a test message sent to each receiver of a channel; it is tried once.

        What becomes of it is seen in `notifications/{notification_id}`.

        Parameters
        ----------
        notification_channel
            Name of the notification channel.
        """
        return [
            one
            async for one in self._items(
                Request("POST", f"/api/v1/notification-channels/{segment(notification_channel)}/tests")
            )
        ]

    def list_audit_entries(
        self,
        *,
        actor: str | None = None,
        action: models.AuditAction | None = None,
        subject: str | None = None,
        from_: Time | None = None,
        to: Time | None = None,
        limit: int | None = None,
    ) -> AsyncIterator[models.AuditEntry]:
        """Return who changed what, latest first.

        Parameters
        ----------
        actor
            `actor` of the request.
        action
            `action` of the request.
        subject
            Name or id of what was changed.
        from_
            First time.
        to
            First time not to be included.
        limit
            Most items that are asked for at once; the list goes on all the same. Without: 100.
        """
        return self._items(
            Request(
                "GET",
                "/api/v1/audit/entries",
                query={
                    "actor": actor,
                    "action": action,
                    "subject": subject,
                    "from": from_,
                    "to": to,
                    "limit": limit,
                },
            )
        )

    async def get_audit_head(self) -> models.AuditState:
        """Return number and hash of the last entry. Keep them elsewhere to verify the trail against."""
        answer: models.AuditState = await self._document(Request("GET", "/api/v1/audit/head"))
        return answer

    def export_audit_trail(
        self, *, first: int | None = None, last: int | None = None
    ) -> AbstractAsyncContextManager[AsyncDownload]:
        """Return all entries, oldest first, one a line of canonical JSON: what was hashed, and the hash.

        What is added while the answer is sent is not in it.

        The answer is a file, which is read inside a `with` statement.

        Parameters
        ----------
        first
            Number of the first entry. Without: 1.
        last
            Number of the last; without: the latest.
        """
        return self._file(Request("GET", "/api/v1/audit/export", query={"first": first, "last": last}))

    async def verify_audit_trail(
        self, *, number: int | None = None, hash: str | None = None
    ) -> models.AuditVerification:
        """Read the whole trail, and return whether every entry is as it was written.

        A trail that was computed anew, or whose end was cut off together with its head, is found only with an
        entry that was kept elsewhere: its number and its hash.

        Parameters
        ----------
        number
            An entry that was kept elsewhere.
        hash
            And its hash.
        """
        answer: models.AuditVerification = await self._document(
            Request("GET", "/api/v1/audit/verification", query={"number": number, "hash": hash})
        )
        return answer

    def list_backups(self, *, limit: int | None = None) -> AsyncIterator[models.Backup]:
        """Return the back-ups of the service's data, latest first.

        Parameters
        ----------
        limit
            Most items that are asked for at once; the list goes on all the same. Without: 100.
        """
        return self._items(Request("GET", "/api/v1/backups", query={"limit": limit}))

    async def get_login_ways(self) -> models.LoginWays:
        """Return how one logs in here."""
        answer: models.LoginWays = await self._document(Request("GET", "/api/v1/login"))
        return answer

    async def log_in(self, document: models.LoginRequest) -> models.Account:
        """Begin a session, with a name and a password; the answer's cookie is its secret.

        Parameters
        ----------
        document
            What is sent.
        """
        answer: models.Account = await self._document(Request("POST", "/api/v1/login", json=document))
        return answer

    async def log_out(self) -> None:
        """End the session that the request has; harmless without one."""
        await self._done(Request("POST", "/api/v1/logout"))

    async def get_account(self) -> models.Account:
        """Return who asks, and what they may do."""
        answer: models.Account = await self._document(Request("GET", "/api/v1/account"))
        return answer

    async def change_password(self, document: models.PasswordChange) -> None:
        """Change the own password; all own sessions end, this one too, and all own tokens.

        Parameters
        ----------
        document
            What is sent.
        """
        await self._done(Request("PUT", "/api/v1/account/password", json=document))

    async def propose_totp(self, document: models.OwnPassword) -> models.TotpProposal:
        """Return a new secret for an authenticator app, which counts once a code of it is sent back.

        Parameters
        ----------
        document
            What is sent.
        """
        answer: models.TotpProposal = await self._document(
            Request("POST", "/api/v1/account/totp", json=document)
        )
        return answer

    async def confirm_totp(self, document: models.FactorCode) -> models.RecoveryCodes:
        """Have the app count whose code this is, and return recovery codes, which are shown this once.

        Parameters
        ----------
        document
            What is sent.
        """
        answer: models.RecoveryCodes = await self._document(
            Request("POST", "/api/v1/account/totp/confirmation", json=document)
        )
        return answer

    async def make_recovery_codes(self, document: models.OwnPassword) -> models.RecoveryCodes:
        """Return other recovery codes, which are shown this once; the old ones count no more.

        Parameters
        ----------
        document
            What is sent.
        """
        answer: models.RecoveryCodes = await self._document(
            Request("POST", "/api/v1/account/recovery-codes", json=document)
        )
        return answer

    async def remove_second_factor(self, document: models.OwnPassword) -> None:
        """Remove the own second factor; 409 where a role needs it.

        Parameters
        ----------
        document
            What is sent.
        """
        await self._done(Request("POST", "/api/v1/account/second-factor/removal", json=document))

    async def reset_second_factor(self, user: str) -> models.OneTimeCode:
        """Remove another user's second factor; return a code with which they log in once to set up another.

        Their sessions and tokens end.

        Parameters
        ----------
        user
            Name of the user.
        """
        answer: models.OneTimeCode = await self._document(
            Request("POST", f"/api/v1/users/{segment(user)}/second-factor/reset")
        )
        return answer

    async def ask_for_passkey(self, *, name: str) -> models.PasskeyOptions:
        """Return what a browser asks a device with to log in; it does not tell whether there is such a user.

        Parameters
        ----------
        name
            `name` of the request.
        """
        answer: models.PasskeyOptions = await self._document(
            Request("GET", "/api/v1/login/passkey", query={"name": name})
        )
        return answer

    async def list_passkeys(self) -> models.Passkeys:
        """Return the own passkeys, the oldest first."""
        answer: models.Passkeys = await self._document(Request("GET", "/api/v1/account/passkeys"))
        return answer

    async def add_passkey(self, document: models.PasskeyAnswer) -> models.NewPasskey:
        """Keep what a device has made; other own sessions end.

        Who had no second factor gets recovery codes, which are shown this once.

        Parameters
        ----------
        document
            What is sent.
        """
        answer: models.NewPasskey = await self._document(
            Request("POST", "/api/v1/account/passkeys", json=document)
        )
        return answer

    async def propose_passkey(self, document: models.OwnPassword) -> models.PasskeyOptions:
        """Return what a browser asks a device for a new passkey with.

        Parameters
        ----------
        document
            What is sent.
        """
        answer: models.PasskeyOptions = await self._document(
            Request("POST", "/api/v1/account/passkeys/options", json=document)
        )
        return answer

    async def remove_passkey(self, passkey_id: str, document: models.OwnPassword) -> None:
        """Remove an own passkey; other own sessions end. 409 for the last factor where a role needs one.

        Parameters
        ----------
        passkey_id
            As a document tells it.
        document
            What is sent.
        """
        await self._done(
            Request("POST", f"/api/v1/account/passkeys/{segment(passkey_id)}/removal", json=document)
        )

    def list_own_tokens(self, *, limit: int | None = None) -> AsyncIterator[models.Token]:
        """Return the own tokens, without their secrets.

        Parameters
        ----------
        limit
            Most items that are asked for at once; the list goes on all the same. Without: 100.
        """
        return self._items(Request("GET", "/api/v1/account/tokens", query={"limit": limit}))

    async def add_own_token(self, document: models.TokenRequest) -> models.NewToken:
        """Make a token that may do no more than who asks, nor for longer. Its secret is shown this once.

        Parameters
        ----------
        document
            What is sent.
        """
        answer: models.NewToken = await self._document(
            Request("POST", "/api/v1/account/tokens", json=document)
        )
        return answer

    async def revoke_own_tokens(self) -> None:
        """End all of the own tokens."""
        await self._done(Request("DELETE", "/api/v1/account/tokens"))

    async def revoke_own_token(self, token_id: str) -> None:
        """End one of the own tokens, and those that were made with it.

        Parameters
        ----------
        token_id
            As a document tells it.
        """
        await self._done(Request("DELETE", f"/api/v1/account/tokens/{segment(token_id)}"))

    def list_tokens(self, *, limit: int | None = None) -> AsyncIterator[models.Token]:
        """Return the tokens of all users, without their secrets.

        Parameters
        ----------
        limit
            Most items that are asked for at once; the list goes on all the same. Without: 100.
        """
        return self._items(Request("GET", "/api/v1/tokens", query={"limit": limit}))

    async def revoke_tokens(self, user: str) -> None:
        """End all tokens of a user; their sessions stay.

        Parameters
        ----------
        user
            Name of the user.
        """
        await self._done(Request("DELETE", f"/api/v1/users/{segment(user)}/tokens"))

    async def revoke_token(self, token_id: str) -> None:
        """End a token of whomever, and those that were made with it.

        Parameters
        ----------
        token_id
            As a document tells it.
        """
        await self._done(Request("DELETE", f"/api/v1/tokens/{segment(token_id)}"))

    def list_users(self, *, limit: int | None = None) -> AsyncIterator[models.User]:
        """Return the users, by name.

        Parameters
        ----------
        limit
            Most items that are asked for at once; the list goes on all the same. Without: 100.
        """
        return self._items(Request("GET", "/api/v1/users", query={"limit": limit}))

    async def add_user(self, document: models.UserRequest) -> models.User:
        """Make a user. Somebody else's choice of a password is changed before anything is done with it.

        Parameters
        ----------
        document
            What is sent.
        """
        answer: models.User = await self._document(Request("POST", "/api/v1/users", json=document))
        return answer

    async def get_user(self, user: str) -> models.User:
        """Return one user.

        Parameters
        ----------
        user
            Name of the user.
        """
        answer: models.User = await self._document(Request("GET", f"/api/v1/users/{segment(user)}"))
        return answer

    async def change_user(self, user: str, document: models.UserChange) -> models.User:
        """Change a user's name, roles or sites, disable or enable them.

        Other roles or sites end their sessions, being disabled their tokens, too.

        Parameters
        ----------
        user
            Name of the user.
        document
            What is sent.
        """
        answer: models.User = await self._document(
            Request("PATCH", f"/api/v1/users/{segment(user)}", json=document)
        )
        return answer

    async def delete_user(self, user: str) -> None:
        """Delete a user with their sessions and tokens; what they did stays in the audit trail.

        Parameters
        ----------
        user
            Name of the user.
        """
        await self._done(Request("DELETE", f"/api/v1/users/{segment(user)}"))

    async def set_password(self, user: str, document: models.NewPassword) -> None:
        """Give another user a password, which they change first; their sessions and tokens end.

        Parameters
        ----------
        user
            Name of the user.
        document
            What is sent.
        """
        await self._done(Request("PUT", f"/api/v1/users/{segment(user)}/password", json=document))

    async def end_sessions(self, user: str) -> None:
        """End all sessions and all tokens of a user.

        Parameters
        ----------
        user
            Name of the user.
        """
        await self._done(Request("DELETE", f"/api/v1/users/{segment(user)}/sessions"))

    async def unlock_user(self, user: str) -> None:
        """Forget the failed logins of a user, so that they may try again at once.

        Parameters
        ----------
        user
            Name of the user.
        """
        await self._done(Request("DELETE", f"/api/v1/users/{segment(user)}/lock"))

    async def get_health_of_service(self) -> models.Status:
        """Answer, which shows that the service runs."""
        answer: models.Status = await self._document(Request("GET", "/healthz"))
        return answer

    async def get_readiness(self) -> models.Status:
        """Tell whether all parts of the service work; otherwise answer 503, and say which does not and why."""
        answer: models.Status = await self._document(Request("GET", "/readyz"))
        return answer

    def get_metrics(self) -> AbstractAsyncContextManager[AsyncDownload]:
        """Return the numbers of links, recording requests, recordings, jobs, alarms and motors by state.

        Also the figures of each link and of each motor's condition. Prometheus text format.

        The answer is a file, which is read inside a `with` statement."""
        return self._file(Request("GET", "/metrics"))
