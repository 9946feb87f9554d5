"""Read a motor's trend and measured values from a running service into pandas, pyarrow or plain Python.

python examples/read_exports.py http://127.0.0.1:8710 PUMP-A1 [TOKEN-FILE]
"""

import csv
import io
import sys
from datetime import datetime
from pathlib import Path

import httpx
from pyarrow import parquet


def main() -> None:
    url, motor, *token_file = sys.argv[1:]
    headers = {"Authorization": f"Bearer {Path(token_file[0]).read_text().strip()}"} if token_file else {}
    with httpx.Client(base_url=f"{url}/api/v1", headers=headers, timeout=600) as service:
        # CSV: one row a recording, for whatever reads lines.
        trend = service.get("/exports/trend", params={"motor": motor, "format": "csv"}).raise_for_status()
        rows = list(csv.DictReader(io.StringIO(trend.text, newline="")))
        for row in rows[-5:]:
            time = datetime.fromisoformat(row["time"])
            level = f"{float(row['mu_f']):8.3%}" if row["mu_f"] else "       -"
            print(f"{time:%Y-%m-%d %H:%M} UTC {row['verdict']:13} {level} {row['state']}")

        # Parquet: types, units and the zone of the times come with it. `table.to_pandas()` makes a frame.
        asked = {"motor": motor, "step": "0", "format": "parquet"}
        answer = service.get("/exports/measurements", params=asked).raise_for_status()
        # One thread is enough for a file of this size; a program that ends while others begin is aborted.
        table = parquet.ParquetFile(io.BytesIO(answer.content)).read(use_threads=False)
        currents = [value for value in table["ia_A"].to_pylist() if value is not None]
        unit = table.schema.field("ia_A").metadata[b"unit"].decode()
        mean = f"{sum(currents) / len(currents):.3g} {unit}" if currents else "not measured"
        print(f"{len(rows)} recordings, {table.num_rows} measurements, current of phase a: {mean}")


if __name__ == "__main__":
    main()
