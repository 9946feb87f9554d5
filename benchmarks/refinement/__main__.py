"""Both loops beside scipy's: python -m benchmarks.refinement."""

from benchmarks.refinement import starts, steady_running

for subject in (steady_running, starts):
    print((subject.__doc__ or "").splitlines()[0])
    for line in subject.measure():
        print(f"  {line}", flush=True)
