#!/usr/bin/env python3
"""end_to_end.py STIFFSCOPE FOLDER OUT.json: whole commands at three sizes, as long as one waits for them (the clock; both
sides may use every core), the least of some runs, beside the scripts that do the same on the same campaign, run in turns with
them. Stops where their numbers are not ours."""
import json, os, pathlib, subprocess, sys, tempfile, time
import campaigns
from same_result import compared

# Least squares in both: only rounding is between them.
ESTIMATE = 1e-6
# Of a day of absolute readings: the script weighs the sweeps by directions of its start, ours by those of the solution, which
# all but Partial Pose's calibrated geometry takes over.
BY_SWEEPS, BY_CALIBRATION = 1e-4, 1e-6
# Of a standard uncertainty: both weigh by the tracker's noise, along directions that differ by the noise.
FRAMES = 0.5
# Ours weighs by the tracker's noise beside what the model leaves, the script's readings all weigh alike.
HELD_OUT = 0.01
binary, work, out = map(pathlib.Path, sys.argv[1:4])
IDENTIFY = campaigns.HERE / "by_pandas/identify.py"


def timed(*command):
    """Output, seconds and the peak of resident memory in MiB."""
    with tempfile.TemporaryFile("w+") as output, tempfile.TemporaryFile("w+") as errors:
        before = time.perf_counter()
        process = subprocess.Popen([str(word) for word in command], stdout=output, stderr=errors)
        _, status, usage = os.wait4(process.pid, 0)
        after = time.perf_counter()
        process.returncode = os.waitstatus_to_exitcode(status)
        for file in (output, errors):
            file.seek(0)
        if not 0 <= process.returncode <= 1 or (process.returncode and command[0] == sys.executable):
            sys.exit(f"{command}: {errors.read()}")
        return output.read(), after - before, usage.ru_maxrss / 1024


def in_turns(*commands):
    """The least seconds of each, of six rounds: a machine whose speed changes from minute to minute serves all alike."""
    rounds = [[timed(*command)[1] for command in commands] for _ in range(6)]
    return [min(times) for times in zip(*rounds)]


def peak(*command):
    """The least of some runs, in MiB: what a heap keeps for later depends on the threads' luck."""
    return min(timed(*command)[2] for _ in range(3))


def loaded(file):
    return json.loads(pathlib.Path(file).read_text())


def ordinary(folder, row):
    """Ours with uncertainties, outlying postures and subsets; the script stiffnesses and shares alone."""
    result, theirs = work / "identify.json", work / "by-script.json"
    command = (binary, "identify", folder, "--springs-only")
    ours, script = in_turns(command, (sys.executable, campaigns.HERE / "by_pandas/absolute.py", folder, theirs))
    timed(*command, "--json", result)
    row["ours"].append(ours)
    row["memory"].append(peak(*command))
    row["against"].setdefault("pandas, numpy and scipy, vectorised, values alone", []).append(script)
    a, b = loaded(result), loaded(theirs)
    for name, method in b["methods"].items():
        borne, own = BY_CALIBRATION if name == "pp" else BY_SWEEPS, a["methods"][name]
        pairs = list(zip(own["stiffness_nm_per_rad"], method["stiffness_nm_per_rad"]))
        pairs += [(own[ours_at]["all_postures"], method[at]) for ours_at, at in (("compensated_at_targets", "compensated_at_targets"),
                                                                             ("compensated", "compensated_at_wrist"))]
        for k, other in pairs:
            if (k is None) != (other is None) or (k is not None and not abs(other / k - 1.0) < borne):
                sys.exit(f"{folder}, {name}: {other}, ours {k}")


def alone(*command):
    """A command without anything beside it."""
    def measure(folder, row):
        whole = (binary, *(folder if word is None else word for word in command))
        _, seconds, memory = zip(*(timed(*whole) for _ in range(3)))
        row["ours"].append(min(seconds))
        row["memory"].append(min(memory))
    return measure


def identify(folder, row):
    """The command with --json, and the scripts that compute the same."""
    beside_identify(folder, row, "", "--json", work / "identify.json")


def printed(folder, row):
    """The command as it stands: numbers of the scripts are compared with what it writes with --json."""
    timed(binary, "identify", folder, "--json", work / "identify.json")
    beside_identify(folder, row, "printed-")


def beside_identify(folder, row, mode, *options):
    """Times of the command with these options and of the scripts, the plain one's of one run, and whether their numbers are
    those in identify.json."""
    theirs = {how: (sys.executable, IDENTIFY, mode + how, folder, work / f"by-script-{how}.json") for how in ("vectorised", "plain")}
    ours, vectorised = in_turns((binary, "identify", folder, *options), theirs["vectorised"])
    plain = timed(*theirs["plain"])[1]
    row["ours"].append(ours)
    for how, seconds in (("vectorised", vectorised), ("plain", plain)):
        row["against"].setdefault(f"pandas and numpy, {how}", []).append(seconds)
        comparison = compared(loaded(work / "identify.json"), loaded(work / f"by-script-{how}.json"))
        if comparison.wrong:
            sys.exit(f"{folder}, {mode}{how}: {len(comparison.wrong)} of {comparison.numbers} numbers are not ours:\n"
                     + "\n".join(comparison.wrong[:10]))
        print(f"{folder.name}, {mode}{how}: {comparison.numbers} numbers the same, {comparison.drawn} of them of own draws", flush=True)


def estimate_only(folder, row):
    """Ours gives all the rest too; the script the stiffnesses alone."""
    command = (binary, "identify", folder, "--method", "pp", "--neglect-kc")
    timed(*command, "--json", work / "estimate.json")
    reference = loaded(work / "estimate.json")["methods"]["pp"]["stiffness_nm_per_rad"]
    joints = "".join(str(j + 1) for j, k in enumerate(reference) if k is not None)
    theirs = {how: (sys.executable, IDENTIFY, f"estimate-{how}", folder, joints) for how in ("vectorised", "plain")}
    ours, vectorised = in_turns(command, theirs["vectorised"])
    plain = timed(*theirs["plain"])[1]
    row["ours"].append(ours)
    for how, seconds in (("vectorised", vectorised), ("plain", plain)):
        for k, word in zip(reference, timed(*theirs[how])[0].split()):
            if k is not None and not abs(float(word) / k - 1.0) < ESTIMATE:
                sys.exit(f"{folder}, {how}: {word}, ours {k}")
        row["against"].setdefault(f"stiffnesses alone, {how}", []).append(seconds)


def frames(folder, row):
    result, theirs = work / "frames.json", work / "by-script.json"
    ours, script = in_turns((binary, "frames", folder, "--json", result),
                            (sys.executable, campaigns.HERE / "frames_by_scipy.py", folder, theirs))
    row["ours"].append(ours)
    row["against"].setdefault("pandas and scipy", []).append(script)
    a, b = loaded(result), loaded(theirs)
    apart = [abs(circle["radius_mm"] - r) / sd for axis, other in zip(a["axes"], b["axes"])
             for circle, r, sd in zip(axis["circles"], other["radii_mm"], other["sd_radii_mm"])]
    apart += [abs(link["length_mm"] - length) / link["sd_length_mm"]
              for link, length in zip(a["links"], b["lengths_mm"]) if not link["near_parallel"]]
    apart += [abs(a["wrist"]["radii_mm"][name] - r) / a["wrist"]["sd_radii_mm"][name]
              for name, r in zip(a["wrist"]["radii_mm"], b["wrist"]["radii_mm"])]
    if not max(apart) < FRAMES:
        sys.exit(f"{folder}: radii or lengths {max(apart):.2g} standard uncertainties apart")


def calibrate(folder, row):
    """Ours with own weight, effects and outliers; the script the geometry alone, held out by the same halves."""
    result, theirs = work / "calibrate.json", work / "by-script.json"
    ours, script = in_turns((binary, "calibrate", folder, "--json", result),
                            (sys.executable, campaigns.HERE / "calibrate_by_scipy.py", folder, theirs))
    row["ours"].append(ours)
    row["against"].setdefault("pandas and scipy, geometry alone", []).append(script)
    geometry = next(model for model in loaded(result)["models"] if model["model"] == "geometry")
    for key, value in ((key, loaded(theirs)[key]) for key in ("fitted_mm", "held_out_mm")):
        if not abs(value / geometry[key] - 1.0) < HELD_OUT:
            sys.exit(f"{folder}: {key} {value}, ours {geometry[key]}")


def report(folder, row):
    row["ours"].append(timed(binary, "report", folder, "--out", work / "report")[1])


THREE = (100, 1000, 10000)
rows = []
for what, sizes, make, measure in (
        ("`identify --springs-only` of an ordinary day", THREE, campaigns.day, ordinary),
        ("`identify` of an ordinary day", THREE, campaigns.day, alone("identify", None)),
        ("`audit` of an ordinary day", THREE, campaigns.day, alone("audit", None)),
        ("`frames --springs-only` of an ordinary day", THREE, campaigns.day, alone("frames", None, "--springs-only")),
        ("`frames`", (20, 200, 2000), campaigns.sweeps, frames), ("`report`", (19, 190, 1900), campaigns.day, report),
        ("`calibrate`, beside a script of the geometry alone", (100, 1000, 10000), campaigns.unloaded, calibrate),
        ("the easy form, displacements: `identify --neglect-kc`, beside scripts of the stiffnesses alone", THREE, campaigns.differences,
         estimate_only),
        ("the easy form: `identify`", THREE, campaigns.differences, printed),
        ("the easy form: `identify --json`", THREE, campaigns.differences, identify)):
    row = {"what": what, "sizes": [str(size) for size in sizes], "ours": [], "memory": [], "against": {}}
    for size in sizes:
        measure(make(binary, work, size), row)
    rows.append(row)
out.write_text(json.dumps(rows))
