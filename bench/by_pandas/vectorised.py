"""All postures of a load step at once."""
import numpy as np
from arm import Posture, spring_torque, times
from campaign import Tables
from judged import HANGING_WITHIN, judged_joints, torque_variance
from student import influence_dof, load_dependence
from vectorised_studies import cartesian, outlying, subsets, torque_change_share


def squares(values):
    return (values ** 2).sum(axis=0)


class Step:
    """One load step's equations, A c = b, rows (n, 3 t, 6) and right (n, 3 t)."""

    def __init__(self, about, tables, base, s):
        self.about, self.base, self.q = about, base, tables.q
        self.wrench, self.moves = tables.wrench[s], tables.moves[s]
        self.right = self.moves.reshape(len(self.moves), -1)
        self.point = base.origin + base.rotation @ about.cell
        self.unloaded = base.places(about.targets)
        self.force, self.moment = self.directed(base.rotation)
        self.torque = base.torque(self.point, self.force, self.moment)
        self.rows = base.rows(self.unloaded, self.torque)

    def directed(self, rotation):
        return times(rotation, self.wrench[:, :3]), times(rotation, self.wrench[:, 3:])

    def solve(self, seen):
        return solve_normal(*self.normal(), seen)

    def normal(self):
        stacked = self.rows.reshape(-1, 6)
        return stacked.T @ stacked, stacked.T @ self.right.reshape(-1)

    def with_geometric_stiffness(self, compliance):
        geometric = self.base.geometric_stiffness(self.point, self.force, self.moment)
        return spring_torque(self.base.torque(self.point, self.force, self.moment), geometric, compliance)

    def settle(self, seen, rounds=2):
        """K_c, the wrench turned with the flange, the Jacobian at the middle of the displacement."""
        compliance = self.solve(seen)
        for _ in range(rounds):
            torque = self.with_geometric_stiffness(compliance)
            self.force, self.moment = self.directed(Posture(self.about.joints, self.q + compliance * torque).rotation)
            torque = self.with_geometric_stiffness(compliance)
            middle = Posture(self.about.joints, self.q + 0.5 * compliance * torque)
            self.rows = middle.rows(self.unloaded + 0.5 * self.moves, torque)
            compliance = self.solve(seen)
        return compliance


def solve_normal(normal, right, seen):
    compliance = np.zeros(6)
    scale = 1 / np.sqrt(np.diag(normal)[seen])
    compliance[seen] = scale * np.linalg.solve(normal[np.ix_(seen, seen)] * np.outer(scale, scale), scale * right[seen])
    return compliance


class Estimate:
    """Solved step with its uncertainty: CR2 influences, covariance, degrees of freedom by joint seen."""

    def __init__(self, step, seen):
        self.compliance = step.settle(seen)
        self.residual = step.right - times(step.rows, self.compliance)
        used, (normal, _) = step.rows[:, :, seen], step.normal()
        normal = normal[np.ix_(seen, seen)]
        root = np.linalg.cholesky(normal)
        back = np.linalg.inv(root)
        rows = back @ np.swapaxes(used, -1, -2)
        values, vectors = np.linalg.eigh(rows @ np.swapaxes(rows, -1, -2))
        corrected = (vectors / np.sqrt(1 - np.minimum(values, 0.95))[:, None, :]) @ np.swapaxes(vectors, -1, -2)
        gains = back.T @ corrected @ rows
        self.influences = times(gains, self.residual)
        self.covariance = self.influences.T @ self.influences
        own, through, inverse = (gains ** 2).sum(-1), gains @ used, back.T @ back
        self.dof = np.array([influence_dof(own[:, j], through[:, j], inverse) for j in range(int(seen.sum()))])
        self.sd = np.sqrt(np.diag(self.covariance))

    def describe(self, step, seen):
        stacked = step.rows.reshape(-1, 6)[:, seen]
        values = np.linalg.svd(np.linalg.qr(stacked / np.linalg.norm(stacked, axis=0), mode="r"), compute_uv=False)
        total = (self.residual ** 2).sum()
        return values[0] / values[-1], np.sqrt(total / self.residual.size), np.sqrt(total / (self.residual.size - seen.sum()))


def judge(step):
    about, base = step.about, step.base
    angle = np.arctan2(np.linalg.norm(np.cross(step.force, about.down), axis=1), step.force @ about.down)
    hangs = np.sqrt((angle ** 2).mean())
    down = about.down
    hanging = base.torque(step.point, np.outer(step.force @ down, down), step.moment - np.outer(step.moment @ down, down))
    variance = torque_variance(about, base.levers(step.point), base.axes, step.force, step.moment).sum(axis=0)
    torque, t = squares(step.torque), step.moves.shape[1]
    return judged_joints(len(step.q), (hangs < HANGING_WITHIN, hangs), torque,
                         squares(hanging) if hangs < HANGING_WITHIN else torque, variance,
                         squares(step.rows.reshape(-1, 6)), t * torque, step.normal()[0])


def estimate_only(about):
    """The heaviest step without K_c: what the shortest script would give."""
    tables = Tables(about)
    force = np.linalg.norm(tables.wrench[:, :, :3], axis=2).mean(1)
    return Step(about, tables, Posture(about.joints, tables.q), int(np.argmax(force)))


def identify(about, everything):
    tables = Tables(about)
    force = np.linalg.norm(tables.wrench[:, :, :3], axis=2).mean(1)
    base, heaviest = Posture(about.joints, tables.q), int(np.argmax(force))
    step = Step(about, tables, base, heaviest)
    seen, joints = judge(step)
    out = outlying(step, seen)
    solved = Estimate(step, seen)
    plain = Step(about, tables, base, heaviest)
    length = np.linalg.norm(step.moves, axis=2)
    left = np.linalg.norm(solved.residual.reshape(length.shape + (3,)), axis=2)
    found = {"poses": tables.poses.tolist(), "step": tables.steps[heaviest], "seen": seen, "joints": joints, "estimate": solved,
             "described": solved.describe(step, seen), "outlying": out, "subsets": subsets(step, seen), "moved": length.mean(1),
             "torque_change_share": torque_change_share(plain, solved.compliance), "left": left.mean(1),
             "compensated": 1 - left.sum() / length.sum(), "servo": np.degrees(np.abs(tables.servo[heaviest]).max())}
    if not everything:
        return found
    loaded = [s for s in np.argsort(force, kind="stable") if force[s] >= 0.05 * force.max()]
    steps = [solved if s == heaviest else Estimate(Step(about, tables, base, s), seen) for s in loaded]
    influences = np.stack([one.influences for one in steps])
    changes = [load_dependence(np.array([one.compliance[joint] for one in steps]), influences[:, :, j], [one.dof[j] for one in steps])
               for j, joint in enumerate(np.flatnonzero(seen))]
    return found | {"steps": [(tables.steps[s], force[s]) for s in loaded], "by_step": steps, "changes": changes,
                    "cartesian": cartesian(plain, solved.compliance)}
