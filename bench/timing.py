"""Processor time of a call in this process: the least of some repeats, as many as fit a second, two at least."""
import os, time

# One thread, as ours has in what is compared; set before numpy is imported.
for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[name] = "1"


def least_seconds(call):
    times = []
    while len(times) < 2 or (sum(times) < 1.0 and len(times) < 1000):
        start = time.process_time()
        call()
        times.append(time.process_time() - start)
    return min(times)
