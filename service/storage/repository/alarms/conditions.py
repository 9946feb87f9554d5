"""The alarms of a motor's condition: one for what it is, one for a limit that it will reach soon."""

from collections.abc import Sequence
from dataclasses import dataclass

from sqlalchemy import exists, func, or_, select
from sqlalchemy.orm import Session

from core.condition.events import ENDING
from core.condition.kinds import State
from core.motor_condition.parts import parts_of
from service.alarms.condition_rules import AT_ONCE, ConditionRules
from service.alarms.confirmation import Decision
from service.alarms.growth import LevelSeen, has_grown, is_another_kind
from service.alarms.kinds import AlarmKind
from service.storage.models import AlarmRow, ConditionEventRow, ConditionRow, MotorRow, ObservationRow
from service.storage.models.alarms import is_open
from service.storage.records import AlarmPlace, AlarmSpec, ConditionEntry
from service.storage.repository.alarms.causes import clear, forget_cleared, raised_at, reopen, supersede
from service.storage.repository.alarms.changes import change, locked
from service.storage.repository.alarms.condition_words import ConditionWords, is_fault_level
from service.storage.repository.alarms.suppression import suppress_by_design
from service.storage.repository.conditions.motor_conditions import settle_alarms_of_parts, stator_entry
from service.storage.repository.sessions import Sessions, found
from service.storage.states import AlarmEvent, AlarmState

OF_STATE = (AlarmKind.CONDITION_WATCH, AlarmKind.CONDITION_FAULT)
OF_CONDITION = (*OF_STATE, AlarmKind.CONDITION_FORECAST)
TO_BE_TOLD = (State.WATCH, State.FAULT)


class ConditionAlarmRows(Sessions):
    def settle_alarms(self, *, now_ns: int, rules: ConditionRules = AT_ONCE) -> None:
        """Make the alarms of all motors say what their conditions say.

        For motors that left the plant or came back, of which nothing else tells their alarms.
        """
        stands = exists().where(AlarmRow.motor == ConditionRow.motor, AlarmRow.cleared_ns.is_(None))
        concerned = (
            select(ConditionRow.motor)
            .where(or_(ConditionRow.state.in_(TO_BE_TOLD), stands))
            .order_by(ConditionRow.motor)
        )
        with self._read() as session:
            motors = session.scalars(concerned).all()
        for name in motors:
            with self._write() as session:
                motor = found(session, MotorRow, name, "motor", lock=True)
                row = found(session, ConditionRow, name, "motor", lock=True)
                settle_alarm(session, motor, stator_entry(row), now_ns=now_ns, rules=rules)
                settle_alarms_of_parts(session, row, parts_of(row.document), now_ns=now_ns)


def settle_alarm(
    session: Session,
    motor: MotorRow,
    condition: ConditionEntry,
    *,
    now_ns: int,
    rules: ConditionRules = AT_ONCE,
) -> None:
    """Make the motor's alarms say what its condition says. Whoever calls it has locked the condition's row.

    From `watch` to `fault` one alarm is superseded by the other; while the state stays, the alarm stays and
    gets the present words. Another kind of asymmetry supersedes it too. A level that has grown reopens an
    alarm that was acknowledged. Alarms of a motor that left the plant are suppressed and cleared.
    """
    _Settling(session, motor, condition, now_ns, rules).settle()


@dataclass(frozen=True, slots=True)
class _Looks:
    """What was said with the latest records since the reference was ended, oldest first."""

    states: Sequence[State]
    recording_id: str | None


class _Settling:
    """One motor's alarms while they are settled."""

    def __init__(
        self,
        session: Session,
        motor: MotorRow,
        condition: ConditionEntry,
        now_ns: int,
        rules: ConditionRules,
    ) -> None:
        self._session = session
        self._motor = motor
        self._condition = condition
        self._words = ConditionWords(condition)
        self._now_ns = now_ns
        self._rules = rules
        self._place = AlarmPlace(motor.site, motor.ied, motor.name)

    def settle(self) -> None:
        open_rows = locked(
            self._session, AlarmRow.motor == self._motor.name, is_open(), AlarmRow.kind.in_(OF_CONDITION)
        )
        rows = [row for row in open_rows if row.kind in OF_STATE]
        forecasts = [row for row in open_rows if row.kind is AlarmKind.CONDITION_FORECAST]
        if not self._motor.in_service:
            for row in open_rows:
                suppress_by_design(self._session, row, now_ns=self._now_ns)
            self._clear(open_rows)
            return
        looks = self._looks()
        kind = self._rules.kind_of(looks.states, _standing_kind(rows)) if looks.states else None
        if kind is None:
            self._clear(open_rows)
            return
        self._tell_state(rows, kind, looks)
        self._tell_forecast(forecasts, looks)

    def _looks(self) -> _Looks:
        """Return the looks that matter; none where no record has been judged since the reference ended."""
        if self._condition.state is State.UNKNOWN:
            return _Looks((), None)
        ended = select(func.max(ConditionEventRow.time_ns)).where(
            ConditionEventRow.motor == self._motor.name,
            ConditionEventRow.kind.in_(ENDING),
            ConditionEventRow.withdrawn_ns.is_(None),
        )
        ended_ns = self._session.scalar(ended)
        query = select(ObservationRow.state, ObservationRow.recording_id).where(
            ObservationRow.motor == self._motor.name,
            ObservationRow.left_out.is_(None),
            ObservationRow.state.is_not(None),
        )
        if ended_ns is not None:
            query = query.where(ObservationRow.time_ns >= ended_ns)
        order = (ObservationRow.time_ns.desc(), ObservationRow.recording_id.desc())
        found = self._session.execute(query.order_by(*order).limit(self._rules.looks)).all()
        if not found:
            # Nobody measured since: what a person has declared healthy is no alarm any more.
            told = self._condition.state in TO_BE_TOLD
            return _Looks((self._condition.state,) if told else (), None)
        states = [state for state, _ in reversed(found) if state is not None]
        return _Looks([*states[:-1], self._condition.state], found[0].recording_id)

    def _clear(self, rows: Sequence[AlarmRow]) -> None:
        standing = [row.id for row in rows if row.cleared_ns is None]
        if standing:
            clear(self._session, self._now_ns, AlarmRow.id.in_(standing))
            forget_cleared(self._session, AlarmRow.motor == self._motor.name)

    def _tell_state(self, rows: Sequence[AlarmRow], kind: AlarmKind, looks: _Looks) -> None:
        """Have the one alarm of this kind stand that tells the present cause, and supersede the others."""
        causes = self._words.causes
        of_kind = [row for row in rows if row.kind is kind]
        standing = next((row for row in of_kind if row.cleared_ns is None), None)
        standing_causes = () if standing is None else standing.causes or ()
        told = frozenset(standing_causes)
        is_new = (
            standing is not None
            and standing.state is not AlarmState.OUT_OF_SERVICE
            and bool(told)
            and is_another_kind(told, frozenset(causes))
        )
        told_now = causes if is_new or not told else tuple(one for one in standing_causes if one in causes)
        told_now = told_now or standing_causes
        level = self._words.level(told_now)
        spec = AlarmSpec(
            kind,
            reason=self._words.reason,
            subject=self._words.subject,
            one_of_kind=not is_new,
            value=None if level is None else level.value,
            advice=self._words.advice,
            recording_id=looks.recording_id,
        )
        row = raised_at(self._session, self._place, spec, now_ns=self._now_ns)
        row.causes = told_now
        if standing is row:
            if is_fault_level(told) != is_fault_level(told_now) and row.seen_value is not None:
                row.seen_value = row.value  # it was in another measure
            self._tell_growth(row, level)
        superseded = [other for other in rows if other is not row and _calls_or_stands(other)]
        before = next((other for other in superseded if other.cleared_ns is None), None)
        if before is not None and before.kind is AlarmKind.CONDITION_FAULT and not is_new:
            self._inherit(row, before)
        for other in superseded:
            supersede(self._session, other, row, now_ns=self._now_ns)
        if superseded:
            forget_cleared(self._session, AlarmRow.motor == self._motor.name)

    def _tell_growth(self, row: AlarmRow, level: LevelSeen | None) -> None:
        """Have an acknowledged alarm call again whose level lies surely above what people knew."""
        told = row.seen_value
        if row.state is not AlarmState.ACKNOWLEDGED or level is None or told is None:
            return
        if has_grown(told, level, self._rules.growth_share):
            reason = f"grown from {told:.2%} to {level.value:.2%}, 95 % interval above {level.low or 0.0:.2%}"
            reopen(self._session, row, reason, now_ns=self._now_ns)

    def _inherit(self, row: AlarmRow, before: AlarmRow) -> None:
        """Have an alarm that is milder than the one before call nobody who knows of that."""
        if row.state is not AlarmState.UNACKNOWLEDGED:
            return
        if before.state is AlarmState.ACKNOWLEDGED:
            event = AlarmEvent.ACKNOWLEDGED
        elif before.state is AlarmState.SHELVED:
            event = AlarmEvent.SHELVED
        else:
            return
        until_ns, above = before.shelved_until_ns, before.shelved_above
        row.seen_value = before.seen_value
        change(
            self._session,
            row,
            event,
            now_ns=self._now_ns,
            by=before.changed_by,
            comment=f"as {before.kind.value}, alarm {before.id}",
        )
        if event is AlarmEvent.SHELVED:
            row.shelved_until_ns, row.shelved_above = until_ns, above

    def _tell_forecast(self, rows: Sequence[AlarmRow], looks: _Looks) -> None:
        """Tell that a limit will likely be reached within the horizon, or take that back."""
        standing = [row for row in rows if row.cleared_ns is None]
        days, limit = self._words.days_to_limit, self._words.limit
        if days is None or limit is None:
            if not self._words.grows:
                self._clear(standing)
            return
        subject = f"limit of {limit:.2%}"
        stands = any(row.subject == subject for row in standing)
        decision = self._rules.forecast(days, stands=stands)
        if decision is Decision.CLEAR or (decision is Decision.KEEP and not stands):
            self._clear(standing)  # it is far, or that limit is reached and the next one is far
        else:
            spec = AlarmSpec(
                AlarmKind.CONDITION_FORECAST,
                reason=self._words.forecast_reason,
                subject=subject,
                recording_id=looks.recording_id,
            )
            row = raised_at(self._session, self._place, spec, now_ns=self._now_ns)
            for other in rows:
                if other is not row and _calls_or_stands(other):
                    supersede(self._session, other, row, now_ns=self._now_ns)


def _standing_kind(rows: Sequence[AlarmRow]) -> AlarmKind | None:
    """Return the worst kind that stands."""
    standing = {row.kind for row in rows if row.cleared_ns is None}
    return next((kind for kind in reversed(OF_STATE) if kind in standing), None)


def _calls_or_stands(row: AlarmRow) -> bool:
    return row.cleared_ns is None or row.state is AlarmState.RETURNED_UNACKNOWLEDGED
