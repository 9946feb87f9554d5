"""Documents of inspections."""

from typing import Annotated

from pydantic import Field, StringConstraints

from core.condition.kinds import Kind
from service.api.document import Document, Listed, Reason, RequestDocument, RequestForSomebody
from service.api.times import Time, TimeParameter
from service.storage.states import InspectionOutcome

Words = Annotated[
    str, StringConstraints(min_length=1, max_length=1000, strip_whitespace=True, pattern=r"^[^\x00]+$")
]


class InspectionRequest(RequestForSomebody):
    """What an inspection found.

    outcome: `confirmed`: what the service said is what it was; `other-cause`: something else was the matter,
    `cause` says what; `nothing-found`. kind: what the service had said, by default what it says now; `none`
    where it said nothing. alarm_id: the alarm that it was about. time: when it was, by default now.
    """

    outcome: InspectionOutcome
    text: Words
    kind: Kind | None = None
    cause: Reason | None = None
    alarm_id: Annotated[str, StringConstraints(max_length=36)] | None = None
    time: TimeParameter | None = None


class InspectionWithdrawal(RequestDocument):
    """Why an inspection was wrong."""

    reason: Reason


class Inspection(Document):
    """What an inspection of a motor found, beside what the service had said. Nothing is judged by it.

    kind, finding: what was said. cause: what it was, where that is something else. pictures: how many, from
    1 on. An inspection that was withdrawn does not count.
    """

    id: str
    motor: str
    time: Time = Field(validation_alias="time_ns")
    kind: Kind
    finding: str
    outcome: InspectionOutcome
    cause: str | None
    text: str
    alarm_id: str | None
    pictures: int
    by: str = Field(validation_alias="account")
    on_behalf_of: str | None
    made_time: Time = Field(validation_alias="made_ns")
    withdrawn_time: Time | None = Field(validation_alias="withdrawn_ns")
    withdrawn_by: str | None = Field(validation_alias="withdrawn_account")
    withdrawn_reason: str | None


class InspectionCount(Document):
    """Inspections of one kind of finding at a site in a year (UTC), as what they found.

    confirmed: hits. other_cause: something else was the matter. nothing_found: false alarms, or rightly
    nothing where the kind is `none`. missed: something was found of which nothing had been said.
    """

    kind: Kind
    site: str
    year: int
    confirmed: int
    other_cause: int
    nothing_found: int
    missed: int


class InspectionCounts(Document):
    """How often inspections found what was said, latest year first."""

    counts: Listed[InspectionCount]
