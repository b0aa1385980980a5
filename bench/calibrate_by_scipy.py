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


def rotation(axes, angles):
    """(n, 3, 3) about one axis (3,) by angles (n,)."""
    x, y, z = axes
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angles)[:, None, None] * cross + (1 - np.cos(angles))[:, None, None] * (cross @ cross)


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


class Arm:
    """Parameters: of axes 2 to 6 two shifts and two tilts across each, without what is a choice of frame (axis 1 all; axis 2
    along and about axis 1); rotation vector and shift of base from tracker; reflectors with all joints at zero."""

    def __init__(self, axes, q):
        self.q, self.points, self.directions = q, [p for p, _ in axes], [d / np.linalg.norm(d) for _, d in axes]
        first = self.directions[0]
        self.across = []
        for d in self.directions:
            u = first - (first @ d) * d
            if np.linalg.norm(u) < 0.1:
                u = np.cross(d, np.eye(3)[np.argmin(abs(d))])
            u = u / np.linalg.norm(u)
            self.across.append((u, np.cross(d, u)))
        # shift u, shift v, tilt to u, tilt to v: u of axis 2 is along axis 1, and a tilt to v turns about it.
        self.free = [k for k in range(24) if k not in (0, 1, 2, 3, 4, 7)]

    def motions(self, p):
        """Rotations (n, 3, 3), translations (n, 3) of each body from where it stands at zero, the axes, the small motions."""
        steps = np.zeros(24)
        steps[self.free] = p[:18]
        count = len(self.q)
        turn, shift = np.broadcast_to(np.eye(3), (count, 3, 3)), np.zeros((count, 3))
        bodies, screws = [(turn, shift)], []
        for j, (u, v) in enumerate(self.across):
            by = steps[4 * j:4 * j + 4]
            point = self.points[j] + by[0] * u + by[1] * v
            whole = self.directions[j] + by[2] * u + by[3] * v
            length = np.linalg.norm(whole)
            direction = whole / length
            own = rotation(direction, self.q[:, j])
            shift = shift + turn @ point - (turn @ own) @ point
            turn = turn @ own
            bodies.append((turn, shift))
            tilts = [np.cross(direction, w) / length for w in (u, v)]
            screws += [(np.zeros(3), u), (np.zeros(3), v)] + [(w, -np.cross(w, point)) for w in tilts]
        return bodies, screws

    def by_axes(self, bodies, screws, places):
        """Derivatives of places (n, t, 3) by the free axis parameters, (n, t, 3, 18)."""
        columns = []
        for k in self.free:
            rotations, shifts = 0.0, 0.0
            for sign, (turn, shift) in ((1, bodies[k // 4]), (-1, bodies[k // 4 + 1])):
                turned = turn @ screws[k][0]
                rotations = rotations + sign * turned
                shifts = shifts + sign * (turn @ screws[k][1] - np.cross(turned, shift))
            columns.append(np.cross(rotations[:, None], places) + shifts[:, None])
        return np.stack(columns, -1)


def registered(points, places):
    """Rotation and translation that bring points onto places."""
    a, b = points.mean(0), places.mean(0)
    left, _, right = np.linalg.svd((places - b).T @ (points - a))
    turn = left @ np.diag([1, 1, np.linalg.det(left @ right)]) @ right
    return turn, b - turn @ a


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
