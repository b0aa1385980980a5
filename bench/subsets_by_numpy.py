#!/usr/bin/env python3
"""subsets_by_numpy.py DATA OUT.json: all subsets of half the postures of the equations that identify_bench wrote to DATA, all
at once: itertools' combinations, sums of normal equations, one batch of solutions. Stops where the mean is not ours."""
import itertools, json, math, pathlib, sys
from timing import least_seconds
import numpy as np


def solve_all(rows):
    n = len(rows)
    matrix, right = rows[:, :, :6], rows[:, :, 6:]
    back = np.swapaxes(matrix, 1, 2)
    normal = np.concatenate([back @ matrix, back @ right], 2).reshape(n, -1)
    count = math.comb(n, n // 2)
    chosen = np.fromiter(itertools.chain.from_iterable(itertools.combinations(range(n), n // 2)), int).reshape(count, -1)
    used = np.zeros((count, n))
    np.put_along_axis(used, chosen, 1.0, axis=1)
    sums = (used @ normal).reshape(count, 6, 7)
    return np.linalg.solve(sums[:, :, :6], sums[:, :, 6:])[..., 0]


data, out = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
times = {}
for n in (10, 14, 18):
    rows = np.fromfile(data / f"AllSubsets_{n}.equations").reshape(n, 9, 7)
    # Numbers of size one, conditions below a thousand: a million roundings.
    if not np.allclose(solve_all(rows).mean(axis=0), np.fromfile(data / f"AllSubsets_{n}.mean"), rtol=1e-9, atol=1e-10):
        sys.exit(f"subsets of {n}: not our mean")
    times[str(n)] = least_seconds(lambda: solve_all(rows))
out.write_text(json.dumps({"AllSubsets": times}))
