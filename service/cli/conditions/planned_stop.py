"""`mcc plan-stop`: when a motor or a site stops next."""

from rich.text import Text

from core.error_words import one_line
from service.cli.output import failing_clearly, print_document, results
from service.client.rest_client import ServiceClient, ServiceError
from service.client.verdicts import local_time


def plan_stop(url: str, name: str, time: str | None, *, is_site: bool, as_json: bool) -> None:
    """Plan the stop of a motor or a site, or drop the plan where no time is given. Raises CommandError."""
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        if time is None:
            (service.cancel_stop_of_site if is_site else service.cancel_stop)(name)
        else:
            (service.plan_stop_of_site if is_site else service.plan_stop)(name, {"time": time})
        stop = service.get_planned_stop_of_site(name) if is_site else service.get_planned_stop(name)
    if as_json:
        print_document(stop)
        return
    when = stop["time"]
    words = "no stop is planned" if when is None else f"stops {local_time(when)} (plan of the {stop['of']})"
    results().print(Text(one_line(f"{name}: {words}")), soft_wrap=True)
