"""Directory services of an association (IEC 61850-7-2): what the data model of a relay holds."""

from mms.binding.linked_lists import take_names
from mms.client.connection import Connection
from mms.client.data_sets import data_set_members
from mms.references import logical_device, object_reference

_DATA_OBJECT, _DATA_SET, _BUFFERED, _UNBUFFERED = range(4)  # the library's ACSIClass


class ModelBrowser:
    """Lists what the data model of one relay holds.

    Parameters
    ----------
    connection : Connection
        The open association.
    """

    def __init__(self, connection: Connection) -> None:
        self._connection = connection

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
        lib = self._connection.lib
        return take_names(
            lib, self._connection.request("list logical devices", lib.IedConnection_getLogicalDeviceList)
        )

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
        name = logical_device(device)
        lib = self._connection.lib
        return take_names(
            lib,
            self._connection.request(
                f"list logical nodes of {device}", lib.IedConnection_getLogicalDeviceDirectory, name
            ),
        )

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
        return self._node_directory(node, _DATA_OBJECT)

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
        return self._node_directory(node, _DATA_SET)

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
        return self._node_directory(node, _BUFFERED)

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
        return self._node_directory(node, _UNBUFFERED)

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

    def _node_directory(self, node: str, kind: int) -> list[str]:
        lib = self._connection.lib
        return take_names(
            lib,
            self._connection.request(
                f"directory of {node}",
                lib.IedConnection_getLogicalNodeDirectory,
                object_reference(node),
                kind,
                longest_s=self._connection.limits.directory_s,
            ),
        )
