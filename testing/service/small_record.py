"""A small COMTRADE record (1999, ASCII): two currents, eight samples at 1 kHz, trigger at the third."""

CFG = """FACTORY A,A1_SEL710,1999
2,2A,0D
1,IA,A,,A,0.01,0,0,-9999,9999,1,1,P
2,IB,B,,A,0.01,0,0,-9999,9999,1,1,P
50
1
1000,8
21/11/2026,06:00:00.000000
21/11/2026,06:00:00.002000
ASCII
1
""".replace("\n", "\r\n").encode("ascii")
IA = [0, 100, 200, 900, 200, 100, 0, -100]
DAT = "".join(f"{i + 1},{i * 1000},{ia},{-ia}\r\n" for i, ia in enumerate(IA)).encode("ascii")
