"""The settings a relay shows: names after the SEL-710's, values from what is simulated."""

from ied_sim.motor.plant import rated_current
from ied_sim.relay.configuration import RelayConfiguration


def relay_settings(name: str, configuration: RelayConfiguration) -> tuple[tuple[str, str], ...]:
    """Return name and value of each setting, in the order they are listed; "OFF" for what is not in use."""
    nameplate = configuration.plant.motor.nameplate
    recorder, protection = configuration.recorder, configuration.protection
    cycles = recorder.pre_trigger_s + recorder.post_trigger_s
    frequency_Hz = nameplate.rated_frequency_Hz
    overcurrent, unbalance, thermal = protection.overcurrent, protection.unbalance, protection.thermal
    return (
        ("RID", name),
        ("TID", "MOTOR"),
        ("PHROT", configuration.plant.supply.sequence.upper()),
        ("FNOM", f"{frequency_Hz:g}"),
        ("FLA", f"{rated_current(configuration.plant.motor):.2f}"),
        ("VNOM", f"{nameplate.rated_voltage_V:g}"),
        ("E49MOTOR", "Y" if thermal else "N"),
        ("SF", f"{thermal.service_factor:g}" if thermal else "OFF"),
        ("RTC", f"{thermal.time_constant_s / 60:g}" if thermal else "OFF"),
        ("50P1P", f"{overcurrent.pickup:g}" if overcurrent else "OFF"),
        ("50P1D", f"{overcurrent.delay_s:g}" if overcurrent else "OFF"),
        ("46UBT", f"{100 * unbalance.pickup:g}" if unbalance else "OFF"),
        ("46UBTD", f"{unbalance.delay_s:g}" if unbalance else "OFF"),
        ("ER", "R_TRIG RB01"),
        ("LER", f"{cycles * frequency_Hz:g}"),
        ("PRE", f"{recorder.pre_trigger_s * frequency_Hz:g}"),
        ("LDAR", f"{configuration.load_profile_s / 60:g}"),
    )
