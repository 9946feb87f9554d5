"""The plant of the filled database: 500 motors, of which some are unlike the others."""

from service.plant import Plant, PlantMotor, Relay, Site
from testing.service.plants import motor, relay

SITES = 5

BUSY = 0
"""A tenth of all there is belongs to this motor."""

QUIET = 1
"""This motor has a handful of everything."""

IDLE = 2
"""This motor has nothing."""


def motor_name(number: int) -> str:
    return f"MOTOR-{number:04d}"


def relay_name(number: int) -> str:
    return f"RELAY_{number:04d}"


def plant_of(motors: int) -> Plant:
    """Return a plant in which every motor has a relay of its own."""
    sites = tuple(Site(f"SITE_{number}", f"Site {number}") for number in range(SITES))
    relays: list[Relay] = []
    plant_motors: list[PlantMotor] = []
    for number in range(motors):
        site = sites[number % SITES].name
        relays.append(relay(relay_name(number), site, 20_000 + number))
        plant_motors.append(PlantMotor(motor(motor_name(number)), "Pump", site, relay_name(number)))
    return Plant(sites=sites, relays=tuple(relays), motors=tuple(plant_motors))
