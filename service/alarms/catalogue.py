"""What each kind of alarm means: how soon to act, cause, consequence, what to do, and when it is over.

docs/reference/alarms.md shows this table, and a test compares the two.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from core.condition.kinds import State
from core.motor_condition.efficiency import ADVICE as EFFICIENCY_ADVICE
from core.motor_condition.judging import AIR_GAP_ADVICE
from core.motor_condition.supply import ADVICE as SUPPLY_ADVICE
from core.rotor.advice import rotor_advice
from core.rotor.finding import RotorState
from core.starts.notable import HARD_STARTS_ADVICE
from service.alarms.kinds import AlarmKind, AlarmPriority


@dataclass(frozen=True, slots=True)
class AlarmDescription:
    """A kind of alarm in words, one sentence each.

    priority: how soon somebody has to act.  cause: what has happened.  consequence: what follows if nobody
    acts.  action: what to do.  over: when the cause is gone.
    """

    priority: AlarmPriority
    cause: str
    consequence: str
    action: str
    over: str


CATALOGUE: Final[Mapping[AlarmKind, AlarmDescription]] = {
    AlarmKind.CONDITION_FAULT: AlarmDescription(
        AlarmPriority.CRITICAL,
        "The motor's records show shorted turns, or what looks like them, above the motor's limit.",
        "Shorted turns run hot and take others with them, until the winding fails to earth.",
        "Do what the advice of the motor's condition says, within days.",
        "two records in a row are no fault any more (`healthy_records`); while the motor is still to be "
        "watched, `condition-watch` takes its place. Also when the motor's reference is restarted, and when "
        "it leaves the plant",
    ),
    AlarmKind.CONDITION_FORECAST: AlarmDescription(
        AlarmPriority.HIGH,
        "The fault level grows, and will likely reach the limit within the horizon (`forecast_days`).",
        "The motor becomes a fault before the next planned stop, if that is later.",
        "Plan the check of the winding before that time, and have the motor recorded more often until then.",
        "the forecast lies beyond one and a half times the horizon, the growth has stopped, or the motor has "
        "recovered; where the limit is reached, an alarm for the next limit may take its place",
    ),
    AlarmKind.CONDITION_WATCH: AlarmDescription(
        AlarmPriority.MEDIUM,
        "The motor's records show an asymmetry that is new, or larger than its sensors explain.",
        "It may be the beginning of a fault, or a channel behind which a fault is not seen.",
        "Do what the advice of the motor's condition says, at the next planned stop at the latest.",
        "two records in a row are healthy (`healthy_records`), `condition-fault` or another kind of "
        "asymmetry takes its place, the motor's reference is restarted, or the motor leaves the plant",
    ),
    AlarmKind.ROTOR_FAULT: AlarmDescription(
        AlarmPriority.HIGH,
        "Two of the latest three records that tell of the rotor show one as uneven as broken bars, a broken "
        "end ring, or a bad contact of a wound rotor make it.",
        "Broken bars overload their neighbours at each start, and pieces of them may damage the winding.",
        rotor_advice(RotorState.FAULT),
        "fewer than two of the latest three records show it; while the rotor is still to be watched, "
        "`rotor-watch` takes its place. Also when the motor leaves the plant",
    ),
    AlarmKind.ROTOR_WATCH: AlarmDescription(
        AlarmPriority.MEDIUM,
        "The motor's records show a rotor bar or end-ring defect, or one that has grown at the same load.",
        "It may be the beginning of broken bars, which grow from start to start.",
        rotor_advice(RotorState.WATCH),
        "two of the latest three records show an even rotor, and none a fault; `rotor-fault` takes its "
        "place; or the motor leaves the plant",
    ),
    AlarmKind.SUPPLY_FAULT: AlarmDescription(
        AlarmPriority.HIGH,
        "Two of the latest three records show a voltage that is unbalanced by more than 5 % (NEMA MG-1), or "
        "15 % from the rated one: the motor should not run so.",
        "An unbalanced voltage draws a current of the other sequence that is several times as large, and "
        "heats rotor and winding beyond what they are made for.",
        SUPPLY_ADVICE[State.FAULT],
        "fewer than two of the latest three records show it; while the supply is still beyond a limit, "
        "`supply-watch` takes its place. Also when the motor leaves the plant",
    ),
    AlarmKind.SUPPLY_WATCH: AlarmDescription(
        AlarmPriority.MEDIUM,
        "Two of the latest three records show a supply beyond a limit: voltage 10 %, unbalance 2 %, "
        "frequency -5 to +3 %, harmonic voltage factor 0.03 (NEMA MG-1, IEC 60034-1).",
        "The motor runs hotter than its plate allows at the same load, and its winding ages faster.",
        SUPPLY_ADVICE[State.WATCH],
        "fewer than two of the latest three records show it, `supply-fault` takes its place, or the motor "
        "leaves the plant",
    ),
    AlarmKind.UNEVEN_AIR_GAP: AlarmDescription(
        AlarmPriority.MEDIUM,
        "The motor's latest records show an air gap that is more uneven than makers allow, and nothing else "
        "explains them.",
        "The rotor is pulled to one side; bearings wear faster, and it may touch the stator one day.",
        AIR_GAP_ADVICE,
        "the latest records do not show it, or something else explains them, or the motor leaves the plant",
    ),
    AlarmKind.INEFFICIENT: AlarmDescription(
        AlarmPriority.LOW,
        "Most of the motor's latest records have less than 40 % of its rated load, or its supply adds a "
        "tenth or more to its losses in two of the latest three.",
        "Energy is paid for that does no work; what adds losses also heats the winding.",
        EFFICIENCY_ADVICE,
        "the latest records do not show it any more, or the motor leaves the plant",
    ),
    AlarmKind.PARAMETER_DRIFT: AlarmDescription(
        AlarmPriority.MEDIUM,
        "Resistances or inductances of the motor, followed over its records, are others than in the first "
        "ones, with load and voltage taken out.",
        "A winding that is too hot ages fast, a rotor that gets worse damages more, and with a wrong ratio "
        "relay and service judge wrong figures.",
        "Do what the advice of the alarm says, at the next planned stop at the latest.",
        "three records in a row show less than half of what is told, the motor's reference is restarted, or "
        "the motor leaves the plant",
    ),
    AlarmKind.HARD_STARTS: AlarmDescription(
        AlarmPriority.HIGH,
        "One of the latest three starts came sooner than the motor file's `starts_per_hour` allows, or "
        "brought the rotor 90 % or more of the heat that it withstands.",
        "Starts heat the rotor most: one more before it has cooled may break bars or melt a cage, and the "
        "winding ages fast.",
        HARD_STARTS_ADVICE,
        "none of the latest three starts shows it, or the motor leaves the plant",
    ),
    AlarmKind.CHANGED_STARTS: AlarmDescription(
        AlarmPriority.MEDIUM,
        "The latest starts, taken together, are other than the first ones: the load, the supply or the rotor "
        "has changed, or they take longer and it is not told why.",
        "What takes longer to start heats more each time; a load that sticks, a weak supply or a worse rotor "
        "may stall the motor one day.",
        "Do what the advice of the alarm says, at the next planned stop at the latest.",
        "the latest three starts are as the first ones again, the reference begins anew (motor rewound, "
        "recorder changed, reference restarted), or the motor leaves the plant",
    ),
    AlarmKind.MOTOR_TRIPPED: AlarmDescription(
        AlarmPriority.HIGH,
        "The relay's protection tripped the motor, as its GOOSE messages say (`[gateways.goose]`).",
        "What drives the process stands, and a start onto a fault makes the damage worse.",
        "Read at the relay which element tripped, look at the record of the trip and at the motor's "
        "condition, and start the motor only when the cause is known.",
        "the relay tells that its trip has fallen, or the motor leaves the plant",
    ),
    AlarmKind.MISSING_DATA: AlarmDescription(
        AlarmPriority.MEDIUM,
        "The motor has no valid record for longer than its schedule promises, and was not seen to stand.",
        "Its condition ages, and a fault that begins now is not seen.",
        "Look in `mcc recordings` why records are refused or missing, and have the motor recorded by hand.",
        "there is a valid record again, or the motor is seen to stand",
    ),
    AlarmKind.LINK_DOWN: AlarmDescription(
        AlarmPriority.MEDIUM,
        "The relay has not answered for long (`link_down_s`).",
        "No record of its motors is fetched, and a relay with little memory loses the oldest ones.",
        "Check the relay's supply, network, address and certificates; `mcc relay` tells what the connection "
        "fails with.",
        "the relay has answered for a minute without a break (`link_up_s`)",
    ),
    AlarmKind.SITE_LOST: AlarmDescription(
        AlarmPriority.HIGH,
        "Most relays of a site stopped answering within a minute of each other.",
        "No motor of the site is watched by the service.",
        "Look for the common cause: the network between the service and the site, a switch, a firewall, the "
        "supply of the relays.",
        "most of them answer again; alarms of those that do not are then told one by one",
    ),
    AlarmKind.ALARM_FLOOD: AlarmDescription(
        AlarmPriority.MEDIUM,
        "More alarms of one priority were raised within a minute than a person can read (`flood_alarms`).",
        "They are set aside behind this line, so that nobody has to read each of them.",
        "Look for what they have in common; `mcc alarms --part-of ALARM` lists them.",
        "so few of them stand that they can be read: these are then told one by one",
    ),
    AlarmKind.CLOCK_OFF: AlarmDescription(
        AlarmPriority.LOW,
        "The relay's clock differs from the service's by more than `clock_off_s`.",
        "Its records are put into a wrong order with those of other relays and with notes, and comparisons "
        "within a bus fail.",
        "Have the relay's clock synchronised (SNTP, IRIG-B), and check the clock of the service's machine if "
        "many relays differ.",
        "a comparison finds it within half of that",
    ),
    AlarmKind.TIME_ZONE: AlarmDescription(
        AlarmPriority.LOW,
        "Two records in a row that the service triggered, or the first one, are whole hours, or quarters of "
        "them, off their trigger: the relay's clock runs in another time zone than the motors file says.",
        "Its records have wrong times, and the motor's trend a wrong order where the zone changes.",
        "Set `time_zone` in the relay's table of the motors file, as the reason says.",
        "the first diagnosis of a triggered record finds its time right",
    ),
    AlarmKind.QUARANTINED: AlarmDescription(
        AlarmPriority.MEDIUM,
        "The relay's answers crashed a gateway, or broke the protocol five times in a row.",
        "It is not visited until the time that its link state tells, so its motors make no new records.",
        "Update the relay's firmware or have its network checked, then `mcc release RELAY`.",
        "it has worked for as long as it was set aside, or is released",
    ),
    AlarmKind.RELAY_DIFFERS: AlarmDescription(
        AlarmPriority.LOW,
        "The relay has something that is used otherwise than its SCL promises, or not at all: `trigger`, "
        "`record-made`, `reports` or `metering`.",
        "The service does without it: records come later, or cannot be asked for.",
        "Correct the relay's settings or its SCL file, as the reason says.",
        "a connection finds it as promised",
    ),
    AlarmKind.FILE_REFUSED: AlarmDescription(
        AlarmPriority.LOW,
        "A file's name cannot be trusted: outside the directory, control characters, too long, twice.",
        "The file is not fetched, and a record that it belongs to is missing.",
        "Look at the files on the relay, and find out what made it.",
        "the relay does not list it any more",
    ),
    AlarmKind.FILE_TOO_LARGE: AlarmDescription(
        AlarmPriority.LOW,
        "A record has a file above `max_file_bytes`.",
        "Its recording is rejected, and tells nothing of the motor.",
        "Make the relay's records shorter, or raise `max_file_bytes`.",
        "the relay does not list it any more",
    ),
    AlarmKind.FILE_UNSTEADY: AlarmDescription(
        AlarmPriority.LOW,
        "The relay does not list its files, or a record changes all the time, is never as long as listed, or "
        "was not to be had in five attempts.",
        "The record is missing until it can be fetched; it is asked for again.",
        "Restart the relay's file service or the relay; delete the record there if it stays unreadable.",
        "it is fetched, or not listed any more",
    ),
    AlarmKind.DAILY_LIMIT: AlarmDescription(
        AlarmPriority.LOW,
        "The relay sent `max_relay_bytes_per_day` today (UTC).",
        "New records wait in the relay, which may discard its oldest meanwhile.",
        "Find out what triggers so many records, or raise `max_relay_bytes_per_day`.",
        "the next record is fetched",
    ),
    AlarmKind.DISK_FILLING: AlarmDescription(
        AlarmPriority.HIGH,
        "A disk of the service has little room left (`disk_free_share`), or will be full within days "
        "(`disk_full_days`).",
        "With a full disk no record is stored, and the database stops.",
        "Make room: shorten `[retention]` (`mcc retention --dry-run` tells what goes), or enlarge the disk.",
        "there is a fifth more room than that, and it fills slower",
    ),
    AlarmKind.CERTIFICATE_END: AlarmDescription(
        AlarmPriority.MEDIUM,
        "A certificate ends within `certificate_days`, has ended, or cannot be read.",
        "When it has ended, connections that need it fail: to the relay, or of people to the service.",
        "Make a new certificate and put it in place, as the page on security says.",
        "the file has a certificate that lasts longer",
    ),
    AlarmKind.BACKUP_OVERDUE: AlarmDescription(
        AlarmPriority.MEDIUM,
        "No back-up was made and verified for longer than `[backup]` allows (`overdue_days`).",
        "What came since the latest one is lost with the disk.",
        "Look in `mcc backup --list` why back-ups fail, and make one: `mcc backup`.",
        "a back-up is verified",
    ),
    AlarmKind.PASSWORD_GUESSING: AlarmDescription(
        AlarmPriority.HIGH,
        "So many logins failed within an hour that the service took a pause, or more than 20 in all.",
        "Somebody may find a password, and do what its owner may do.",
        "Look at the addresses in the reason and in the audit trail (`login-failed`), and keep them from the "
        "service's network; where a person mistyped, `mcc user unlock NAME` ends the pause.",
        "no login was locked for an hour, and no more than 20 failed",
    ),
    AlarmKind.FORGED_TOKENS: AlarmDescription(
        AlarmPriority.HIGH,
        "More than 10 requests within an hour showed tokens that are unknown, revoked or expired.",
        "Somebody may be trying tokens; or a program's token has ended, and it reads nothing any more.",
        "Look at the addresses in the reason and in the audit trail (`token-refused`): give the program "
        "there another token, or keep the address from the service's network.",
        "no more than 10 came within an hour",
    ),
    AlarmKind.OWNER_LOCKED: AlarmDescription(
        AlarmPriority.HIGH,
        "So many logins of a user with the role SECADM failed that none is tried for a while.",
        "Somebody may be guessing the password that gives the most rights, or keeps its owner out.",
        "Ask the owner whether it was them; if not, look at the addresses in the audit trail "
        "(`login-locked`), and end the pause with `mcc user unlock NAME --config FILE`.",
        "none was locked for an hour",
    ),
}
"""In the order in which the page shows them: what is about motors, links, relays, the service itself."""


def description(kind: AlarmKind) -> AlarmDescription:
    """Return what a kind of alarm means."""
    return CATALOGUE[kind]
