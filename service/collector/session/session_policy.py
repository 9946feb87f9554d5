"""How patient a session is with its relay: pauses between attempts, and limits of what is logged and kept."""

from dataclasses import dataclass

from mms import ClientLimits
from service.collector.records.policy import RECORD_POLICY, RecordPolicy
from service.timing.backoff import Backoff

RECONNECT = Backoff(first_s=0.5, longest_s=10.0)
CLIENT_LIMITS = ClientLimits()


@dataclass(frozen=True, slots=True)
class SessionPolicy:
    """Times and limits of a session that are no settings; tests use shorter ones.

    records: what is waited for, and what each kind of failure leads to.
    client: how much the MMS client takes from a relay that keeps answering.
    reconnect: pauses between visits that fail.
    report_retry_s: between attempts to get a report block, where all are refused: another client may have
    left one.
    reminder_s: a link that stays down for the same reason is logged this often.
    most_alarms: of a kind; a relay that lists a million bad names gets one more that says so.
    faults_in_a_row: so many visits that end by a broken protocol, with no good one between them, bring a
    quarantine.
    good_visit_s: a visit that goes well for so long is a good one; one good answer is not enough.
    """

    records: RecordPolicy = RECORD_POLICY
    client: ClientLimits = CLIENT_LIMITS
    reconnect: Backoff = RECONNECT
    report_retry_s: float = 60.0
    reminder_s: float = 600.0
    most_alarms: int = 1000
    faults_in_a_row: int = 5
    good_visit_s: float = 10.0


SESSION_POLICY = SessionPolicy()
