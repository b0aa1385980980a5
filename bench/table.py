#!/usr/bin/env python3
"""table.py FOLDER: one Markdown table of what the benchmarks wrote there, printed and as table.md: a row a benchmark, ours at
each size, its growth from size to size, and what a user would otherwise take on the same data in the same run. Processor
time, of whole commands the clock's, the least of the runs."""
import json, pathlib, sys

UNITS = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0}
# Benchmark, its words, what its sizes are, beside it: another benchmark or the file of a script.
ROWS = (
    ("ReadPostures", "reading, a day of loading", "postures, 45 readings each", {}),
    ("ReadWristSweep", "reading, one long table", "rows", {"VTK's reader": "ReadWristSweepByVtk"}),
    ("Circle", "circle", "points", {"numpy and scipy": "fits"}),
    ("TenThousandCirclesOf20Points", "10,000 circles of 20 points", "", {"numpy, all at once": "fits"}),
    ("Sphere", "sphere", "points", {"numpy and scipy": "fits", "Kasa by Eigen, no uncertainty": "KasaSphereByEigen"}),
    ("Plane", "plane", "points", {"Eigen, no uncertainty": "PlaneByEigen"}),
    ("Cylinder", "cylinder", "points", {}),
    ("Frames", "frames, own weight settled", "postures", {}),
    ("CompletePose", "Complete Pose", "postures", {}),
    ("Calibration", "Partial Pose, calibration", "postures", {}),
    ("PartialPose", "Partial Pose", "postures", {}),
    ("DecoupledPartialPose", "Decoupled Partial Pose", "postures", {}),
    ("ThreeMethods", "three methods, calibration and frames", "postures", {}),
    ("AllSubsets", "all subsets of half", "postures", {"numpy, all at once": "subsets"}),
    ("Jacobian", "Jacobians", "postures", {"KDL": "JacobianByKdl"}),
    ("Diagnosis", "diagnosis", "postures", {}),
    ("Chart", "chart as PNG", "postures of four bars", {"matplotlib": "chart"}),
)
# Commands' sizes, by how their row begins.
COMMANDS = {"`frames`": "readings a circle, 50 times as many of the wrist", "the easy form": "postures of 14 loads"}


def spoken(seconds):
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("us", 1e-6)):
        if seconds >= size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds / 1e-9:.3g} ns"


def measured(folder):
    """Seconds and MB/s by benchmark and size."""
    seconds, rates = {}, {}
    for file in folder.glob("*_bench.json"):
        text = file.read_text()  # nothing where a filter left no benchmark
        for run in json.loads(text)["benchmarks"] if text else ():
            if run.get("error_occurred"):
                sys.exit(f"{run['name']}: {run['error_message']}")
            if run["run_type"] != "iteration":
                continue
            parts = run["name"].split("/")
            size = next((part for part in parts[1:] if part.isdigit()), "")
            of = seconds.setdefault(parts[0], {})
            of[size] = min(of.get(size, float("inf")), run["cpu_time"] * UNITS[run["time_unit"]])
            if "MB/s" in run:
                rates.setdefault(parts[0], {})[size] = max(rates.get(parts[0], {}).get(size, 0.0), run["MB/s"])
    return seconds, rates


def growth(times):
    return ", ".join(f"{b / a:.1f}" for a, b in zip(times, times[1:]))


def line(what, sizes, ours, against, rates=(), memory=()):
    times = ", ".join(spoken(t) for t in ours)
    if memory:
        times += f" ({', '.join(f'{peak:.0f}' for peak in memory)} MiB)"
    if rates:
        times += f" ({', '.join(f'{rate:.0f}' for rate in rates)} MB/s)"
    beside = list(against.items()) or [("", [])]
    for k, (name, theirs) in enumerate(beside):
        own = [what, sizes, times, growth(ours)] if k == 0 else ["", "", "", ""]
        ratios = ", ".join(f"{b / a:.2g}" if b / a < 10 else f"{b / a:.0f}" for a, b in zip(ours, theirs))
        yield "| " + " | ".join([*own, name, ", ".join(spoken(t) for t in theirs), growth(theirs), ratios]) + " |"


def lines(folder):
    seconds, rates = measured(folder)
    beside = {file.stem: json.loads(file.read_text()) for file in (folder / "beside").glob("*.json")}
    for name, what, unit, against in ROWS:
        if name not in seconds:
            continue
        sizes = sorted(seconds[name], key=lambda size: int(size or 0))
        others = {}
        for words, source in against.items():
            times = beside[source].get(name) if source in beside else seconds.get(source)
            if times and all(size in times for size in sizes):
                others[words] = [times[size] for size in sizes]
        yield from line(what, f"{', '.join(f'{int(s):,}' for s in sizes if s)} {unit}".strip(), [seconds[name][s] for s in sizes], others,
                        [rates[name][s] for s in sizes] if name in rates else ())
    file = folder / "end_to_end.json"
    for row in json.loads(file.read_text()) if file.exists() else ():
        unit = next((unit for begin, unit in COMMANDS.items() if row["what"].startswith(begin)), "postures")
        yield from line(row["what"], f"{', '.join(f'{int(s):,}' for s in row['sizes'])} {unit}", row["ours"], row["against"],
                        memory=row["memory"])


folder = pathlib.Path(sys.argv[1])
table = "\n".join(["| what | sizes | stiffscope | growth | beside it | its time | its growth | times ours |", "|" + "---|" * 8,
                   *lines(folder)])
(folder / "table.md").write_text(table + "\n")
print("\n" + table + f"\n\nProcessor time, of whole commands (`...`) the clock's, the least of the runs; as {folder / 'table.md'}.")
