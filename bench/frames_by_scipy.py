#!/usr/bin/env python3
"""frames_by_scipy.py CAMPAIGN OUT.json: axes by circle-point, link lengths and the wrist centre of a campaign of sweeps, as one
would write it with pandas and scipy: per axis one least squares of all its circles about one line, weighted by the tracker's
noise; concentric spheres for the wrist. Radii, common normals and standard uncertainties; no R0, no geometry of the arm."""
import json, pathlib, sys
import xml.etree.ElementTree as ElementTree
import timing  # one thread
import numpy as np
import pandas as pd
from scipy.optimize import least_squares


def noise(tracker, points):
    """Covariances (n, 3, 3) in the tracker's own frame."""
    distance = np.linalg.norm(points, axis=1)
    along = tracker["range_fixed_um"] + tracker["range_per_m_um"] * distance
    across = tracker["angle_fixed_um"] + tracker["angle_per_m_um"] * distance
    beam = points / distance[:, None]
    isotropic, beams = (across ** 2)[:, None, None] * np.eye(3), beam[:, :, None] * beam[:, None, :]
    return 1e-12 * (isotropic + (along ** 2 - across ** 2)[:, None, None] * beams)


def solve(residual, start):
    found = least_squares(residual, start, method="lm", x_scale="jac", xtol=1e-13, ftol=1e-13)
    return found.x, np.sqrt(np.diag(np.linalg.inv(found.jac.T @ found.jac)))


def axis(points, which, tracker):
    """Line (point, direction), radii and their uncertainties of circles about one axis."""
    count = which.max() + 1
    middles = np.array([points[which == k].mean(axis=0) for k in range(count)])
    flat = points - middles[which]
    frame = np.linalg.eigh(flat.T @ flat)[1]  # the axis first
    local = (points - middles[0]) @ frame
    rows = np.column_stack([2 * local[:, 1:], *(which == k for k in range(count))])
    start = np.linalg.lstsq(rows, (local[:, 1:] ** 2).sum(1), rcond=None)[0]
    radii = np.sqrt(start[2:] + start[:2] @ start[:2])
    heights = [local[which == k, 0].mean() for k in range(count)]
    p = np.concatenate([[0, 0], start[:2], radii, heights])

    def parts(p):
        """Direction of the axis; height and the vector from the axis of every point."""
        direction = np.array([1.0, p[0], p[1]]) / np.sqrt(1 + p[0] ** 2 + p[1] ** 2)
        away = local - np.array([0.0, p[2], p[3]])
        height = away @ direction
        return direction, height, away - height[:, None] * direction

    def residual(p):
        _, height, across = parts(p)
        plain = np.stack([np.linalg.norm(across, axis=1) - p[4:4 + count][which], height - p[4 + count:][which]], 1)
        return (whiten @ plain[..., None]).reshape(-1)

    direction, _, across = parts(p)
    out = across / np.linalg.norm(across, axis=1)[:, None]
    basis = np.stack([out, np.broadcast_to(direction, out.shape)], 1) @ frame.T
    whiten = np.linalg.inv(np.linalg.cholesky(basis @ noise(tracker, points) @ np.swapaxes(basis, 1, 2)))
    p, sd = solve(residual, p)
    place = middles[0] + frame @ np.array([0.0, p[2], p[3]])
    return place, frame @ parts(p)[0], p[4:4 + count], sd[4:4 + count]


def spheres(points, which, tracker):
    count = which.max() + 1
    middle = points.mean(axis=0)
    local = points - middle
    rows = np.column_stack([2 * local, *(which == k for k in range(count))])
    start = np.linalg.lstsq(rows, (local ** 2).sum(1), rcond=None)[0]
    out = local - start[:3]
    out /= np.linalg.norm(out, axis=1)[:, None]
    sigma = np.sqrt(np.einsum("ni,nij,nj->n", out, noise(tracker, points), out))

    def residual(p):
        return (np.linalg.norm(local - p[:3], axis=1) - p[3:][which]) / sigma

    p, sd = solve(residual, np.concatenate([start[:3], np.sqrt(start[3:] + start[:3] @ start[:3])]))
    return middle + p[:3], p[3:], sd


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
    fits.append(axis(1e-3 * swept[["x_mm", "y_mm", "z_mm"]].to_numpy(), pd.Categorical(swept.target, names).codes, tracker))
centre, radii, sd = spheres(1e-3 * wrist[["x_mm", "y_mm", "z_mm"]].to_numpy(), pd.Categorical(wrist.target, names).codes, tracker)
result = {"axes": [{"radii_mm": (1e3 * fit[2]).tolist(), "sd_radii_mm": (1e3 * fit[3]).tolist()} for fit in fits],
          "lengths_mm": [1e3 * common_normal(*pair) for pair in zip(fits, fits[1:])],
          "wrist": {"center_m": centre.tolist(), "radii_mm": (1e3 * radii).tolist(), "sd": sd.tolist()}}
pathlib.Path(sys.argv[2]).write_text(json.dumps(result))
