"""Which relay each motor has: by the Substation section of the SCD, or by the motors file."""

from collections.abc import Mapping
from dataclasses import dataclass

import scl
from core.error_words import nearest
from service.configuration.problems import Problem, Problems
from service.plant.motors_file import MotorsFile

SITE = "PLANT"
"""Relays whose site no file names are here."""


@dataclass(frozen=True, slots=True)
class Binding:
    """A motor of both files with its relay."""

    motor: str
    relay: str
    site: str
    site_description: str = ""
    motor_description: str = ""
    bus: str | None = None


def bindings(configuration: scl.Scl | None, told: MotorsFile, problems: Problems) -> tuple[Binding, ...]:
    """Return the motors with their relays, those of the SCD first."""
    feeders = () if configuration is None else configuration.feeders()
    names_relays = any(entry.relay for entry in told.motors.values()) or told.relays
    if configuration is not None and not feeders and not names_relays:
        problems.add(
            Problem(
                str(configuration.path),
                "<Substation>",
                'motors (ConductingEquipment type="MOT" with an LNode of their relay), '
                f"or a relay for each motor of {told.path.name}",
                "none",
            )
        )
        return ()
    found: dict[str, Binding] = {}
    for feeder in feeders:
        if feeder.motor in found and configuration is not None:
            problems.add(
                Problem(
                    str(configuration.path),
                    f"motor {feeder.motor}",
                    "one motor for one relay",
                    f"{feeder.motor} twice",
                )
            )
        found[feeder.motor] = _of_feeder(feeder)
        if _is_told(feeder, told, problems, "" if configuration is None else configuration.path.name):
            _agree(feeder, told, problems)
    for entry in told.motors.values():
        if entry.name in found:
            continue
        if entry.relay is not None:
            relay = told.relays.get(entry.relay)
            site = SITE if relay is None or relay.site is None else relay.site
            found[entry.name] = Binding(entry.name, entry.relay, site)
        elif entry.is_sound:
            problems.add(_without_relay(entry.name, configuration, told))
    _one_motor_a_relay(found, told, problems)
    _known_relays(found, configuration, told, problems)
    return tuple(found.values())


def _of_feeder(feeder: scl.MotorFeeder) -> Binding:
    return Binding(
        feeder.motor,
        feeder.ied,
        feeder.site,
        feeder.site_description,
        feeder.motor_description,
        feeder.bus,
    )


def _is_told(feeder: scl.MotorFeeder, told: MotorsFile, problems: Problems, scd: str) -> bool:
    if feeder.motor in told.motors:
        return True
    problems.add(
        told.problem("motor", feeder.motor, expected=f"its [[motor]] table, as {scd} has it", found="none")
    )
    return False


def _agree(feeder: scl.MotorFeeder, told: MotorsFile, problems: Problems) -> None:
    relay = told.motors[feeder.motor].relay
    if relay not in (None, feeder.ied):
        problems.add(
            told.problem(
                "motor",
                feeder.motor,
                "relay",
                expected=f"{feeder.ied}, as the SCD's Substation section has it, or none",
                found=str(relay),
            )
        )


def _without_relay(motor: str, configuration: scl.Scl | None, told: MotorsFile) -> Problem:
    feeders = () if configuration is None else configuration.feeders()
    expected = 'the name of its relay (relay = "NAME" of a [[relay]] table)'
    if configuration is not None:
        known = ", ".join(sorted(feeder.motor for feeder in feeders)) or "none"
        expected += f", or a motor of {configuration.path.name} ({known})"
    return told.problem(
        "motor",
        motor,
        "relay",
        expected=expected,
        found="none",
        nearest=nearest(motor, [feeder.motor for feeder in feeders if feeder.motor not in told.motors]),
    )


def _one_motor_a_relay(found: Mapping[str, Binding], told: MotorsFile, problems: Problems) -> None:
    motors: dict[str, list[str]] = {}
    for binding in found.values():
        motors.setdefault(binding.relay, []).append(binding.motor)
    for relay, sharing in motors.items():
        if len(sharing) > 1:
            problems.add(
                told.problem(
                    "relay",
                    relay,
                    expected="one motor for one relay, which measures the currents of one",
                    found=" and ".join(sharing),
                )
            )


def _known_relays(
    found: Mapping[str, Binding], configuration: scl.Scl | None, told: MotorsFile, problems: Problems
) -> None:
    """Tell of relays that no file describes, that both do, and that no motor names."""
    ieds = [] if configuration is None else [ied.name for ied in configuration.ieds]
    known = [*told.relays, *ieds]
    shown = ", ".join(known[:20]) or "there is none"
    for binding in found.values():
        if binding.relay not in known:
            scd = "" if configuration is None else f" or an IED of {configuration.path.name}"
            problems.add(
                told.problem(
                    "motor",
                    binding.motor,
                    "relay",
                    expected=f"the name of a [[relay]] table{scd} ({shown})",
                    found=binding.relay,
                    nearest=nearest(binding.relay, known),
                )
            )
    named = {binding.relay for binding in found.values()}
    for entry in told.relays.values():
        if entry.name not in named and all(motor.is_sound for motor in told.motors.values()):
            expected = f'a motor that names it (relay = "{entry.name}")'
            problems.add(told.problem("relay", entry.name, expected=expected, found="none"))
        if entry.name in ieds and entry.scl is not None and configuration is not None:
            problems.add(
                told.problem(
                    "relay",
                    entry.name,
                    "scl",
                    expected=f"no file of its own, since {configuration.path.name} has an IED of this name, "
                    "or another name of the relay",
                    found=entry.scl.name,
                )
            )
