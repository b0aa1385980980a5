"""One posture after the other, a loop for every sum; numpy for each small matrix."""
import numpy as np
from arm import Posture, spring_torque
from campaign import Rows
from judged import HANGING_WITHIN, judged_joints, torque_variance
from plain_studies import cartesian, outlying, subsets, torque_change_share
from student import influence_dof, load_dependence


class Case:
    """One posture under one load: A c = b, rows (3 t, 6) and right (3 t)."""

    def __init__(self, about, tables, base, step, pose):
        self.about, self.base, self.q = about, base, tables.angles[0, pose]
        self.wrench, self.moves = tables.wrench[step, pose], tables.moves_of(about, step, pose)
        self.right = self.moves.reshape(-1)
        self.point = base.origin + base.rotation @ about.cell
        self.unloaded = base.places(about.targets)
        self.turn(base.rotation)
        self.torque = base.torque(self.point, self.force, self.moment)
        self.rows = base.rows(self.unloaded, self.torque)

    def turn(self, rotation):
        self.force, self.moment = rotation @ self.wrench[:3], rotation @ self.wrench[3:]

    def geometric_stiffness(self):
        return self.base.geometric_stiffness(self.point, self.force, self.moment)

    def with_geometric_stiffness(self, compliance):
        torque = self.base.torque(self.point, self.force, self.moment)
        return spring_torque(torque, self.geometric_stiffness(), compliance)

    def bend(self, compliance):
        torque = self.with_geometric_stiffness(compliance)
        self.turn(Posture(self.about.joints, self.q + compliance * torque).rotation)
        torque = self.with_geometric_stiffness(compliance)
        middle = Posture(self.about.joints, self.q + 0.5 * compliance * torque)
        self.rows = middle.rows(self.unloaded + 0.5 * self.moves, torque)


class Step:
    """All cases of one load step."""

    def __init__(self, about, tables, bases, step):
        self.about = about
        self.cases = [Case(about, tables, bases[pose], step, pose) for pose in tables.poses]

    def normal(self):
        normal, right = np.zeros((6, 6)), np.zeros(6)
        for case in self.cases:
            normal += case.rows.T @ case.rows
            right += case.rows.T @ case.right
        return normal, right

    def solve(self, seen):
        normal, right = self.normal()
        compliance = np.zeros(6)
        scale = 1 / np.sqrt(np.diag(normal)[seen])
        compliance[seen] = scale * np.linalg.solve(normal[np.ix_(seen, seen)] * np.outer(scale, scale), scale * right[seen])
        return compliance

    def settle(self, seen, rounds=2):
        compliance = self.solve(seen)
        for _ in range(rounds):
            for case in self.cases:
                case.bend(compliance)
            compliance = self.solve(seen)
        return compliance


class Estimate:
    """Solved step with its uncertainty: CR2 influences, covariance, degrees of freedom by joint seen."""

    def __init__(self, step, seen):
        self.compliance = step.settle(seen)
        normal = step.normal()[0][np.ix_(seen, seen)]
        unknowns = int(seen.sum())
        back = np.linalg.inv(np.linalg.cholesky(normal))
        self.residual, influences, own, through = [], [], [], []
        self.covariance = np.zeros((unknowns, unknowns))
        for case in step.cases:
            used = case.rows[:, seen]
            rows = back @ used.T
            values, vectors = np.linalg.eigh(rows @ rows.T)
            gain = back.T @ (vectors / np.sqrt(1 - np.minimum(values, 0.95))) @ vectors.T @ rows
            residual = case.right - case.rows @ self.compliance
            influence = gain @ residual
            self.covariance += np.outer(influence, influence)
            self.residual.append(residual)
            influences.append(influence)
            own.append((gain ** 2).sum(axis=1))
            through.append(gain @ used)
        self.influences, own, through = np.array(influences), np.array(own), np.array(through)
        self.dof = np.array([influence_dof(own[:, j], through[:, j], back.T @ back) for j in range(unknowns)])
        self.sd = np.sqrt(np.diag(self.covariance))

    def describe(self, step, seen):
        stacked = np.concatenate([case.rows[:, seen] for case in step.cases])
        residual = np.concatenate(self.residual)
        total = residual @ residual
        condition = np.linalg.cond(stacked / np.linalg.norm(stacked, axis=0))
        return condition, np.sqrt(total / residual.size), np.sqrt(total / (residual.size - seen.sum()))


def judge(step):
    about, angles = step.about, []
    torque, trusted, variance, columns, weights = (np.zeros(6) for _ in range(5))
    for case in step.cases:
        angles.append(np.arctan2(np.linalg.norm(np.cross(case.force, about.down)), case.force @ about.down))
    hangs = np.sqrt(np.mean(np.array(angles) ** 2))
    for case in step.cases:
        base, down = case.base, about.down
        hanging = case.torque
        if hangs < HANGING_WITHIN:
            hanging = base.torque(case.point, down * (case.force @ down), case.moment - down * (case.moment @ down))
        torque += case.torque ** 2
        trusted += hanging ** 2
        variance += torque_variance(about, base.levers(case.point), base.axes, case.force, case.moment)
        columns += (case.rows ** 2).sum(axis=0)
        weights += case.torque ** 2 * len(case.moves)
    return judged_joints(len(step.cases), (hangs < HANGING_WITHIN, hangs), torque, trusted, variance, columns, weights,
                         step.normal()[0])


def mean_forces(tables):
    forces = {step: [] for step in tables.steps}
    for (step, _), wrench in tables.wrench.items():
        if step in forces:
            forces[step].append(np.linalg.norm(wrench[:3]))
    return {step: np.mean(of) for step, of in forces.items()}


def estimate_only(about):
    """The heaviest step without K_c: what the shortest script would give."""
    tables = Rows(about)
    force = mean_forces(tables)
    bases = {pose: Posture(about.joints, tables.angles[0, pose]) for pose in tables.poses}
    return Step(about, tables, bases, max(force, key=force.get))


def identify(about, everything):
    tables = Rows(about)
    force = mean_forces(tables)
    heaviest = max(force, key=force.get)
    bases = {pose: Posture(about.joints, tables.angles[0, pose]) for pose in tables.poses}
    step = Step(about, tables, bases, heaviest)
    seen, joints = judge(step)
    out = outlying(step, seen)
    solved = Estimate(step, seen)
    moved, left, servo = [], [], 0.0
    for case, residual, pose in zip(step.cases, solved.residual, tables.poses):
        moved.append(np.linalg.norm(case.moves, axis=1).mean())
        left.append(np.linalg.norm(residual.reshape(-1, 3), axis=1).mean())
        servo = max(servo, np.abs(tables.angles[heaviest, pose] - tables.angles[0, pose]).max())
    plain = Step(about, tables, bases, heaviest)
    found = {"poses": tables.poses, "step": heaviest, "seen": seen, "joints": joints, "estimate": solved,
             "described": solved.describe(step, seen), "outlying": out, "subsets": subsets(step, seen), "moved": np.array(moved),
             "torque_change_share": torque_change_share(plain, solved.compliance), "left": np.array(left),
             "compensated": 1 - sum(left) / sum(moved), "servo": np.degrees(servo)}
    if not everything:
        return found
    loaded = sorted((s for s in force if force[s] >= 0.05 * force[heaviest]), key=force.get)
    steps = [solved if s == heaviest else Estimate(Step(about, tables, bases, s), seen) for s in loaded]
    changes = []
    for j, joint in enumerate(np.flatnonzero(seen)):
        influences = np.array([one.influences[:, j] for one in steps])
        changes.append(load_dependence(np.array([one.compliance[joint] for one in steps]), influences, [one.dof[j] for one in steps]))
    return found | {"steps": [(s, force[s]) for s in loaded], "by_step": steps, "changes": changes,
                    "cartesian": cartesian(plain, solved.compliance)}
