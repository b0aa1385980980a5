#!/usr/bin/env python3
"""frames_by_scipy.py CAMPAIGN OUT.json: axes by circle-point, link lengths and the wrist centre of a campaign of sweeps, as one
would write it with pandas and scipy: per axis one least squares of all its circles about one line, weighted by the tracker's
noise; concentric spheres for the wrist. Radii, common normals and standard uncertainties; no R0, no geometry of the arm."""
import json, pathlib, sys
import xml.etree.ElementTree as ElementTree
import timing  # one thread
import numpy as np
import pandas as pd
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "by_pandas"))
from sweeps import axis, noise, spheres


def common_normal(a, b):
    across = np.cross(a[1], b[1])
    return abs((b[0] - a[0]) @ across / np.linalg.norm(across))


folder = pathlib.Path(sys.argv[1])
campaign = ElementTree.parse(folder / "campaign.xml").getroot()
tracker = {key: float(value) for key, value in campaign.find("tracker").items() if key != "model"}
names = [t.get("id") for t in campaign.find("targets")]
circles = pd.read_csv(folder / campaign.find("circle_sweeps").get("file"))
wrist = pd.read_csv(folder / campaign.find("wrist_sweep").get("file"))
fits = []
for _, swept in circles.groupby("axis"):
    points = 1e-3 * swept[["x_mm", "y_mm", "z_mm"]].to_numpy()
    fits.append(axis(points, pd.Categorical(swept.target, names).codes, noise(tracker, points)))
points = 1e-3 * wrist[["x_mm", "y_mm", "z_mm"]].to_numpy()
centre, radii, sd = spheres(points, pd.Categorical(wrist.target, names).codes, noise(tracker, points))
result = {"axes": [{"radii_mm": (1e3 * fit[2]).tolist(), "sd_radii_mm": (1e3 * fit[3]).tolist()} for fit in fits],
          "lengths_mm": [1e3 * common_normal(*pair) for pair in zip(fits, fits[1:])],
          "wrist": {"center_m": centre.tolist(), "radii_mm": (1e3 * radii).tolist(), "sd": sd.tolist()}}
pathlib.Path(sys.argv[2]).write_text(json.dumps(result))
