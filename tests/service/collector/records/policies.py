"""Record policies for tests: the default, with other figures."""

from dataclasses import replace
from types import MappingProxyType

from service.collector.records.policy import RECORD_POLICY, Attempts, Failure, FailureRule, RecordPolicy
from service.timing.backoff import Backoff

WRONG_IN_A_ROW = 9
"""After so many attempts, a record that is not as listed is refused by the default policy."""


def with_rules(changed: dict[Failure, FailureRule], policy: RecordPolicy = RECORD_POLICY) -> RecordPolicy:
    """The policy with other rules for these failures."""
    return replace(policy, rules=MappingProxyType({**policy.rules, **changed}))


def with_first_pause(first_s: float, policy: RecordPolicy = RECORD_POLICY) -> RecordPolicy:
    """The policy with another pause after a first failure."""
    return with_rules(
        {
            failure: replace(rule, pause=Backoff(first_s, rule.pause.longest_s))
            for failure, rule in policy.rules.items()
            if rule.pause is not None
        },
        policy,
    )


def with_alarm_after(
    attempts: Attempts, *failures: Failure, policy: RecordPolicy = RECORD_POLICY
) -> RecordPolicy:
    """The policy with an alarm after so many attempts that fail in these ways."""
    return with_rules(
        {failure: replace(policy.rules[failure], alarm_after=(attempts,)) for failure in failures}, policy
    )
