"""Reading of a campaign with `displacements` in base_link and a wrench at the flange: campaign.xml, URDF, two tables."""
import hashlib
import xml.etree.ElementTree as ElementTree
import numpy as np
import pandas as pd
from arm import chain, numbers

ANGLES = [f"q{i}_deg" for i in range(1, 7)]
WRENCH = ["fx_n", "fy_n", "fz_n", "mx_nm", "my_nm", "mz_nm"]
MOVES = ["dx_mm", "dy_mm", "dz_mm"]


class Description:
    """What campaign.xml and the URDF say."""

    def __init__(self, folder):
        root = ElementTree.parse(folder / "campaign.xml").getroot()
        robot, cell, displacements = root.find("robot"), root.find("load_cell"), root.find("displacements")
        if displacements.get("frame") != "base_link" or cell.get("parent") != robot.get("flange_link") or numbers(cell.get("rpy_deg")).any():
            raise SystemExit("only displacements in base_link and a load cell parallel to the flange")
        self.joints = chain(folder / robot.get("urdf"), robot.get("base_link"), robot.get("flange_link"))
        self.cell = 1e-3 * numbers(cell.get("xyz_mm"))
        self.force_sigma, self.moment_sigma = float(cell.get("force_sigma_n")), float(cell.get("moment_sigma_nm"))
        self.target_names = [t.get("id") for t in root.find("targets")]
        self.targets = np.array([[1e-3 * float(t.get(f"{a}_mm")) for a in "xyz"] for t in root.find("targets")])
        self.files = ["campaign.xml", robot.get("urdf"), root.find("states").get("file"), displacements.get("file")]
        self.states, self.displacements = folder / self.files[2], folder / self.files[3]
        self.down = np.array([0.0, 0.0, -1.0])

    def hashes(self, folder):
        return [{"file": name, "sha256": hashlib.sha256((folder / name).read_bytes()).hexdigest()} for name in self.files]


def check(condition, what):
    if not condition:
        raise SystemExit(what)


class Tables:
    """Arrays by step and posture: q (n, 6) of step 0 and servo (s, n, 6) in rad, wrench (s, n, 6), moves (s, n, t, 3) in m."""

    def __init__(self, about):
        states, moves = pd.read_csv(about.states), pd.read_csv(about.displacements)
        for table, key in ((states, ["step", "pose"]), (moves, ["step", "pose", "target"])):
            check(not table.duplicated(key).any(), f"a key of {key} is there twice")
            check(np.isfinite(table[[c for c in table if c not in key]].to_numpy()).all(), "a value is not finite")
        check(moves.target.isin(about.target_names).all(), "unknown target")
        states = states.sort_values(["step", "pose"], kind="stable")
        moves["target"] = pd.Categorical(moves.target, about.target_names)
        moves = moves.sort_values(["step", "pose", "target"], kind="stable")
        self.poses, self.steps = np.unique(states.pose), np.unique(states.step)[1:].tolist()
        n, s, t = len(self.poses), len(self.steps), len(about.target_names)
        check(len(states) == n * (s + 1) and len(moves) == n * s * t, "a posture lacks a step or a target")
        angles = np.radians(states[ANGLES].to_numpy()).reshape(s + 1, n, 6)
        self.q, self.servo = angles[0], angles[1:] - angles[0]
        self.wrench = states[WRENCH].to_numpy().reshape(s + 1, n, 6)[1:]
        self.moves = 1e-3 * moves[MOVES].to_numpy().reshape(s, n, t, 3)


class Rows:
    """The same read row by row into dictionaries: angles and wrenches by (step, pose), moves by (step, pose, target)."""

    def __init__(self, about):
        self.angles, self.wrench, self.moves, self.poses = {}, {}, {}, []
        for row in pd.read_csv(about.states).itertuples(index=False):
            key = (row.step, row.pose)
            values = np.array(row[3:], dtype=float)
            check(key not in self.angles and np.isfinite(values).all(), f"{key}: twice, or not finite")
            self.angles[key], self.wrench[key] = np.radians(values[:6]), values[6:]
            if row.step == 0:
                self.poses.append(row.pose)
        self.steps = sorted({step for step, _ in self.angles} - {0})
        for row in pd.read_csv(about.displacements).itertuples(index=False):
            key = (row.step, row.pose, row.target)
            check(key not in self.moves and row.target in about.target_names, f"{key}: twice, or not known")
            self.moves[key] = 1e-3 * np.array(row[3:], dtype=float)
            check(np.isfinite(self.moves[key]).all(), f"{key}: not finite")

    def moves_of(self, about, step, pose):
        return np.array([self.moves[step, pose, name] for name in about.target_names])
