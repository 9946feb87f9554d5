"""Directory services of an association (IEC 61850-7-2): what the data model of a relay holds.

The names of a logical device, of its variables and of its data sets, are listed once for each association
(ISO 9506-2, GetNameList), all of them in parts. One device that a relay cannot list leaves the others.
"""

from collections.abc import Callable, Iterable
from typing import TypeAlias

from mms.binding.linked_lists import take_names
from mms.client.connection import Connection, ServiceFunction
from mms.client.data_sets import data_set_members
from mms.references import logical_device, object_reference

_BUFFERED, _UNBUFFERED = "BR", "RP"
_NO_DATA = frozenset({"BR", "RP", "GO", "LG", "MS", "US"})
"""Functional constraints of control blocks, which are no data objects."""

_Nodes: TypeAlias = dict[str, dict[str, dict[str, None]]]
"""Logical nodes of a device: of each its functional constraints, of those the names right below, in order."""


class ModelBrowser:
    """Lists what the data model of one relay holds.

    Parameters
    ----------
    connection : Connection
        The open association.
    """

    def __init__(self, connection: Connection) -> None:
        self._connection = connection
        self._devices = connection.first_names
        self._nodes: dict[str, _Nodes] = {}
        self._data_sets: dict[str, list[str]] = {}

    def logical_devices(self) -> list[str]:
        """List the logical devices of the relay (MMS domains).

        Returns
        -------
        list of str
            Names such as "A1_SEL710CON".

        Raises
        ------
        MmsError
            The relay gave no list.

        References
        ----------
        IEC 61850-7-2, GetServerDirectory.
        """
        operation = "list logical devices"
        with self._connection.exclusive(operation):
            if self._devices is None:
                self._devices = self._names(
                    operation,
                    self._connection.lib.MmsConnection_getDomainNames,
                    longest_s=self._connection.limits.names_s,
                )
        return list(self._devices)

    def logical_nodes(self, device: str) -> list[str]:
        """List the logical nodes of one logical device.

        Parameters
        ----------
        device : str
            Name of the logical device.

        Returns
        -------
        list of str
            Names such as "RBGGIO1".

        Raises
        ------
        NotFound
            There is no such logical device.

        References
        ----------
        IEC 61850-7-2, GetLogicalDeviceDirectory.
        """
        return list(self._nodes_of(device))

    def data_objects(self, node: str) -> list[str]:
        """List the data objects of a logical node.

        Parameters
        ----------
        node : str
            Reference "LD/LN".

        Returns
        -------
        list of str
            Names of the data objects.

        References
        ----------
        IEC 61850-7-2, GetLogicalNodeDirectory.
        """
        return self._names_below(node, lambda constraint: constraint not in _NO_DATA)

    def data_sets(self, node: str) -> list[str]:
        """List the data sets of a logical node.

        Parameters
        ----------
        node : str
            Reference "LD/LN".

        Returns
        -------
        list of str
            Names of the data sets.

        References
        ----------
        IEC 61850-7-2, GetLogicalNodeDirectory.
        """
        device, _, name = object_reference(node).decode("ascii").partition("/")
        if device not in self._data_sets:
            self._data_sets[device] = self._names(
                f"list data sets of {device}",
                self._connection.lib.MmsConnection_getDomainVariableListNames,
                logical_device(device),
                longest_s=self._connection.limits.directory_s,
            )
        return [
            data_set
            for owner, _, data_set in (each.partition("$") for each in self._data_sets[device])
            if owner == name and data_set
        ]

    def buffered_reports(self, node: str) -> list[str]:
        """List the buffered report control blocks of a logical node.

        Parameters
        ----------
        node : str
            Reference "LD/LN".

        Returns
        -------
        list of str
            Names of the blocks.

        References
        ----------
        IEC 61850-7-2, GetLogicalNodeDirectory.
        """
        return self._names_below(node, lambda constraint: constraint == _BUFFERED)

    def unbuffered_reports(self, node: str) -> list[str]:
        """List the unbuffered report control blocks of a logical node.

        Parameters
        ----------
        node : str
            Reference "LD/LN".

        Returns
        -------
        list of str
            Names of the blocks.

        References
        ----------
        IEC 61850-7-2, GetLogicalNodeDirectory.
        """
        return self._names_below(node, lambda constraint: constraint == _UNBUFFERED)

    def data_set_directory(self, reference: str) -> tuple[str, ...]:
        """List the members of a data set.

        Parameters
        ----------
        reference : str
            Reference "LD/LN.name".

        Returns
        -------
        tuple of str
            References of the members, "LD/LN.DO.DA[FC]".

        Raises
        ------
        NotFound
            There is no such data set.
        ProtocolError
            The relay names a member that is none.

        References
        ----------
        IEC 61850-7-2, GetDataSetDirectory.
        """
        return data_set_members(self._connection, reference)

    def _names_below(self, node: str, wanted: Callable[[str], bool]) -> list[str]:
        """Return the names of data objects or control blocks of a node, by their functional constraint."""
        device, _, name = object_reference(node).decode("ascii").partition("/")
        constraints = self._nodes_of(device).get(name, {})
        return list(
            dict.fromkeys(
                below for constraint, names in constraints.items() if wanted(constraint) for below in names
            )
        )

    def _nodes_of(self, device: str) -> "_Nodes":
        if device not in self._nodes:
            variables = self._names(
                f"list logical nodes of {device}",
                self._connection.lib.MmsConnection_getDomainVariableNames,
                logical_device(device),
                longest_s=self._connection.limits.names_s,
            )
            self._nodes[device] = _nodes(variables)
        return self._nodes[device]

    def _names(
        self, operation: str, function: ServiceFunction, *domain: bytes, longest_s: float
    ) -> list[str]:
        names = self._connection.request(operation, function, *domain, longest_s=longest_s)
        return take_names(self._connection.lib, names)


def _nodes(variables: Iterable[str]) -> _Nodes:
    """Sort the variables of a device, LN$FC$DO$..., by node and functional constraint.

    A relay has thousands of variables: they are walked through once, and not kept.
    """
    nodes: _Nodes = {}
    for variable in variables:
        node, *below = variable.split("$", 3)
        constraints = nodes.setdefault(node, {})
        if len(below) > 1:
            constraints.setdefault(below[0], {})[below[1]] = None
    return nodes
