"""Read the trend of a motor from a running service into a pandas table.

pip install ./client pandas
python examples/trend_to_pandas.py http://127.0.0.1:8710 PUMP-A1 [TOKEN-FILE]
"""

import sys
from pathlib import Path

import pandas as pd

from statorwatch_client import Client


def main() -> None:
    url, motor, *token_file = sys.argv[1:]
    token = Path(token_file[0]).read_text().strip() if token_file else None
    with Client(url, token=token) as service:
        trend = pd.DataFrame(service.get_trend(motor, quantity="mu_f", limit=1000))
    if trend.empty:
        print(f"{motor}: no recordings yet")
        return
    trend["time"] = pd.to_datetime(trend["time"], format="ISO8601")
    trend = trend.set_index("time")
    trend["level_percent"] = 100 * trend["value"].astype(float)
    print(trend[["level_percent", "verdict"]].tail(5).round(3).to_string())
    print(f"median of a day: {trend['level_percent'].resample('1D').median().iloc[-1]:.3f} %")


if __name__ == "__main__":
    main()
