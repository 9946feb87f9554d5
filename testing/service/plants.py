"""A small plant and results for the tests of the service."""

from dataclasses import replace

from core.diagnosis.verdict import Diagnosis, Verdict
from core.machines.parameters import Motor
from core.quality.finding import QualityFinding
from core.units import NANOSECONDS_PER_SECOND
from service.plant import Plant, PlantMotor, Relay, Site
from testing.machines.motors import REFERENCE

SECOND_NS = NANOSECONDS_PER_SECOND
NOW_NS = 1_760_000_000 * SECOND_NS


def motor(name: str) -> Motor:
    """The 800 W machine of the demo plant, under this name."""
    return replace(REFERENCE, name=name)


def relay(name: str, site: str, port: int = 10210) -> Relay:
    return Relay(
        name=name,
        site=site,
        host="127.0.0.1",
        port=port,
        manufacturer="SEL",
        type="SEL-710",
        trigger_control=f"{name}CON/RBGGIO1.SPCSO01",
        record_made=f"{name}PRO/FLTRDRE1.RcdMade",
        fault_number=f"{name}PRO/FLTRDRE1.FltNum",
        report_control=f"{name}CFG/LLN0.BR.BRep01",
        metering_data_set=f"{name}CFG/LLN0.DSet02",
    )


def two_motor_plant() -> Plant:
    """PUMP-A1 behind A1_SEL710 and FAN-A2 behind A2_SEL710, at FACTORY_A."""
    return Plant(
        sites=(Site("FACTORY_A", "Factory A"),),
        relays=(relay("A1_SEL710", "FACTORY_A"), relay("A2_SEL710", "FACTORY_A", 10211)),
        motors=(
            PlantMotor(motor("PUMP-A1"), "Feed pump", "FACTORY_A", "A1_SEL710"),
            PlantMotor(motor("FAN-A2"), "Fan", "FACTORY_A", "A2_SEL710"),
        ),
    )


def fault(mu_f: float = 0.051) -> Diagnosis:
    """Shorted turns in phase b."""
    return Diagnosis(
        verdict=Verdict.FAULT,
        mu_f=mu_f,
        mu_f_ci95=(mu_f - 0.004, mu_f + 0.004),
        mu_f_scatter95=(mu_f - 0.001, mu_f + 0.001),
        detection_limit=0.021,
        load_level_ci95=(0.46, 0.5),
        load_level_scatter95=(0.47, 0.49),
        theta_f=1,
        load_level=0.48,
        time_offset_s=0.0,
        residual_rms_A=0.01,
        evaluations=512,
        compute_seconds=0.03,
        quality=(QualityFinding("clipping", 0.0, 0.0, "1", passed=True, message="no channel is clipped"),),
        reasons=("shorted turns in phase b",),
        model="split-winding",
        method="hcpa",
    )


def healthy() -> Diagnosis:
    """No shorted turns."""
    return replace(fault(0.0), verdict=Verdict.HEALTHY, theta_f=None, reasons=("no shorted turns",))


def watch() -> Diagnosis:
    """An asymmetry that may be the sensors'."""
    return replace(fault(0.012), verdict=Verdict.WATCH, theta_f=None, reasons=("an asymmetry",))


def undiagnosable() -> Diagnosis:
    """What the quality gate refused: no figures."""
    return Diagnosis(
        verdict=Verdict.UNDIAGNOSABLE,
        mu_f=None,
        mu_f_ci95=None,
        theta_f=None,
        load_level=None,
        time_offset_s=None,
        residual_rms_A=None,
        evaluations=0,
        compute_seconds=0.0,
        quality=(),
        reasons=("clipped currents",),
        model="split-winding",
        method="hcpa",
    )
