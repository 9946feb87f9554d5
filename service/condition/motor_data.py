"""What the motors file says of a motor, as it is stored: a record is judged by what was said at its time."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

from core.machines.deep_bars import DeepBars, LeakageSaturation
from core.machines.parameters import (
    Connection,
    Limits,
    MachineParameters,
    Motor,
    Nameplate,
    ParametersSource,
    ParameterTolerances,
    WoundRotor,
)
from core.machines.sensors import SensorClass
from core.machines.stator_winding import StatorWinding, WindingKind
from service.storage.records import MotorVersion


def document_of(motor: Motor) -> dict[str, Any]:
    """Return all that a motor's condition depends on."""
    plate = asdict(motor.nameplate)
    del plate["rotor_bars"]
    if motor.nameplate.rated_speed_rpm is None:
        del plate["rated_speed_rpm"]
    document = {
        "nameplate": plate,
        "parameters": asdict(motor.parameters),
        "tolerances": {"source": str(motor.parameters_source), **asdict(motor.tolerances)},
        "limits": asdict(motor.limits),
        "sensors": asdict(motor.sensors),
    }
    if motor.wound_rotor is not None:
        rotor = asdict(motor.wound_rotor)
        document["wound_rotor"] = {**rotor, "external_resistance_ohm": [*rotor["external_resistance_ohm"]]}
    if motor.winding is not None:
        document["winding"] = {**asdict(motor.winding), "kind": str(motor.winding.kind)}
    if motor.deep_bars is not None:
        document["deep_bars"] = asdict(motor.deep_bars)
    if motor.leakage_saturation is not None:
        document["leakage_saturation"] = asdict(motor.leakage_saturation)
    return document


def motor_of(motor: Motor, document: Mapping[str, Any]) -> Motor:
    """Return a motor with the nameplate and the parameters that it had."""
    nameplate, tolerances = dict(document["nameplate"]), dict(document["tolerances"])
    source = ParametersSource(tolerances.pop("source"))
    connection = Connection(nameplate["connection"])
    slots = motor.nameplate.rotor_bars  # no condition depends on them: they are as the file says now
    return replace(
        motor,
        nameplate=Nameplate(**{**nameplate, "connection": connection, "rotor_bars": slots}),
        parameters=MachineParameters(**document["parameters"]),
        parameters_source=source,
        tolerances=ParameterTolerances(**tolerances),
        wound_rotor=_wound_rotor(document.get("wound_rotor")),
        winding=_winding(document.get("winding")),
        deep_bars=DeepBars(**document["deep_bars"]) if "deep_bars" in document else None,
        leakage_saturation=(
            LeakageSaturation(**document["leakage_saturation"]) if "leakage_saturation" in document else None
        ),
    )


def _winding(table: Mapping[str, Any] | None) -> StatorWinding | None:
    """Return how the stator is wound; None where the file did not tell it."""
    return None if table is None else StatorWinding(**{**table, "kind": WindingKind(table["kind"])})


def _wound_rotor(table: Mapping[str, Any] | None) -> WoundRotor | None:
    """Return the rotor's winding; None of a cage, of which documents say nothing."""
    if table is None:
        return None
    least, most = table["external_resistance_ohm"]
    return WoundRotor(**{**table, "external_resistance_ohm": (least, most)})


def motor_known(name: str, document: Mapping[str, Any]) -> Motor:
    """Return a motor as a document describes it, where the motors file is not at hand.

    Channels and ratios of transformers are not in it.
    """
    plate = document["nameplate"]
    bare = Motor(
        name,
        Nameplate(**{**plate, "connection": Connection(plate["connection"])}),
        MachineParameters(**document["parameters"]),
        limits=Limits(**document["limits"]),
        sensors=SensorClass(**document["sensors"]),
    )
    return motor_of(bare, document)


@dataclass(frozen=True, slots=True)
class MotorHistory:
    """A motor over time. motor: as it is now.  versions: what was said of it, oldest first."""

    motor: Motor
    versions: Sequence[MotorVersion]

    def at(self, time_ns: int) -> Motor:
        """Return the motor as it was: before the first version, as in that one."""
        current: MotorVersion | None = None
        for version in self.versions:
            if current is None or version.from_ns <= time_ns:
                current = version
        return self.motor if current is None else motor_of(self.motor, current.document)

    def edited_at(self, time_ns: int) -> Motor | None:
        """Return the motor as it is from exactly this time on; None where nothing was edited then."""
        found: Iterable[MotorVersion] = (one for one in self.versions if one.from_ns == time_ns)
        version = next(iter(found), None)
        return None if version is None else motor_of(self.motor, version.document)
