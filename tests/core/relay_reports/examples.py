"""Reports in the layout of the simulated relay, and variants that relays of the family are said to have."""

from core.recordings.cev.compressed_ascii import closed

HEAD = """\
PUMP 7 SEL710                         Date: 03/29/2026  Time: 10:15:30.125
FID=SEL-710-SIM-R100-V0-Z001001-D20250101

"""

SER = (
    HEAD
    + """\
SEQUENTIAL EVENTS RECORDER

#     DATE       TIME          ELEMENT     STATE
1     03/29/2026 10:15:02.500  RUNNING     Asserted
2     03/29/2026 10:15:02.500  STARTING    Deasserted
3     03/29/2026 10:15:01.250  STARTING    Asserted
4     03/28/2026 23:59:59.999  Relay Powered Up
"""
)

LDP = (
    HEAD
    + """\
LOAD PROFILE

DATE       TIME                IA_MAG      IB_MAG           P
03/29/2026 10:14:00.000         1.203       1.198       436.2
03/29/2026 10:15:00.000         1.305       1.301       512.9
"""
)

MOT = (
    HEAD
    + """\
MOTOR OPERATING STATISTICS

Since                      03/01/2026 00:00:00.000
Running time               120:05:30 (h:mm:ss)
Stopped time               3:00:00 (h:mm:ss)
Time running               97.6 %
Number of starts           17
Average running current    1.21 A
Peak running current       1.74 A
Peak start current         8.90 A
Longest start              0.42 s
Trips, overcurrent         1
Trips, thermal overload    0
"""
)

MSR = (
    HEAD
    + """\
MOTOR START REPORT

Date of start          03/29/2026 10:15:01.250
Start time             0.30 s
Maximum start current  8.62 A
Minimum start voltage  371.5 V

   TIME(s)     I(A)   I(%FLA)     V(V)
      0.10     8.62     495.4    371.5
      0.20     7.10     408.0    372.0
      0.30     1.31      75.3    380.2

Date of start          03/28/2026 08:00:00.000
Start time             did not end
Maximum start current  9.01 A
Minimum start voltage  360.0 V

   TIME(s)     I(A)   I(%FLA)     V(V)
      0.10     9.01     517.8    360.0
"""
)

MSR_BY_PHASE = """\
=>>MSR 1
Date of Motor Start, 03/29/26 10:15:01.250
Motor Start Time, 0.3
CYCLE,IA(A),IB(A),IC(A),IN(A),%TCU,VAB(V),VBC(V),VCA(V)
5,8.5,8.6,8.7,0.0,10,371,372,373
10,7.0,7.1,7.2,0.0,14,372,372,372
=>>
"""


def compressed(labels: str, *rows: str) -> bytes:
    """A Compressed ASCII report with right checksums."""
    head = closed('"FID"') + closed('"FID=SEL-710-SIM"')
    return head + closed(labels) + b"".join(closed(row) for row in rows)


CSER = compressed(
    '"REC_NUM","MONTH","DAY","YEAR","HOUR","MIN","SEC","MSEC","ELEMENT","STATE"',
    '1,3,29,2026,10,15,2,500,"RUNNING","Asserted"',
    '2,3,29,2026,10,15,1,250,"STARTING","Asserted"',
)

CLDP = compressed(
    '"MONTH","DAY","YEAR","HOUR","MIN","SEC","MSEC","IA_MAG","P"',
    "3,29,2026,10,14,0,0,1.203,436.2",
    "3,29,2026,10,15,0,0,1.305,512.9",
)
