"""Every JSON that a command writes is what docs/results.schema.json says, and the schema sees a wrong one.

schema_test.py PROGRAM: validates the recorded results of tests/golden, which the golden tests hold against today's program,
and what PROGRAM writes now of the commands that have no record. Ends with 77 (skipped) without python3-jsonschema.
"""

import copy
import csv
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

try:
    import jsonschema
except ImportError:
    print("skipped: no python3-jsonschema")
    sys.exit(77)

SOURCE = pathlib.Path(__file__).resolve().parent.parent
SCHEMA = json.loads((SOURCE / "docs" / "results.schema.json").read_text(encoding="utf-8"))
SAMPLES = SOURCE / "samples"

# Of the recorded cases which definition they are of, by the name of the case.
RECORDED = {
    "audit": "audit", "frames": "frames", "identify-json": "identify", "diagnose": "diagnose", "compensate": "compensate",
    "compensate-postures": "compensate", "compensate-with": "compensate", "plan": "plan", "compare": "compare",
    "report": "report", "stiffness": "stiffness"}

# Commands without a record: definition, words; JSON goes to the file named last.
LIVE = [
    ("audit", "audit {samples}/unloaded"),
    ("frames", "frames {samples}/unloaded"),
    ("calibrate", "calibrate {samples}/unloaded"),
    ("diagnose_unloaded", "diagnose {samples}/unloaded"),
    ("plan_unloaded", "plan --unloaded {samples}/unloaded --postures 12"),
    ("compare_unloaded", "compare {samples}/unloaded {samples}/unloaded"),
    ("identify", "identify {samples}/active --springs-only --method pp --step all --bootstrap 20"),
    ("identify", "identify {samples}/active --springs-only --method dpp"),
    ("identify", "identify {samples}/active --springs-only --method cp"),
    ("compensate", "compensate {samples}/active --springs-only --program {out}/work.mod --out {out}/new.mod "
                   "--wrench 0,0,-1500,0,0,0"),
    ("compensate", "compensate {out}/k1_known --springs-only --path {samples}/oval.csv --tool 120,0,300,0,45,0 "
                   "--workpiece 1900,100,900,0,0,0 --wrench 0,0,-1500,0,0,0"),
    ("compensate", "compensate {samples}/active --springs-only --path {samples}/oval.csv --tool 120,0,300,0,45,0 "
                   "--workpiece 3900,100,900,0,0,0 --wrench 0,0,-1500,0,0,0"),
    ("import_campaign", "import campaign {out}/files/day.xml --out {out}/imported"),
    ("plan", "plan {out}/k1_known --springs-only --postures 4 --candidates 200"),
    ("export_urdf", "export urdf {samples}/unloaded --out {out}/arm.urdf"),
    ("export_elastic", "export mjcf {samples}/active --springs-only --out {out}/arm.xml"),
    ("export_dcc", "export dcc {out}/certified --springs-only --out {out}/dcc.xml"),
    ("frames", "frames {out}/certified --springs-only"),
    ("stiffness", "stiffness {samples}/active --springs-only --spacing 500 --force 0,0,-1000"),
    ("import_points", "import points {source}/tests/fuzz/corpus/point_file/sa.txt"),
    ("import_points", "import points {source}/tests/fuzz/corpus/point_file/leica.csv"),
]

# What every kind of day can be asked, and by which definition its answer is; `sweeps` is a day of sweeps alone.
KINDS = {
    "unloaded": {"identify": "identify", "diagnose": "diagnose_unloaded"},
    "sweeps": {"audit": "audit", "frames": "frames", "identify": "identify", "diagnose": "diagnose",
               "calibrate": "calibrate"},
    # Displacements alone: no positions to hold them against, and one method out of three.
    "displacements": {"identify --step all": "identify", "diagnose": "diagnose", "compensate": "compensate"}}

# Numbers that there are not on a day without a load are null, not zero.
NUMBERS_OF_LOAD = [
    ("step",), ("shown_first",), ("noise_share",), ("servo_change_deg",), ("posture_stiffness",),
    ("geometric_stiffness", "torque_change_share"), ("identifiability", "load_hangs"),
    ("identifiability", "force_to_gravity_rms_deg"), ("identifiability", "joints", 0, "torque_rms_nm"),
    ("identifiability", "joints", 0, "trusted_torque_rms_nm"), ("identifiability", "joints", 0, "torque_uncertainty_nm")]

CERTIFICATE = (
    '<certificate number="1" country="DE" languages="en" place="laboratory"><laboratory name="L" city="C"/>'
    '<customer name="K" city="C"/><responsible name="R"/><item serial="S"/></certificate>')

# Joint 3 as FANUC states it.
READING = '<joint_reading joint="3" plus="2"/>'
KNOWN = '<known_stiffness joint="1" nm_per_rad="7.1e6" sd_nm_per_rad="2e5" source="maker"/>'

PROGRAM = """MODULE work
  CONST jointtarget j1:=[[10,5,0,0,20,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    MoveAbsJ j1,v100,fine,tool0;
  ENDPROC
ENDMODULE
"""

DAY = """<day format="1" name="D" date="2026-01-31">
  <robot urdf="robot.urdf" base_link="base_link" flange_link="tool0"/>
  <targets><target id="P10"/></targets>
  <points role="loading" file="points.csv"/> <log file="log.csv"/> <join by="name"/>
</day>
"""

BALANCERS = (
    '<balancer kind="gas" from_link="link_1" from_mm="-500 0 0" to_link="link_2" to_mm="-160 0 190" acts="pull" '
    'pressure_bar="150" area_cm2="17" volume_l="6" length_mm="773"/>'
    '<balancer kind="spring" from_link="link_1" from_mm="-500 0 0" to_link="link_2" to_mm="-160 0 190" '
    'rate_n_per_m="42000" tension_n="-1800" length_mm="773"/>')


def day_of_kind(kind, out):
    """The folder of a day: the sample's without a load, or one of the sample with loads with only what the kind has."""
    if kind == "unloaded":
        return SAMPLES / "unloaded"
    folder = out / kind
    shutil.copytree(SAMPLES / "active", folder)
    xml = (folder / "campaign.xml").read_text(encoding="utf-8")
    if kind == "displacements":
        write_displacements(folder)
        xml = xml.replace("</campaign>", '<displacements file="displacements.csv" frame="tracker"/></campaign>')
        places = re.findall(r'<target id="(\w+)" xyz_mm="(\S+) (\S+) (\S+)"', (SAMPLES / "active.xml").read_text(encoding="utf-8"))
        assert len(places) == 3, places
        for target, *place in places:
            xml = xml.replace('<target id="{}"/>'.format(target),
                              '<target id="{}" x_mm="{}" y_mm="{}" z_mm="{}"/>'.format(target, *place))
    for name in ["loading", "nests"] + (["load_cell", "tool", "states"] if kind == "sweeps" else []):
        xml, count = re.subn("<{} [^>]*/>".format(name), "", xml)
        assert count == 1, name
        (folder / (name + ".csv")).unlink(missing_ok=True)
    (folder / "campaign.xml").write_text(xml, encoding="utf-8")
    return folder


def write_displacements(folder):
    """Positions less those of step 0: means of the readings, as a user has who kept only differences."""
    positions = {}
    with open(folder / "loading.csv", encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            point = [float(row[axis]) for axis in ("x_mm", "y_mm", "z_mm")]
            positions.setdefault((row["pose"], row["step"], row["target"]), []).append(point)
    means = {key: [sum(axis) / len(points) for axis in zip(*points)] for key, points in positions.items()}
    lines = ["pose,step,target,dx_mm,dy_mm,dz_mm"]
    for (pose, step, target), point in means.items():
        if step != "0":
            moved = [one - at_rest for one, at_rest in zip(point, means[pose, "0", target])]
            lines.append(",".join([pose, step, target, *("{:.6f}".format(one) for one in moved)]))
    (folder / "displacements.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")


def kinds_of_day(program, out):
    """What commands say of the kinds of day, `report` among them."""
    for kind, commands in KINDS.items():
        day = day_of_kind(kind, out)
        for words, definition in commands.items():
            result = out / "kind.json"
            result.unlink(missing_ok=True)
            ran = subprocess.run([program, *words.split(), str(day), "--json", str(result)], capture_output=True, check=False)
            if ran.returncode not in (0, 1) or not result.exists():
                raise AssertionError("{} of {}: {}".format(words, kind, ran.stderr.decode()))
            yield [words, kind], definition, json.loads(result.read_text(encoding="utf-8"))
        report = out / (kind + "-report")
        subprocess.run([program, "report", str(day), "--out", str(report)], capture_output=True, check=True)
        yield ["report", kind], "report", json.loads((report / "results.json").read_text(encoding="utf-8"))


def zeros_for_nothing(case, definition, value):
    """Of an identification without postures under load: numbers that are not null."""
    if definition != "identify" or value["postures"] != 0:
        return []
    wrong = []
    for path in NUMBERS_OF_LOAD:
        number = value
        for key in path:
            number = number[key]
        if number is not None:
            wrong.append("{}: {} is {}, expected null".format(" ".join(case), "/".join(map(str, path)), number))
    return wrong


def validator(definition):
    """Of one definition of the schema."""
    schema = {"$schema": SCHEMA["$schema"], "$ref": "#/$defs/" + definition, "$defs": SCHEMA["$defs"]}
    return jsonschema.Draft202012Validator(schema)


def errors_of(definition, value):
    """The first few contradictions, each with its place."""
    found = sorted(validator(definition).iter_errors(value), key=lambda error: list(map(str, error.absolute_path)))
    return ["{}: {}: {}".format(definition, "/".join(map(str, error.absolute_path)), error.message[:200])
            for error in found[:5]]


def recorded():
    for file in sorted((SOURCE / "tests" / "golden").rglob("*.json")):
        case = file.relative_to(SOURCE / "tests" / "golden").parts
        definition = "fit" if case[0] == "fit" else RECORDED.get(case[1])
        if definition is None:
            yield case, None, None
        else:
            yield case, definition, json.loads(file.read_text(encoding="utf-8"))


def live(program):
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder)
        certified = out / "certified"
        certified.mkdir()
        for file in (SAMPLES / "active").iterdir():
            (certified / file.name).write_bytes(file.read_bytes())
        xml = (certified / "campaign.xml").read_text(encoding="utf-8")
        (certified / "campaign.xml").write_text(xml.replace("<tracker", CERTIFICATE + BALANCERS + "<tracker", 1), encoding="utf-8")
        known = out / "k1_known"
        known.mkdir()
        for file in (SAMPLES / "active").iterdir():
            (known / file.name).write_bytes(file.read_bytes())
        (known / "campaign.xml").write_text(xml.replace("<tracker", READING + KNOWN + "<tracker", 1), encoding="utf-8")
        (out / "work.mod").write_text(PROGRAM, encoding="utf-8")
        files = out / "files"
        files.mkdir()
        (files / "day.xml").write_text(DAY, encoding="utf-8")
        (files / "robot.urdf").write_bytes((SAMPLES / "m900ib700.urdf").read_bytes())
        (files / "log.csv").write_text(
            "pose,step,q1_deg,q2_deg,q3_deg,q4_deg,q5_deg,q6_deg,fx_n,fy_n,fz_n,mx_nm,my_nm,mz_nm\n"
            "A,0,10,0,0,0,20,0,0,0,0,0,0,0\nA,1,10,0,0,0,20,0,0,0,-500,0,0,0\n", encoding="utf-8")
        (files / "points.csv").write_text("pose,step,target,x_mm,y_mm,z_mm\nA,0,P10,1000,2000,300\n"
                                          "A,1,P10,1000,2000,299.5\n", encoding="utf-8")
        for definition, words in LIVE:
            words = words.format(samples=SAMPLES, out=out, source=SOURCE).split()
            ran = subprocess.run([program, *words, "--json", "-"], capture_output=True, check=False)
            if ran.returncode not in (0, 1):
                raise AssertionError("{}: {}".format(" ".join(words), ran.stderr.decode()))
            yield words, definition, json.loads(ran.stdout)
        machines = [("seven_axis", "frames", "identify", "compensate", "diagnose"), ("palletiser", "frames", "identify"),
                    ("parallelogram", "frames", "identify", "compare"), ("rail", "identify", "compare")]
        for kind, *commands in machines:
            subprocess.run([program, "blind", "--machine", kind, "--cases", "1", "--seed", "1", "--out", str(out / kind)],
                           capture_output=True, check=True)
            campaign = next((out / kind / "cases").rglob("campaign.xml")).parent
            for definition in commands:
                days = [str(campaign)] * (2 if definition == "compare" else 1)
                result = out / "result.json"
                # Text and JSON: what the text says is not read here, only that there is one.
                ran = subprocess.run([program, definition, *days, "--json", str(result)], capture_output=True, check=False)
                if ran.returncode not in (0, 1) or not ran.stdout:
                    raise AssertionError("{} of {}: {}".format(definition, kind, ran.stderr.decode()))
                yield [definition, kind], definition, json.loads(result.read_text(encoding="utf-8"))
        yield from kinds_of_day(program, out)
        for spec in ("active", "unloaded"):
            folder = out / ("simulated-" + spec)
            subprocess.run([program, "simulate", str(SAMPLES / (spec + ".xml")), "--out", str(folder)],
                           capture_output=True, check=True)
            yield ["simulate", spec], "truth", json.loads((folder / "truth.json").read_text(encoding="utf-8"))


def spoilt(value):
    """The value with a key too many, and with its first number as a text: the schema must see both."""
    more = copy.deepcopy(value)
    more["no_such_key"] = 1
    yield "a key too many", more
    less = copy.deepcopy(value)
    less.pop(next(iter(value)))
    yield "the first key left out", less
    words = copy.deepcopy(value)

    def change(node):
        items = node.items() if isinstance(node, dict) else enumerate(node)
        for key, one in list(items):
            if isinstance(one, bool):
                continue
            if isinstance(one, (int, float)):
                node[key] = "79.8 %"
                return True
            if isinstance(one, (dict, list)) and change(one):
                return True
        return False

    if change(words):
        yield "a number as a text", words


def main():
    jsonschema.Draft202012Validator.check_schema(SCHEMA)
    failures, count, seen = [], 0, {}
    for source in (recorded(), live(sys.argv[1])):
        for case, definition, value in source:
            if definition is None:
                failures.append("{}: no definition for it".format("/".join(case)))
                continue
            count += 1
            failures += ["{}: {}".format(" ".join(case), error) for error in errors_of(definition, value)]
            failures += zeros_for_nothing(case, definition, value)
            seen.setdefault(definition, value)
    for definition, value in seen.items():
        for what, wrong in spoilt(value):
            if not errors_of(definition, wrong):
                failures.append("{}: {} is not seen".format(definition, what))
    print("\n".join(failures))
    print("{} results against {} definitions: {} contradictions".format(count, len(seen), len(failures)))
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
