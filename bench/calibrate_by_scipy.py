#!/usr/bin/env python3
"""calibrate_by_scipy.py CAMPAIGN OUT.json: the geometry of an arm by a day without a load, as one would write it with pandas
and scipy: axes, base and reflectors by one nonlinear least squares of all readings, all postures at once, the Jacobian by
screws; once for the whole day, and for either half of the postures (every other one), which predicts the other half. rms of
what is left, of the whole day and held out. All readings weigh alike and none is rejected; no uncertainties, no own weight,
no effects."""
import json, pathlib, sys
import xml.etree.ElementTree as ElementTree
import numpy as np
import pandas as pd
from scipy.optimize import least_squares
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "by_pandas"))
from calibration import Arm, registered, rotation


def vector(text):
    return np.array([float(word) for word in text.split()])


def arm_of(urdf, flange):
    """Point and direction of each joint's axis with all joints at zero, and where the flange stands then."""
    joints = {joint.find("child").get("link"): joint for joint in ElementTree.parse(urdf).getroot().findall("joint")}
    chain, link = [], flange
    while link in joints:
        chain.append(joints[link])
        link = chain[-1].find("parent").get("link")
    frame, axes = np.eye(4), []
    for joint in reversed(chain):
        own = np.eye(4)
        own[:3, 3] = vector(joint.find("origin").get("xyz"))
        roll, pitch, yaw = vector(joint.find("origin").get("rpy", "0 0 0"))
        turn = lambda axis, angle: rotation(axis, np.array([angle]))[0]
        own[:3, :3] = turn((0, 0, 1), yaw) @ turn((0, 1, 0), pitch) @ turn((1, 0, 0), roll)
        frame = frame @ own
        if joint.get("type") != "fixed":
            axes.append((frame[:3, 3], frame[:3, :3] @ vector(joint.find("axis").get("xyz"))))
    return axes, frame[:3, 3]


def started(arm, seen, flange):
    """Base and reflectors by the nominal arm: registration and means, in turns."""
    turn, shift = arm.motions(np.zeros(18))[0][-1]
    targets = np.tile(flange, (seen.shape[1], 1))
    for _ in range(50):
        places = np.einsum("nij,tj->nti", turn, targets) + shift[:, None]
        base = registered(seen.reshape(-1, 3), places.reshape(-1, 3))
        back = np.einsum("nji,ntj->nti", turn, seen @ base[0].T + base[1] - shift[:, None])
        targets = back.mean(0)
    return base, targets


def fitted(arm, seen, flange):
    base, targets = started(arm, seen, flange)
    # About the middle of the readings, so that turns and shifts hardly share anything.
    local = seen @ base[0].T
    middle = local.reshape(-1, 3).mean(0)
    local = local - middle
    count, reflectors = seen.shape[:2]

    def by_base(p):
        angle = np.linalg.norm(p)
        return rotation(p / angle, np.array([angle]))[0] if angle > 0 else np.eye(3)

    def residual(p):
        turn, shift = arm.motions(p)[0][-1]
        places = np.einsum("nij,tj->nti", turn, p[24:].reshape(-1, 3)) + shift[:, None]
        return (local @ by_base(p[18:21]).T + p[21:24] - places).ravel()

    def jacobian(p):
        bodies, screws = arm.motions(p)
        turn, shift = bodies[-1]
        places = np.einsum("nij,tj->nti", turn, p[24:].reshape(-1, 3)) + shift[:, None]
        rows = np.zeros((count, reflectors, 3, len(p)))
        rows[..., :18] = -arm.by_axes(bodies, screws, places)
        # Of a small rotation vector: the left Jacobian of SO(3) is one to the square of a milliradian.
        turned = local @ by_base(p[18:21]).T
        for k in range(3):
            rows[..., 18 + k] = np.cross(np.eye(3)[k], turned)
            rows[..., k, 21 + k] = 1.0
        for t in range(reflectors):
            rows[:, t, :, 24 + 3 * t:27 + 3 * t] = -turn
        return rows.reshape(-1, len(p))

    start = np.concatenate([np.zeros(18), np.zeros(3), base[1] + middle, targets.ravel()])
    found = least_squares(residual, start, jacobian, method="lm", x_scale="jac", xtol=1e-10, ftol=1e-10)
    return found.x, base, middle, by_base(found.x[18:21])


def left(arm, fit, seen):
    """Of each reading, (n, t, 3)."""
    p, base, middle, turned = fit
    turn, shift = arm.motions(p)[0][-1]
    places = np.einsum("nij,tj->nti", turn, p[24:].reshape(-1, 3)) + shift[:, None]
    return (seen @ base[0].T - middle) @ turned.T + p[21:24] - places


folder = pathlib.Path(sys.argv[1])
campaign = ElementTree.parse(folder / "campaign.xml").getroot()
robot = campaign.find("robot")
axes, flange = arm_of(folder / robot.get("urdf"), robot.get("flange_link"))
names = [target.get("id") for target in campaign.find("targets")]
loading = pd.read_csv(folder / campaign.find("loading").get("file"))
states = pd.read_csv(folder / campaign.find("states").get("file"))
means = loading.groupby(["pose", "target"], sort=True)[["x_mm", "y_mm", "z_mm"]].mean()
seen = 1e-3 * np.stack([means.xs(name, level="target").to_numpy() for name in names], 1)
q = np.radians(states.sort_values("pose")[[f"q{j}_deg" for j in range(1, 7)]].to_numpy())


def rms(residuals):
    return float(np.sqrt((residuals ** 2).sum(-1).mean()))


whole = Arm(axes, q)
fit_of_all = fitted(whole, seen, flange)
held_out = np.empty_like(seen)
for fold in (0, 1):
    own = np.arange(len(q)) % 2 == fold
    of_others = fitted(Arm(axes, q[~own]), seen[~own], flange)
    held_out[own] = left(Arm(axes, q[own]), of_others, seen[own])
result = {"fitted_mm": 1e3 * rms(left(whole, fit_of_all, seen)), "held_out_mm": 1e3 * rms(held_out),
          "targets_m": fit_of_all[0][24:].reshape(-1, 3).tolist()}
pathlib.Path(sys.argv[2]).write_text(json.dumps(result))
