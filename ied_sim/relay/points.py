"""The points of a profile, found in the model of a relay: references as clients use them."""

from collections.abc import Container

from ied_sim.profiles.profile import Profile
from ied_sim.relay.standard_points import fitted_points, is_operable
from scl.data_model import DataAttribute, DataObject, FunctionalConstraint
from scl.ied_model import Ied

_VALUE_ATTRIBUTES = frozenset({"stVal", "general", "instMag", "mag", "instCVal", "cVal"})
_BOOLEAN = frozenset({"BOOLEAN"})
_FLOAT = frozenset({"FLOAT32", "FLOAT64"})
_NUMBERS = frozenset({"INT16", "INT24", "INT32", "INT64", "INT16U", "INT24U", "INT32U"})
_PUBLISHED = frozenset({FunctionalConstraint.ST, FunctionalConstraint.MX})
_STAMPS = {"q": "Quality", "t": "Timestamp"}


class RelayPoints:
    """Points of `profile` in the model of `ied`, or what the model has in their place."""

    def __init__(self, ied: Ied, profile: Profile) -> None:
        self._ied = ied
        self._domains = {device.inst: device.name for device in ied.logical_devices}
        self._profile = profile
        self._fitted = fitted_points(ied, profile.points)
        self._points = profile.points.model_copy(update=self._fitted)
        self.metering, self.sequence = self._points.metering, self._points.sequence
        controls = ied.data_objects(common_data_class="SPC")
        self.controls = tuple(placed.reference for placed in controls if is_operable(placed.data_object))
        self.triggers = frozenset(self.reference(each) for each in self._points.trigger)
        pulsed = tuple(f"{self.reference(node)}." for node in self._points.pulse)
        self.pulsed = frozenset(each for each in self.controls if each.startswith(pulsed or ("/",)))

    @property
    def departures(self) -> str | None:
        """What the model has in place of points of the profile, in words; None where it has all of them."""
        if not self._fitted:
            return None
        told = [f"{key} is {_words(point)}" for key, point in self._fitted.items() if point]
        without = [key for key, point in self._fitted.items() if not point]
        if without:
            told.append(f"no {', '.join(without)}")
        return f"not all points of {self._profile.name} are in its model: {'; '.join(told)}"

    @property
    def reports(self) -> str | None:
        """Reference of the buffered report control block that reports records."""
        reports = self._points.reports
        return None if reports is None else self.reference(reports)

    @property
    def frequency(self) -> str | None:
        """Reference of the metered frequency, None where there is none."""
        if self.metering is None:
            return None
        reference = self.reference(f"{self.metering}.Hz")
        return reference if self._ied.find(reference) is not None else None

    def is_measurand(self, reference: str) -> bool:
        """Tell whether the model has a metered value of this reference."""
        return self.has(reference, _FLOAT)

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
        types = _NUMBERS if key == "record_number" else _BOOLEAN
        named = (self.reference(f"{found}.{attribute}") for attribute in ("stVal", "general"))
        return next((reference for reference in named if self.has(reference, types)), None)

    def status_of(self, control: str) -> str | None:
        """Return the reference of a control's status, None for a control that clients can only operate."""
        reference = f"{control}.stVal"
        return reference if self.has(reference, _BOOLEAN) else None

    def has(self, reference: str, types: Container[str]) -> bool:
        """Tell whether the model has an attribute of one of the basic types."""
        found = self._ied.find(reference)
        return (
            isinstance(found, DataAttribute)
            and found.basic_type in types
            and found.fc in _PUBLISHED
            and not found.count
        )

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
        stamps = (f"{data_object}.{name}" for name in _STAMPS)
        quality, time = (
            stamp if self.has(stamp, {kind}) else None
            for stamp, kind in zip(stamps, _STAMPS.values(), strict=True)
        )
        return quality, time


def _words(point: object) -> str:
    return ", ".join(map(str, point)) if isinstance(point, tuple) else str(point)
