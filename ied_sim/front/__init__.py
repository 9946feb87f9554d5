"""Proxies between a relay's server and its clients, for what the server itself cannot do.

The MMS library answers at once, lists files its own way and never freezes. A proxy passes its octets on
later, changed, or not at all.
"""

from ied_sim.front.proxy import RelayProxies

__all__ = ["RelayProxies"]
