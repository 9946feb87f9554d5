"""Links that are down for long, and sites that are lost: `link-down`, `site-lost`.

When most relays of a site stop answering at about the same time, that is one alarm. What follows from it at
this site is suppressed until the site is back.
"""

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence

import structlog

from core.time_stamps import rfc3339
from core.units import NANOSECONDS_PER_SECOND
from service.alarms.confirmation import Decision, Delays
from service.alarms.kinds import AlarmKind
from service.alarms.outages import SiteRule, down_since
from service.background.alarm_sources.standing import StandingAlarms
from service.configuration.settings import Settings
from service.storage import Repository
from service.storage.records import Alarm, AlarmPlace, AlarmSpec
from service.storage.records.alarm_sources import AlarmFinding, LinkOutlook
from service.storage.states import LinkState

log = structlog.get_logger(__name__)

TOGETHER_S = 60.0
"""Relays of a site go down together within this time, and that in which the service notices it [s]."""

MOST_A_LOOK = 200
"""So many alarms are raised or cleared in one look, so that it lasts a few seconds at most."""

LEFT = "the relay left the plant"


class LinkSource:
    """Compares all links with the rules of the settings."""

    def __init__(self, settings: Settings, repository: Repository, started_ns: int) -> None:
        """started_ns: while the service was off no relay was asked, so time counts from then on."""
        rules = settings.alarms
        self._repository = repository
        self._started_ns = started_ns
        self._delays = Delays(rules.link_down_s, 0.0)
        self._settle_ns = round(rules.link_up_s * NANOSECONDS_PER_SECOND)
        self._lost_for_ns = round(rules.site_lost_s * NANOSECONDS_PER_SECOND)
        noticed_s = settings.poll_period_s + settings.connect_timeout_s + settings.request_timeout_s
        within_ns = round((TOGETHER_S + noticed_s) * NANOSECONDS_PER_SECOND)
        self._site_rule = SiteRule(rules.site_lost_share, within_ns, rules.site_lost_relays)
        self._history_ns = self._settle_ns + round(rules.link_down_s * NANOSECONDS_PER_SECOND) + within_ns

    def look(self, now_ns: int) -> None:
        """Raise and clear what has changed since the last look. Raises SQLAlchemyError."""
        links = self._repository.link_outlooks()
        standing = StandingAlarms(self._repository, AlarmKind.LINK_DOWN, AlarmKind.SITE_LOST)
        down_ns = self._down_since(links, standing, now_ns)
        by_site: dict[str, list[LinkOutlook]] = defaultdict(list)
        for link in links:
            by_site[link.site].append(link)
        back, together = [], set[str]()
        for site, of_site in by_site.items():
            lost = standing.of(AlarmKind.SITE_LOST, site)
            if lost is None:
                together |= self._lose(site, of_site, down_ns, now_ns)
            elif self._site_rule.is_back(sum(link.relay in down_ns for link in of_site), len(of_site)):
                back.append(site)
            else:
                self._tell_again(lost, of_site, down_ns, now_ns)
        findings = [
            finding
            for link in links
            if (finding := self._finding(link, down_ns, standing, now_ns, hold=link.relay in together))
        ]
        findings += standing.gone(AlarmKind.LINK_DOWN, {link.relay for link in links}, LEFT)
        findings.sort(key=lambda one: one.spec is not None)  # what is over first
        self._repository.settle_findings(findings[:MOST_A_LOOK], now_ns=now_ns)
        if len(findings) > MOST_A_LOOK:
            return  # the next look goes on; no site is back before its links are known to be
        for site, _ in standing.about(AlarmKind.SITE_LOST):
            if site in back or site not in by_site:
                self._repository.regain_site(site, "most of its relays answer again", now_ns=now_ns)
                log.info("site is back", site=site)

    def _down_since(
        self, links: Iterable[LinkOutlook], standing: StandingAlarms, now_ns: int
    ) -> Mapping[str, int]:
        """Return since when links are down, by relay; those that are up are left out."""
        doubtful = [
            link
            for link in links
            if link.state is not LinkState.UP
            or standing.of(AlarmKind.LINK_DOWN, link.relay) is not None
            or (link.changed_ns is not None and now_ns - link.changed_ns < self._settle_ns)
        ]
        periods = self._repository.link_periods(
            [link.relay for link in doubtful], since_ns=now_ns - self._history_ns
        )
        found = {}
        for link in doubtful:
            since_ns = down_since(periods.get(link.relay, ()), now_ns, self._settle_ns)
            if since_ns is not None:
                found[link.relay] = since_ns
        return found

    def _lose(
        self, site: str, links: Sequence[LinkOutlook], down_ns: Mapping[str, int], now_ns: int
    ) -> set[str]:
        """Raise the alarm of a site whose relays went down together.

        Returns the relays that went down together moments ago: they wait until it is sure.
        """
        down = {
            link.relay: down_ns[link.relay]
            for link in links
            if link.relay in down_ns and link.state is LinkState.DOWN
        }
        if self._site_rule.lost_since(down.values(), len(links)) is None:
            return set()
        surely = [since_ns for since_ns in down.values() if now_ns - since_ns >= self._lost_for_ns]
        lost_ns = self._site_rule.lost_since(surely, len(links))
        if lost_ns is None:
            return set(down)
        reason = _told(links, down_ns)
        self._repository.lose_site(site, reason, since_ns=lost_ns, now_ns=now_ns)
        log.warning("site is lost", site=site, reason=reason)
        return set()

    def _tell_again(
        self, lost: Alarm, links: Sequence[LinkOutlook], down_ns: Mapping[str, int], now_ns: int
    ) -> None:
        reason = _told(links, down_ns)
        if reason != lost.reason:
            spec = AlarmSpec(AlarmKind.SITE_LOST, reason, one_of_kind=True)
            self._repository.raise_alarm_at(AlarmPlace(site=lost.site), spec, now_ns=now_ns)

    def _finding(
        self,
        link: LinkOutlook,
        down_ns: Mapping[str, int],
        standing: StandingAlarms,
        now_ns: int,
        *,
        hold: bool,
    ) -> AlarmFinding | None:
        since_ns = down_ns.get(link.relay)
        stands = standing.of(AlarmKind.LINK_DOWN, link.relay) is not None
        seen_ns = None if since_ns is None else max(since_ns, self._started_ns)
        for_s = 0.0 if seen_ns is None else (now_ns - seen_ns) / NANOSECONDS_PER_SECOND
        decision = self._delays.decide(for_s, is_bad=since_ns is not None, stands=stands)
        # A quarantine is an alarm of its own, and a link that is just up may stay so.
        is_quiet = hold or link.state in {LinkState.UP, LinkState.QUARANTINED}
        if decision is not Decision.CLEAR and is_quiet:
            return None
        since = "" if since_ns is None else f"down since {rfc3339(since_ns)[:19]}Z"
        reason = "; ".join(text for text in (since, link.reason) if text)
        spec = AlarmSpec(AlarmKind.LINK_DOWN, reason, one_of_kind=True)
        return standing.finding(
            link.relay, AlarmPlace(relay=link.relay), spec, decision, "the relay answers again"
        )


def _told(links: Sequence[LinkOutlook], down_ns: Mapping[str, int]) -> str:
    return f"{sum(link.relay in down_ns for link in links)} of {len(links)} relays do not answer"
