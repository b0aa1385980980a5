#!/usr/bin/env python3
"""end_to_end.py STIFFSCOPE FOLDER: whole commands at 100, 1,000 and 10,000 postures of 14 loads (10,000: 32 MB), processor time
of the process (the children's rusage), beside the scripts of identify_by_pandas.py. Stops where a script's stiffnesses and
ours are not the same to 1e-6: both solve the same least squares, so only rounding is between them."""
import json, pathlib, resource, subprocess, sys

TOLERANCE = 1e-6
HERE = pathlib.Path(__file__).parent
binary, work = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
SIZES = (100, 1000, 10000)


def timed(*command):
    """Output and processor seconds."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode > 1:
        sys.exit(f"{command}: {done.stderr}")
    return done.stdout, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def campaign(postures):
    folder = work / f"differences{postures}"
    if folder.exists():
        return folder
    work.mkdir(parents=True, exist_ok=True)
    spec = (HERE.parent / "samples/active.xml").read_text()
    masses = " ".join(f"{10.9 * i:.1f}" for i in range(1, 15))
    for old, new in (('count="19" candidates="20"', f'count="{postures}" candidates="1"'),
                     ('masses_kg="51 102 153"', f'masses_kg="{masses}"'), ('repeats="3"', 'repeats="1"'),
                     ('return_to_zero="true"', 'return_to_zero="false"'), ('rpy_deg="0.3 -0.2 152"', 'rpy_deg="0 0 0"'),
                     ('urdf="', f'urdf="{(HERE.parent / "samples").resolve()}/')):
        assert old in spec, old
        spec = spec.replace(old, new, 1)
    file = work / f"spec{postures}.xml"
    file.write_text(spec)
    timed(binary, "simulate", file, "--out", work / f"day{postures}")
    timed(sys.executable, HERE / "make_displacements.py", work / f"day{postures}", folder)
    return folder


def ours(folder):
    output, seconds = timed(binary, "identify", folder, "--method", "pp", "--neglect-kc", "--json", "-")
    found = json.loads(output)["methods"]["pp"]
    return found["stiffness_nm_per_rad"], seconds


def by_script(how, folder, reference):
    joints = "".join(str(j + 1) for j, k in enumerate(reference) if k is not None)
    output, seconds = timed(sys.executable, HERE / "identify_by_pandas.py", how, folder, joints)
    for j, (k, word) in enumerate(zip(reference, output.split())):
        if k is not None and abs(float(word) / k - 1.0) > TOLERANCE:
            sys.exit(f"{how}: k{j + 1} is {word}, ours {k}")
    return seconds


rows = {"stiffscope identify": [], "pandas and numpy, vectorised": [], "pandas and numpy, plain": []}
for size in SIZES:
    folder = campaign(size)
    stiffness, seconds = ours(folder)
    pairs = [(seconds, by_script("vectorised", folder, stiffness))]
    for _ in range(2):
        pairs.append((ours(folder)[1], by_script("vectorised", folder, stiffness)))
    rows["stiffscope identify"].append(sorted(p[0] for p in pairs)[1])
    rows["pandas and numpy, vectorised"].append(sorted(p[1] for p in pairs)[1])
    rows["pandas and numpy, plain"].append(by_script("plain", folder, stiffness))
print(f"\nProcessor time, median of three (plain: one); all stiffnesses the same to {TOLERANCE:g}. Ours also gives uncertainties,\n"
      "subsets, load steps and outliers, and checks its input; the scripts only the estimate.\n")
print("| end to end | " + " | ".join(f"{size} postures" for size in SIZES) + " | growth |\n|---|---|---|---|---|")
for name, times in rows.items():
    growth = ", ".join(f"{b / a:.1f}" for a, b in zip(times, times[1:]))
    print(f"| {name} | " + " | ".join(f"{t:.2f} s" for t in times) + f" | {growth} |")
