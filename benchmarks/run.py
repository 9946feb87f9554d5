"""Side-by-side measurements, ratios in one run: python -m benchmarks.run (make bench)."""

from benchmarks import diagnosis, machine_models, many_points, pull_speed, recordings, simulated_plant
from mms.binding.stderr_filter import keep_tls_notes_off_stderr

SUBJECTS = (machine_models, diagnosis, many_points, recordings, simulated_plant, pull_speed)


def main() -> None:
    keep_tls_notes_off_stderr()
    for subject in SUBJECTS:
        print(f"\n{(subject.__doc__ or '').splitlines()[0]}")
        for line in subject.measure():
            print(f"  {line}", flush=True)


if __name__ == "__main__":
    main()
