#!/usr/bin/env python3
"""identify_by_pandas.py vectorised|plain CAMPAIGN [JOINTS]: what `stiffscope identify CAMPAIGN --method pp --neglect-kc`
estimates, as one would write it with pandas and numpy: read the tables, take the heaviest load step, forward kinematics,
Jacobians of the reflectors and of the load cell, A_j = J_m,j (J_w^T W)_j, least squares over JOINTS (default 23456). For
campaigns with `displacements` in base_link and a wrench at the flange. `plain` loops over the postures, numpy for each.
Only the estimate: no uncertainties, subsets, identifiability, outliers, load steps or checks of the input. Prints
k1..k6 in Nm/rad."""
import pathlib, sys
import xml.etree.ElementTree as ElementTree
import numpy as np
import pandas as pd

ANGLES = [f"q{i}_deg" for i in range(1, 7)]
WRENCH = ["fx_n", "fy_n", "fz_n", "mx_nm", "my_nm", "mz_nm"]


def numbers(text):
    return np.array([float(word) for word in text.split()])


def rpy(angles):
    (sr, sp, sy), (cr, cp, cy) = np.sin(angles), np.cos(angles)
    return np.array([[cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
                     [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr], [-sp, cp * sr, cp * cr]])


def chain(urdf, base, tip):
    """Joints from base to tip: rotation and translation of each, its axis (None: fixed)."""
    by_child = {j.find("child").get("link"): j for j in ElementTree.parse(urdf).getroot().iter("joint") if j.find("child") is not None}
    joints = []
    while tip != base:
        joint = by_child[tip]
        origin = joint.find("origin")
        at = {} if origin is None else origin.attrib
        axis = joint.find("axis")
        joints.insert(0, (rpy(numbers(at.get("rpy", "0 0 0"))), numbers(at.get("xyz", "0 0 0")),
                          None if joint.get("type") == "fixed" else numbers(axis.get("xyz"))))
        tip = joint.find("parent").get("link")
    return joints


def turned(axis, angle):
    """Rodrigues; angle a number or n of them."""
    angle = np.asarray(angle)[..., None, None]
    k = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * (k @ k)


def arm(joints, q):
    """Rotation and origin of the flange, axes and points of the joints; leading dimensions as q's."""
    rotation, origin = np.broadcast_to(np.eye(3), q.shape[:-1] + (3, 3)), np.zeros(q.shape[:-1] + (3,))
    axes, points, i = [], [], 0
    for turn, step, axis in joints:
        origin = origin + rotation @ step
        rotation = rotation @ turn
        if axis is None:
            continue
        axis = axis / np.linalg.norm(axis)
        axes.append(rotation @ axis)
        points.append(origin)
        rotation = rotation @ turned(axis, q[..., i])
        i += 1
    return rotation, origin, np.stack(axes, -2), np.stack(points, -2)


def rows_of(joints, q, wrench, cell, targets):
    """A of the targets, leading dimensions + (targets, 3, 6)."""
    rotation, origin, axes, points = arm(joints, q)
    force = np.einsum("...ij,...j->...i", rotation, wrench[..., :3])
    moment = np.einsum("...ij,...j->...i", rotation, wrench[..., 3:])
    where = origin + rotation @ cell
    lever = np.cross(axes, where[..., None, :] - points)
    torque = np.einsum("...ji,...i->...j", lever, force) + np.einsum("...ji,...i->...j", axes, moment)
    places = origin[..., None, :] + np.einsum("...ij,tj->...ti", rotation, targets)
    columns = np.cross(axes[..., None, :, :], places[..., :, None, :] - points[..., None, :, :])
    return np.swapaxes(columns * torque[..., None, :, None], -1, -2)


def read(folder):
    campaign = ElementTree.parse(folder / "campaign.xml").getroot()
    robot, cell = campaign.find("robot"), campaign.find("load_cell")
    joints = chain(folder / robot.get("urdf"), robot.get("base_link"), robot.get("flange_link"))
    targets = {t.get("id"): 1e-3 * np.array([float(t.get(f"{a}_mm")) for a in "xyz"]) for t in campaign.find("targets")}
    states = pd.read_csv(folder / campaign.find("states").get("file"))
    displacements = pd.read_csv(folder / campaign.find("displacements").get("file"))
    return joints, 1e-3 * numbers(cell.get("xyz_mm")), targets, states, displacements


def vectorised(folder, unknown):
    joints, cell, targets, states, displacements = read(folder)
    force = np.sqrt((states[WRENCH[:3]].to_numpy() ** 2).sum(axis=1))
    step = pd.Series(force).groupby(states.step.to_numpy()).mean().idxmax()
    states = states[states.step == step].set_index("pose")
    table = displacements[displacements.step == step].pivot(index="pose", columns="target", values=["dx_mm", "dy_mm", "dz_mm"])
    states = states.loc[table.index]
    names = list(targets)
    right = 1e-3 * np.stack([table[d][names].to_numpy() for d in ("dx_mm", "dy_mm", "dz_mm")], -1)
    matrix = rows_of(joints, np.radians(states[ANGLES].to_numpy()), states[WRENCH].to_numpy(), cell,
                     np.array([targets[name] for name in names]))
    matrix = matrix.reshape(-1, 6)[:, unknown]
    return np.linalg.lstsq(matrix, right.reshape(-1), rcond=None)[0]


def plain(folder, unknown):
    joints, cell, targets, states, displacements = read(folder)
    forces = {}
    for _, state in states.iterrows():
        forces.setdefault(state["step"], []).append(np.linalg.norm(state[WRENCH[:3]].to_numpy(dtype=float)))
    step = max(forces, key=lambda s: np.mean(forces[s]))
    loaded = {}
    for _, row in displacements[displacements.step == step].iterrows():
        loaded.setdefault(row["pose"], []).append(row)
    normal, right = np.zeros((6, 6)), np.zeros(6)
    for _, state in states[states.step == step].iterrows():
        moved = loaded[state["pose"]]
        matrix = rows_of(joints, np.radians(state[ANGLES].to_numpy(dtype=float)), state[WRENCH].to_numpy(dtype=float), cell,
                         np.array([targets[row["target"]] for row in moved])).reshape(-1, 6)
        b = 1e-3 * np.concatenate([[row["dx_mm"], row["dy_mm"], row["dz_mm"]] for row in moved])
        normal += matrix.T @ matrix
        right += matrix.T @ b
    return np.linalg.solve(normal[np.ix_(unknown, unknown)], right[unknown])


if __name__ == "__main__":
    how, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    unknown = [int(digit) - 1 for digit in (sys.argv[3] if len(sys.argv) > 3 else "23456")]
    stiffness = np.full(6, np.nan)
    stiffness[unknown] = 1.0 / {"vectorised": vectorised, "plain": plain}[how](folder, unknown)
    print(" ".join(f"{k:.9g}" for k in stiffness))
