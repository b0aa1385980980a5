#!/usr/bin/env python3
"""make_displacements.py SIMULATED OUT: a campaign of differences only, for identification by reflectors at the nominal
robot. What a simulated day measured becomes `displacements` from step 0; the reflectors' places go into campaign.xml. The simulated tracker must stand parallel to base_link, so that differences need no turning."""
import pathlib, re, shutil, sys
import pandas as pd

simulated, out = map(pathlib.Path, sys.argv[1:3])
out.mkdir(parents=True, exist_ok=True)
# Without masses there is no own weight to bend the arm before the load does.
urdf = re.sub(r"<inertial>.*?</inertial>", "", (simulated / "robot.urdf").read_text(), flags=re.S)
(out / "robot.urdf").write_text(urdf)
shutil.copy(simulated / "states.csv", out)
loading = pd.read_csv(simulated / "loading.csv")
rest = loading[loading.step == 0].set_index(["pose", "target"])[["x_mm", "y_mm", "z_mm"]]
loaded = loading[loading.step > 0].join(rest, on=["pose", "target"], rsuffix="_0")
for axis in "xyz":
    loaded[f"d{axis}_mm"] = (loaded[f"{axis}_mm"] - loaded[f"{axis}_mm_0"]).round(4)
loaded[["pose", "step", "target", "dx_mm", "dy_mm", "dz_mm"]].to_csv(out / "displacements.csv", index=False)

xml = (simulated / "campaign.xml").read_text()
places = {"P10": "262 35 60", "P11": "-165 215 45", "P12": "-110 -245 80"}
for name, place in places.items():
    x, y, z = place.split()
    xml = re.sub(f'<target id="{name}"[^>]*/>', f'<target id="{name}" x_mm="{x}" y_mm="{y}" z_mm="{z}"/>', xml)
xml = re.sub(r"\s*<(circle_sweeps|wrist_sweep|nests|tool)\b[^>]*/>", "", xml)
xml = re.sub(r"<loading\b[^>]*/>", '<displacements file="displacements.csv" frame="base_link"/>', xml)
(out / "campaign.xml").write_text(xml)
