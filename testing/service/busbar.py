"""The demo plant's SCD with the topology of a busbar."""

from pathlib import Path

import scl

BUSBAR = "FACTORY_A/LV/W1/BB"


def scd_with_a_busbar(folder: Path) -> Path:
    """The demo plant's SCD with a busbar of which the first two motors are fed through a breaker."""
    text = scl.DEMO_PLANT_SCD.read_text(encoding="utf-8")
    busbar = f'<Bay name="W1"><ConnectivityNode name="BB" pathName="{BUSBAR}"/></Bay>'
    for bay in ("A1", "A2"):
        node = f"FACTORY_A/LV/{bay}/N1"
        start = text.index(f'<Bay name="{bay}"')
        end = text.index("</Bay>", start)
        breaker = "".join(
            f'<Terminal connectivityNode="{one}" cNodeName="{one.rpartition("/")[2]}"/>'
            for one in (BUSBAR, node)
        )
        inner = text[start:end].replace(
            "</ConductingEquipment>",
            f'<Terminal connectivityNode="{node}" cNodeName="N1"/></ConductingEquipment>'
            f'<ConductingEquipment name="Q0" type="CBR">{breaker}</ConductingEquipment>',
        )
        text = f'{text[:start]}{inner}<ConnectivityNode name="N1" pathName="{node}"/>{text[end:]}'
    text = text.replace('<Bay name="A1"', f'{busbar}<Bay name="A1"')
    path = folder / "plant.scd"
    path.write_text(text, encoding="utf-8")
    return path
