"""Side-by-side measurements, ratios in one run: python -m benchmarks (make bench)."""

from benchmarks.collector import pull_speed
from benchmarks.diagnosis import speed as diagnosis
from benchmarks.machine_models import speed as machine_models
from benchmarks.optimisers import many_points
from benchmarks.recordings import reading_speed
from benchmarks.simulator import plant
from mms import filter_tls_log_from_stderr

SUBJECTS = (machine_models, diagnosis, many_points, reading_speed, plant, pull_speed)


def main() -> None:
    filter_tls_log_from_stderr()
    for subject in SUBJECTS:
        print(f"\n{(subject.__doc__ or '').splitlines()[0]}")
        for line in subject.measure():
            print(f"  {line}", flush=True)


if __name__ == "__main__":
    main()
