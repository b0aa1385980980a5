#!/usr/bin/env python3
"""Days that are long or odd: each command ends in time with an answer, or with a reason.

    tests/odd_days.py STIFFSCOPE [small|large] [DAY...]

Makes each day by `simulate` (no part of the program under test knows what is odd about it), runs the commands on it, and
prints a line for each: status, processor seconds, and the reason where the status is not 0. Fails where a command is killed by a
signal, takes too long, prints "nan" or "inf" in its text or JSON, ends with another status than 0, 1 and 2, says nothing
where the status is not 0, or writes of a sanitizer. STIFFSCOPE_ODD_SECONDS is the processor time that a command may take.
"""

import os
import pathlib
import re
import resource
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
LOADED = (ROOT / "samples/active.xml").read_text()
UNLOADED = (ROOT / "samples/unloaded.xml").read_text()
LOADED_COMMANDS = ("audit", "frames", "identify", "identify --springs-only", "calibrate", "report")
UNLOADED_COMMANDS = ("audit", "calibrate", "identify", "report")
SHORT = 3.0  # s: what runs a second time for its JSON


def changed(spec, *changes):
    for pattern, into in changes:
        spec, count = re.subn(pattern, into, spec, flags=re.DOTALL)
        assert count, pattern
    return spec


def with_targets(spec, count):
    """Reflectors on a sphere of 0.3 m about the flange, none on the same place."""
    places = []
    for k in range(count):
        x = 300.0 * (((k * 0.61803398875) % 1.0) - 0.5)
        y = 300.0 * (((k * 0.75487766625) % 1.0) - 0.5)
        places.append(f'<target id="T{k}" xyz_mm="{x:.3f} {y:.3f} {60 + 40 * ((k * 0.569840291) % 1.0):.3f}"/>')
    return changed(spec, (r"<targets>.*?</targets>", "<targets>" + "".join(places) + "</targets>"),
                   (r'<wrist_sweep readings="\d+"', f'<wrist_sweep readings="{max(1000, count)}"'))


def alike(spec, count):
    one = '<posture q_deg="10 5 -20 30 60 40"/>'
    return changed(spec, (r"<draw .*?/>", one * count))


def stiff(spec, stiffness):
    return changed(spec, (r' stiffness_nm_per_rad="[^"]*" bearing_nm_per_rad="[^"]*"',
                          f' stiffness_nm_per_rad="{stiffness}"'))


def small_arm(spec):
    """A tenth of a metre of reach: all lengths of arm, tool and cell over 30, loads and stiffnesses with them."""
    return changed(
        spec,
        (r'urdf="m900ib700.urdf"', 'urdf="small.urdf"'),
        (r'<joint index="1".*</joints>',
         "".join(f'<joint index="{j}" stiffness_nm_per_rad="{k}"/>' for j, k in
                 enumerate((200, 150, 100, 20, 20, 10), 1)) + "</joints>"),
        (r"position_sigma_mm=\"0.2\"", 'position_sigma_mm="0.01"'),
        (r"wrist_position_sigma_mm=\"0.02\"", 'wrist_position_sigma_mm="0.002"'),
        (r'<tool mass_kg="60" com_mm="0 0 90"/>', '<tool mass_kg="0.05" com_mm="0 0 3"/>'),
        (r"<targets>.*?</targets>",
         '<targets><target id="P10" xyz_mm="12 1 2"/><target id="P11" xyz_mm="-8 10 1.5"/>'
         '<target id="P12" xyz_mm="-5 -11 3"/></targets>'),
        (r'xyz_mm="4000 -1600 1200"', 'xyz_mm="1600 -600 300"'),
        (r'xyz_mm="0 0 110" rpy_deg="0 0 0" force_sigma_n="1" moment_sigma_nm="0.3"',
         'xyz_mm="0 0 3" rpy_deg="0 0 0" force_sigma_n="0.01" moment_sigma_nm="0.0005"'),
        (r'masses_kg="51 102 153" hook_mm="100 60 200"', 'masses_kg="0.1 0.2 0.3" hook_mm="4 2 7"'),
        (r'min_height_mm="1100" max_height_mm="2600" min_tracker_distance_mm="1500"\s*'
         r'max_tracker_distance_mm="4500" min_hang_clearance_mm="200"', ""))


def small_urdf():
    def shorter(match):
        return match[1] + " ".join(f"{float(x) / 30:.7f}" for x in match[2].split()) + '"'

    text = re.sub(r'(<origin xyz=")([^"]*)"', shorter, (ROOT / "samples/m900ib700.urdf").read_text())
    return re.sub(r'(mass value=")([^"]*)"', lambda m: f'{m[1]}{float(m[2]) / 27000:.6f}"', text)


def draws(spec, count):
    return changed(spec, (r'<draw count="\d+" candidates="20"', f'<draw count="{count}"'))


def arcs(spec, degrees):
    return re.sub(r'start_deg="[^"]*" stop_deg="[^"]*"', f'start_deg="{-degrees / 2}" stop_deg="{degrees / 2}"', spec)


def days(large):
    """Name, specification, commands."""
    one_reading = changed(with_targets(LOADED, 1), (r'repeats="3"', 'repeats="1"'), (r'return_to_zero="true"',
                          'return_to_zero="false"'), (r"51 102 153", "153"))
    return {
        "many_readings": (draws(changed(LOADED, (r'repeats="3"', f'repeats="{333 if large else 20}"')),
                                200 if large else 10), LOADED_COMMANDS),  # a million: 5 states of 3 reflectors
        "many_readings_unloaded": (changed(UNLOADED, (r'repeats="2"', 'repeats="10"'), (
            r'draw count="100"', f'draw count="{33334 if large else 100}"')), UNLOADED_COMMANDS),
        "many_reflectors": (draws(with_targets(LOADED, 100 if large else 14), 6), LOADED_COMMANDS),
        "too_many_reflectors": (draws(with_targets(LOADED, 10000 if large else 1000), 2), LOADED_COMMANDS),
        "one_reading_a_posture": (one_reading, LOADED_COMMANDS),
        "one_reading_a_posture_unloaded": (changed(with_targets(
            UNLOADED.replace("</simulation>", '<wrist_sweep readings="1000" min_deg="-150 -110 -170" '
                             'max_deg="150 110 170"/></simulation>'), 1), (r'repeats="2"', 'repeats="1"')),
            UNLOADED_COMMANDS),
        "postures_alike": (alike(LOADED, 500 if large else 10), LOADED_COMMANDS),
        "postures_alike_unloaded": (alike(UNLOADED, 500 if large else 30), UNLOADED_COMMANDS),
        "tracker_at_100_m": (changed(LOADED, (r'xyz_mm="4000 -1600 1200"', 'xyz_mm="95000 -30000 1200"'), (
            r' min_tracker_distance_mm="1500"\s*max_tracker_distance_mm="4500"', "")), LOADED_COMMANDS),
        "arm_of_10_cm": (small_arm(LOADED), LOADED_COMMANDS),
        "soft_1e3": (changed(stiff(LOADED, 1000), (r'masses_kg="51 102 153"', 'masses_kg="0.05 0.1 0.2"'), (
            r'<tool mass_kg="60"', '<tool mass_kg="0.05"'), (r'urdf="m900ib700.urdf"', 'urdf="light.urdf"')),
            LOADED_COMMANDS),
        "stiff_1e9": (stiff(LOADED, "1e9"), LOADED_COMMANDS),
        "arcs_of_2_degrees": (arcs(LOADED, 2.0), LOADED_COMMANDS),
    }


NOT_A_NUMBER = re.compile(r"(?<![\w.])[-+]?(nan|inf|infinity)(?![\w])", re.IGNORECASE)
SANITIZER = re.compile(r"Sanitizer|runtime error:")


def fault_of(status, seconds, limit, out, err, result):
    """What is wrong with how a command ended; empty where nothing is."""
    if seconds > limit:
        return f"took longer than {limit} s"
    if status not in (0, 1, 2):
        return f"ended by status {status}"
    if SANITIZER.search(err):
        return "a sanitizer reports"
    for name, text in (("text", out), ("errors", err), ("results", result)):
        found = NOT_A_NUMBER.search(text)
        if found:
            return f"{name}: " + " ".join(text[max(0, found.start() - 60):found.end() + 20].split())
    if status == 2 and not err.strip():
        return "status 2 without a message"
    if status == 1 and not (out + err).strip():
        return "status 1 without a word"
    return ""


def reason_of(status, out, err):
    lines = (err if status == 2 else out + err).strip().splitlines()
    return "" if status == 0 or not lines else lines[-1 if status == 2 else 0][:160]


def run(program, arguments, limit):
    """Status, processor time, standard output and error. The system itself ends what takes more than the limit."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([program, *arguments], capture_output=True, text=True, errors="replace",
                          preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (int(limit) + 1, int(limit) + 2)))
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return done.returncode, seconds, done.stdout, done.stderr


def main():
    program = os.path.abspath(sys.argv[1])
    large = sys.argv[2:3] == ["large"]
    wanted = sys.argv[3:]
    limit = float(os.environ.get("STIFFSCOPE_ODD_SECONDS", "600" if large else "120"))
    faults = commands = 0
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        (folder / "m900ib700.urdf").write_text((ROOT / "samples/m900ib700.urdf").read_text())
        (folder / "small.urdf").write_text(small_urdf())
        (folder / "light.urdf").write_text(re.sub(
            r'(mass value=")([^"]*)"', lambda m: f'{m[1]}{float(m[2]) / 3000:.6f}"',
            (ROOT / "samples/m900ib700.urdf").read_text()))
        for name, (spec, of_day) in days(large).items():
            if wanted and name not in wanted:
                continue
            (folder / f"{name}.xml").write_text(spec)
            day = folder / name
            status, seconds, _, err = run(program, ["simulate", str(folder / f"{name}.xml"), "--out", str(day)], limit)
            print(f"{name:31} {'simulate':24} {status:2} {seconds:7.1f} s  {err.strip()[:160]}", flush=True)
            if status != 0:
                faults += 1
                continue
            for command in of_day:
                result = folder / "result.json"
                result.unlink(missing_ok=True)
                first, *options = command.split()
                if first == "report":
                    out_dir = folder / f"{name}-report"
                    arguments = ["report", str(day), "--out", str(out_dir)]
                    result = out_dir / "results.json"
                else:
                    arguments = [first, *options, str(day)]
                status, seconds, out, err = run(program, arguments, limit)
                if first != "report" and status in (0, 1) and seconds < SHORT:  # report has the same results
                    again = run(program, [*arguments, "--json", str(result)], limit)
                    status, err = again[0], err + again[3]
                text = result.read_text() if result.exists() else ""
                fault = fault_of(status, seconds, limit, out, err, text)
                commands += 1
                faults += bool(fault)
                print(f"{name:31} {command:24} {status:2} {seconds:7.1f} s  "
                      f"{'FAULT: ' + fault if fault else reason_of(status, out, err)}", flush=True)
    print(f"{commands} commands, {faults} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
