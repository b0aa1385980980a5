#!/usr/bin/env python3
"""growth_table.py RESULTS.json...: Google Benchmark's results as one Markdown table: a row a benchmark, processor time at
each size, and how much it grew from one size to the next."""
import json, sys

UNITS = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0}


def spoken(seconds):
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("us", 1e-6)):
        if seconds >= size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds / 1e-9:.3g} ns"


rows = {}
for file in sys.argv[1:]:
    for run in json.load(open(file))["benchmarks"]:
        if run.get("error_occurred"):
            sys.exit(f"{run['name']}: {run['error_message']}")
        parts = run["name"].split("/")
        size = next((part for part in parts[1:] if part.isdigit()), "")
        rate = f" ({run['MB/s']:.0f} MB/s)" if "MB/s" in run else ""
        rows.setdefault(parts[0], []).append((size, run["cpu_time"] * UNITS[run["time_unit"]], rate))
print("\n| benchmark | sizes | processor time | growth |\n|---|---|---|---|")
for name, runs in rows.items():
    growth = ", ".join(f"{b[1] / a[1]:.1f}" for a, b in zip(runs, runs[1:]))
    print(f"| {name} | {', '.join(r[0] for r in runs)} | {', '.join(spoken(r[1]) + r[2] for r in runs)} | {growth} |")
