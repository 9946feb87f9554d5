"""The points of a profile, found in the model of a relay: references as clients use them."""

from collections.abc import Iterator

from ied_sim.errors import SimulatorError
from ied_sim.profiles.profile import Profile
from scl.data_model import DataObject
from scl.ied_model import Ied

_VALUE_ATTRIBUTES = frozenset({"stVal", "general", "instMag", "mag", "instCVal", "cVal"})


class RelayPoints:
    """Points of `profile` in the model of `ied`. Raises SimulatorError where the model lacks one."""

    def __init__(self, ied: Ied, profile: Profile, source: str) -> None:
        self._ied = ied
        self._points = profile.points
        self._domains = {device.inst: device.name for device in ied.logical_devices}
        self._complaint = (
            f"{source}: {ied.name} has no {{}}, so it is no {profile.name} (points.{{}} of its profile); "
            "choose the relays with --ied, or another profile in the scenario"
        )
        for key, reference in self._points.controls():
            self._require(key, reference, is_control=True)
        for key, reference in self._points.statuses():
            self._require(key, reference, is_control=False)
        for key in ("metering", "sequence"):
            node = getattr(self._points, key)
            if node is not None and not self._has_node(node):
                raise SimulatorError(self._complaint.format(node, key))
        if self._points.reports is not None and self.reports not in set(self._buffered_reports()):
            raise SimulatorError(self._complaint.format(self._points.reports, "reports"))
        self.controls = tuple(placed.reference for placed in ied.data_objects(common_data_class="SPC"))
        self.triggers = frozenset(self.reference(each) for each in self._points.trigger)
        pulsed = tuple(f"{self.reference(node)}." for node in self._points.pulse)
        self.pulsed = frozenset(each for each in self.controls if each.startswith(pulsed or ("/",)))

    @property
    def reports(self) -> str | None:
        """Reference of the buffered report control block that reports records."""
        reports = self._points.reports
        return None if reports is None else self.reference(reports)

    @property
    def frequency(self) -> str | None:
        """Reference of the metered frequency, None where there is none."""
        reference = f"{self._points.metering}.Hz"
        return self.reference(reference) if self.has(self.reference(reference)) else None

    def reference(self, inst_reference: str) -> str:
        """Return the reference that clients use, with the domain in place of the logical device's inst."""
        inst, _, rest = inst_reference.partition("/")
        return f"{self._domains.get(inst, inst)}/{rest}"

    @staticmethod
    def remote_bit(reference: str) -> str | None:
        """Return the number ("01") of the remote bit that a control of RBGGIO or PRBGGIO sets."""
        node, _, control = reference.rpartition("/")[2].partition(".")
        return control.removeprefix("SPCSO") if node.startswith(("RBGGIO", "PRBGGIO")) else None

    def control(self, key: str) -> str | None:
        """Return the reference of the control `key` ("start"), None where the profile names none."""
        found = getattr(self._points, key)
        return None if found is None else self.reference(found)

    def value_of(self, key: str) -> str | None:
        """Return the reference of the value of the status `key` ("record_made"), None where there is none."""
        found = getattr(self._points, key)
        if found is None:
            return None
        attribute = "stVal" if self._ied.find(f"{found}.stVal") is not None else "general"
        return self.reference(f"{found}.{attribute}")

    def has(self, reference: str) -> bool:
        """Tell whether the model has such an object or attribute."""
        return self._ied.find(reference) is not None

    def report_ids(self) -> dict[str, str]:
        """Return the MMS reference of each report control block by its RptID."""
        return {
            report.report_id: reference.replace(".", "$")
            for report in self._ied.report_controls()
            for reference in report.references
            if report.report_id is not None
        }

    def stamps(self, attribute: str) -> tuple[str | None, str | None]:
        """Return the references of quality and time beside a value attribute, None where missing."""
        names = attribute.split(".")
        place = next(place for place, name in enumerate(names) if name in _VALUE_ATTRIBUTES)
        data_object = ".".join(names[:place])
        found = self._ied.find(data_object)
        if not isinstance(found, DataObject):
            return None, None
        own = {attribute.name for attribute in found.attributes}
        return f"{data_object}.q" if "q" in own else None, f"{data_object}.t" if "t" in own else None

    def _require(self, key: str, reference: str, *, is_control: bool) -> None:
        found = self._ied.find(reference)
        if not isinstance(found, DataObject) or (is_control and found.find("Oper") is None):
            what = f"control {reference}" if is_control and found is not None else reference
            raise SimulatorError(self._complaint.format(what, key))

    def _has_node(self, reference: str) -> bool:
        full = self.reference(reference)
        return any(node.reference == full for node in self._ied.logical_nodes())

    def _buffered_reports(self) -> Iterator[str]:
        for report in self._ied.report_controls(buffered=True):
            yield from report.references
