"""Where a relay's server listens: at the relay's address, or behind a front that does what it cannot."""

from collections.abc import Mapping

from ied_sim.errors import SimulatorError
from ied_sim.front import RelayProxies
from ied_sim.front.proxy import OpenOverflowServer
from ied_sim.misbehaviour import MADE_BY_PROXY, MisbehaviourState
from ied_sim.relay.configuration import RelayConfiguration
from mms import MOST_CONNECTIONS
from scl import Address


def listening_address(
    relay: str,
    address: Address,
    configuration: RelayConfiguration,
    misbehaviour_state: MisbehaviourState,
    proxies: RelayProxies | None,
    *,
    report_ids: Mapping[str, str],
    overflow_server: OpenOverflowServer,
) -> Address:
    """Return where the server listens: behind a proxy if clients must see what the server cannot do.

    Parameters
    ----------
    relay : str
        Name of the relay.
    address : Address
        Where clients find it.
    configuration : RelayConfiguration
        What kind of relay it is.
    misbehaviour_state : MisbehaviourState
        What it does wrong.
    proxies : RelayProxies or None
        Where it gets a proxy if it needs one.
    report_ids : mapping of str to str
        Reference of each report control block by its RptID.
    overflow_server : callable
        Opens the server for clients beyond those that one server has sessions for.

    Returns
    -------
    Address
        The relay's own address, or one behind the proxy.

    Raises
    ------
    SimulatorError
        A proxy is needed and not possible.
    """
    profile = configuration.profile
    files = profile.files
    rewritten = bool(misbehaviour_state.kinds & MADE_BY_PROXY) or (
        files is not None
        and (files.separator != "/" or files.listed != "path" or files.entries_per_listing is not None)
    )
    encrypted = configuration.access.tls is not None
    if encrypted and rewritten:
        raise SimulatorError(
            f"{relay}: its profile or scenario needs a front between relay and clients, which could "
            "not read TLS; take another profile (sel-710-ed2, say), or leave out tls or the misbehaviour"
        )
    if encrypted or not (rewritten or profile.sessions > MOST_CONNECTIONS):
        return address
    if proxies is None:
        raise SimulatorError(f"{relay}: its profile or scenario needs a front, and it has no place for one")
    return proxies.add(
        address,
        files,
        misbehaviour_state,
        report_ids,
        sessions=profile.sessions,
        overflow_server=overflow_server,
    )
