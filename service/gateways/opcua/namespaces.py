"""The namespaces of the nodes: the standard's, those of its companion specifications, and our own."""

from dataclasses import dataclass
from typing import Final

from asyncua import Server, ua

STANDARD: Final = "http://opcfoundation.org/UA/"
OURS: Final = "urn:statorwatch:plant"
DEVICES: Final = "http://opcfoundation.org/UA/DI/"
"""OPC UA for Devices, OPC 10000-100."""
MACHINERY: Final = "http://opcfoundation.org/UA/Machinery/"
"""OPC UA for Machinery, OPC 40001-1."""


@dataclass(frozen=True, slots=True)
class Namespaces:
    """Indices of the namespaces at a server. ours: 2, which clients that spell out indices rely on."""

    ours: int
    devices: int
    machinery: int

    @classmethod
    async def registered(cls, server: Server) -> "Namespaces":
        """Register them, ours first."""
        indices = [await server.register_namespace(uri) for uri in (OURS, DEVICES, MACHINERY)]
        return cls(*indices)

    def index(self, uri: str) -> int:
        """Return the index of a namespace."""
        return {STANDARD: 0, OURS: self.ours, DEVICES: self.devices, MACHINERY: self.machinery}[uri]

    def node_id(self, uri: str, identifier: int | str) -> ua.NodeId:
        """Return the identifier of a node."""
        return ua.NodeId(identifier, self.index(uri))

    def name(self, uri: str, name: str) -> ua.QualifiedName:
        """Return a browse name."""
        return ua.QualifiedName(name, self.index(uri))

    def own(self, path: str) -> ua.NodeId:
        """Return the identifier of one of our nodes by its path, such as ``motor/PUMP-A1``."""
        return ua.NodeId(path, self.ours)
