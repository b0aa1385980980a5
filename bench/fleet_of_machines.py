#!/usr/bin/env python3
"""A fleet of simulated machines over several dates, and how `stiffscope fleet` finds what changed in it.

make FOLDER: machines of samples/active.xml's kind (stiffness, bearings, geometry and postures of their own), each measured
at every date on a small day: 12 postures, two loads, the tracker set up anew. Some machines lose 5 % of one joint's
stiffness at a date, others get a loose base; truth.csv, beside FOLDER and not in it, says which and when.
With --unloaded days without a load (samples/unloaded.xml's, 60 postures, an uneven gear at every machine's joints 2 and 3)
of machines that lose 5 to 10 % of one of --joints, which own weight turns; none gets a loose base.
score FOLDER OUT: holds OUT/steps.csv and OUT/needs.csv of the run against that truth.
"""
import argparse, concurrent.futures, csv, math, pathlib, random, re, subprocess

HERE = pathlib.Path(__file__).resolve().parent
SAMPLE = HERE.parent / "samples" / "active.xml"
UNLOADED = SAMPLE.with_name("unloaded.xml")
STIFFNESS = [7.0e6, 5.6e6, 6.3e6, 0.46e6, 0.35e6, 0.079e6]
BEARING = [5e7, 1.6e7, 1e7, 2e6, 6e5, 3e5]


def draw(draws, machines, dates, softened, loose, joints):
    """Each machine: its own numbers, and what happens to it from which date on."""
    kinds = ["softened"] * softened + ["loose_base"] * loose + [""] * (machines - softened - loose)
    draws.shuffle(kinds)
    for number, kind in enumerate(kinds):
        yield {"machine": f"M{number + 1:03}", "kind": kind, "joint": draws.choice(joints) if kind == "softened" else 0,
               "from": draws.randint(2, dates - 2) if kind else dates, "seed": draws.getrandbits(40),
               "stiffness": [k * math.exp(draws.gauss(0.0, 0.1)) for k in STIFFNESS],
               "bearing": [k * math.exp(draws.gauss(0.0, 0.1)) for k in BEARING],
               "base": 1e7 * 3.0 ** draws.random()}


def unloaded_spec_of(one, date, draws):
    changed = date >= one["from"]
    text = UNLOADED.read_text().replace('urdf="', f'urdf="{UNLOADED.parent}/')
    gears = random.Random(one["seed"])
    def waves(joint):
        if joint not in (2, 3):
            return ""
        return (f'<angle_error amplitude_deg="{gears.uniform(0.001, 0.004):.6f}" cycles="{gears.choice([1, 2, 17.25]):g}" '
                f'phase_deg="{gears.uniform(0, 360):.0f}"/>')
    text = re.sub(r"<joints.*?</joints>", "<joints>" + "".join(
        f'<joint index="{j + 1}" stiffness_nm_per_rad="{k * (1.0 - one["lost"] if changed and one["joint"] == j + 1 else 1.0):.9g}">'
        f'{waves(j + 1)}</joint>' for j, k in enumerate(one["stiffness"])) + "</joints>", text, flags=re.S)
    place = "%.0f %.0f %.0f" % (4000 + draws.uniform(-300, 300), -1600 + draws.uniform(-300, 300), 1200)
    for old, new in (('seed="20261123"', f'seed="{one["seed"]}" measurement="{draws.getrandbits(40)}"'),
                     ('date="2026-11-23"', f'date="{name_of(date)}"'), ('count="100"', 'count="60"'),
                     ('name="M-900iB/700 size, a day without a load (simulated)"', f'name="{one["machine"]} {name_of(date)}"'),
                     ('xyz_mm="4000 -1600 1200"', f'xyz_mm="{place}"')):
        assert old in text, old
        text = text.replace(old, new)
    return text


def spec_of(one, date, draws):
    changed = date >= one["from"]
    text = SAMPLE.read_text().replace('urdf="', f'urdf="{SAMPLE.parent}/')
    text = re.sub(r"<joints.*?</joints>", "<joints>" + "".join(
        f'<joint index="{j + 1}" stiffness_nm_per_rad="{k * (0.95 if changed and one["joint"] == j + 1 else 1.0):.9g}" '
        f'bearing_nm_per_rad="{one["bearing"][j]:.9g}"/>' for j, k in enumerate(one["stiffness"])) + "</joints>", text,
        flags=re.S)
    if changed and one["kind"] == "loose_base":
        text = text.replace("</joints>", f'</joints>\n<base rotation_nm_per_rad="{one["base"]:.6g} {one["base"]:.6g} 1e8"/>')
    place = "%.0f %.0f %.0f" % (4000 + draws.uniform(-300, 300), -1600 + draws.uniform(-300, 300), 1200)
    for old, new in (('seed="20170924" measurement="2"', f'seed="{one["seed"]}" measurement="{draws.getrandbits(40)}"'),
                     ('date="2026-11-21"', f'date="{name_of(date)}"'), ('count="19"', 'count="12"'),
                     ('name="M-900iB/700 size, double encoders active (simulated)"', f'name="{one["machine"]} {name_of(date)}"'),
                     ('masses_kg="51 102 153"', 'masses_kg="76 153"'), ('repeats="3"', 'repeats="2"'),
                     ('readings="1000"', 'readings="100"'), ('xyz_mm="4000 -1600 1200"', f'xyz_mm="{place}"')):
        assert old in text, old
        text = text.replace(old, new)
    return re.sub(r'(<circle_sweep [^>]*)count="20"', r'\1count="12"', text)


def taught(text, folder):
    """The postures of the first date again: drawn ones depend on where the tracker stands."""
    with open(folder / "states.csv", newline="") as table:
        angles = {row["pose"]: " ".join(row[f"q{j}_deg"] for j in range(1, 7)) for row in csv.DictReader(table)
                  if row["step"] == "0"}
    listed = "".join(f'<posture q_deg="{q}"/>' for q in angles.values())
    again, count = re.subn(r"<draw [^>]*?/>|<draw .*?</draw>", listed, text, flags=re.S)
    assert count == 1
    return again


def name_of(date):
    return f"2026-{date // 2 + 1:02}-{5 + 14 * (date % 2):02}"


def make(arguments):
    draws = random.Random(arguments.seed)
    loose = 0 if arguments.unloaded else arguments.loose
    fleet = list(draw(draws, arguments.machines, arguments.dates, arguments.softened, loose, arguments.joints))
    for one in fleet:
        one["lost"] = random.Random(one["seed"] + 1).uniform(0.05, 0.10) if arguments.unloaded else 0.05
    arguments.folder.mkdir(parents=True)
    with open(arguments.folder.with_name(arguments.folder.name + "-truth.csv"), "w", newline="") as file:
        table = csv.writer(file)
        table.writerow(["machine", "kind", "joint", "date", "lost"])
        for one in fleet:
            table.writerow([one["machine"], one["kind"], one["joint"] or "", name_of(one["from"]) if one["kind"] else "",
                            f'{one["lost"]:.4f}' if one["kind"] == "softened" else ""])
    def simulate(one):
        for date in range(arguments.dates):
            folder = arguments.folder / one["machine"] / name_of(date)
            folder.parent.mkdir(exist_ok=True)
            text = one["specs"][date]
            spec = arguments.folder.parent / f"{arguments.folder.name}-{one['machine']}-{date}.xml"
            spec.write_text(text if date == 0 else taught(text, folder.with_name(name_of(0))))
            subprocess.run([arguments.binary, "simulate", spec, "--out", folder], check=True, stdout=subprocess.DEVNULL)
            (folder / "truth.json").unlink(missing_ok=True)
            spec.unlink()

    for one in fleet:
        one["specs"] = [(unloaded_spec_of if arguments.unloaded else spec_of)(one, date, draws) for date in range(arguments.dates)]
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        list(pool.map(simulate, fleet))


def score(arguments):
    def rows(file):
        with open(file, newline="") as table:
            return list(csv.DictReader(table))

    steps, detectable = rows(arguments.out / "steps.csv"), rows(arguments.out / "detectable.csv")
    found_right = dated_right = named_right = 0
    alarms = []
    for one in rows(arguments.folder.with_name(arguments.folder.name + "-truth.csv")):
        found = [step for step in steps if step["machine"] == one["machine"]]
        if not one["kind"]:
            alarms += found
            continue
        right = [step for step in found
                 if (step["quantity"] == "compliance" and step["joint"] == one["joint"] if one["kind"] == "softened"
                     else step["quantity"] == "effect" and "base_compliance" in step["effects"])]
        dated = [step for step in found if step["date"] == one["date"]]
        found_right, dated_right, named_right = found_right + bool(found), dated_right + bool(dated), named_right + bool(right)
        limits = [limit for limit in detectable if limit["machine"] == one["machine"] and limit["joint"] == one["joint"]]
        told = "; ".join(f"told from {float(limit['in_the_middle'] or 'nan'):.1%}" for limit in limits)
        true = f"compliance +{1.0 / (1.0 - float(one['lost'])) - 1.0:.1%} ({told})" if one["lost"] else ""
        print(one["machine"], one["kind"], one["joint"], one["date"], true, "->",
              "; ".join(f"{step['quantity']} {step['joint'] or step['effects']} from {step['date']}" +
                        (f" by {float(step['change']):.1%} ({float(step['change_low']):.1%} to {float(step['change_high']):.1%})"
                         if step["change"] else "") for step in found) or "nothing")
    print(f"found {found_right}, at the right date {dated_right}, as what it is {named_right}; false alarms {len(alarms)}:",
          "; ".join(f"{step['machine']} {step['quantity']} {step['joint'] or step['effects']} {step['date']}" for step in alarms))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("task", choices=["make", "score"])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path, nargs="?")
    parser.add_argument("--binary", default=str(HERE.parent / "build/bin/stiffscope"))
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--machines", type=int, default=20)
    parser.add_argument("--dates", type=int, default=10)
    parser.add_argument("--softened", type=int, default=5)
    parser.add_argument("--loose", type=int, default=3)
    parser.add_argument("--unloaded", action="store_true")
    parser.add_argument("--joints", type=int, nargs="+", default=[2, 3, 4, 5, 6], help="one of which a machine loses stiffness of")
    parser.add_argument("--jobs", type=int, default=2)
    arguments = parser.parse_args()
    make(arguments) if arguments.task == "make" else score(arguments)


if __name__ == "__main__":
    main()
