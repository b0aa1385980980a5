"""Campaigns of three sizes for the benchmark of whole commands, by `stiffscope simulate` from the samples' specifications."""
import pathlib, re, shutil, subprocess, sys

HERE = pathlib.Path(__file__).resolve().parent
SAMPLES = HERE.parent / "samples"


def run(*command):
    subprocess.run([str(word) for word in command], check=True, stdout=subprocess.DEVNULL)


def made(folder, changes, make, sample="active.xml"):
    """`folder`, unless it is there; changes: of the sample's specification, old and new. `make(spec, part)` makes it under
    another name, so that what an interrupted run leaves is not taken for whole."""
    if folder.exists():
        return folder
    folder.parent.mkdir(parents=True, exist_ok=True)
    spec = (SAMPLES / sample).read_text()
    for old, new in [('urdf="', f'urdf="{SAMPLES}/'), *changes]:
        assert old in spec, old
        spec = spec.replace(old, new)
    file, part = folder.with_suffix(".xml"), folder.with_name(folder.name + "-part")
    file.write_text(spec)
    shutil.rmtree(part, ignore_errors=True)
    make(file, part)
    part.rename(folder)
    return folder


def differences(binary, work, postures):
    """Differences of 14 load steps only, 10,000 postures are 28 MB."""
    folder = work / f"differences{postures}"
    masses = " ".join(f"{10.9 * i:.1f}" for i in range(1, 15))

    def make(spec, part):
        simulated = folder.with_name(folder.name + "-day")
        run(binary, "simulate", spec, "--out", simulated, "--replace")
        run(sys.executable, HERE / "make_displacements.py", simulated, part)
        shutil.rmtree(simulated)

    changes = [('count="19" candidates="20"', f'count="{postures}" candidates="1"'), ('repeats="3"', 'repeats="1"'),
               ('masses_kg="51 102 153"', f'masses_kg="{masses}"'), ('return_to_zero="true"', 'return_to_zero="false"'),
               ('rpy_deg="0.3 -0.2 152"', 'rpy_deg="0 0 0"')]
    return made(folder, changes, make)


def day(binary, work, postures):
    """The sample's day with more postures."""
    folder = work / f"day{postures}"
    return made(folder, [('count="19" candidates="20"', f'count="{postures}" candidates="1"')],
                lambda spec, part: run(binary, "simulate", spec, "--out", part))


def unloaded(binary, work, postures):
    """The sample's day without a load with more postures."""
    folder = work / f"unloaded{postures}"
    return made(folder, [('count="100"', f'count="{postures}"')],
                lambda spec, part: run(binary, "simulate", spec, "--out", part), "unloaded.xml")


def sweeps(binary, work, per_circle):
    """Circle and wrist sweeps alone, of an arm without weight: nothing but the tracker's noise is in them."""
    folder = work / f"sweeps{per_circle}"
    light = work / "light.urdf"

    def make(spec, part):
        light.write_text(re.sub(r"<inertial>.*?</inertial>", "", (SAMPLES / "m900ib700.urdf").read_text(), flags=re.S))
        run(binary, "simulate", spec, "--out", part)
        description = (part / "campaign.xml").read_text()
        kept = re.sub(r"\s*<(loading|states|nests|load_cell|tool)\b[^>]*/>", "", description)
        (part / "campaign.xml").write_text(kept)

    return made(folder, [(f"{SAMPLES}/m900ib700.urdf", str(light.resolve())), ('mass_kg="60"', 'mass_kg="0.001"'),
                         ('count="20"/>', f'count="{per_circle}"/>'), ('readings="1000"', f'readings="{50 * per_circle}"')], make)
