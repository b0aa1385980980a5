"""All postures of a load step at once."""
import numpy as np
from arm import Posture, spring_torque, times
from campaign import Tables
from judged import HANGING_WITHIN, best_length, judged_joints, torque_variance
from student import influence_dof, load_dependence, outlier_tail, subset_plan


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


def outlying(step, seen):
    """Leave-one-posture-out: indices, F ratios and p values, the worst first."""
    rows, right, index, found = step.rows[:, :, seen], step.right, np.arange(len(step.right)), []
    unknowns, coordinates = int(seen.sum()), step.right.shape[1]
    while len(index) >= 5 and 2 * len(index) > len(step.right):
        f, p = leave_one_out(rows[index], right[index], unknowns, coordinates)
        worst = int(np.argmin(p))
        if p[worst] >= 0.001:
            break
        found.append((int(index[worst]), f[worst], p[worst]))
        index = np.delete(index, worst)
    return found


def leave_one_out(rows, right, unknowns, coordinates):
    stacked = rows.reshape(-1, unknowns)
    normal = stacked.T @ stacked
    residual = right - rows @ np.linalg.solve(normal, stacked.T @ right.reshape(-1))
    back = np.swapaxes(rows, -1, -2)
    others, others_right = normal - back @ rows, stacked.T @ residual.reshape(-1) - times(back, residual)
    inverse = np.linalg.inv(others)
    moved = times(inverse, others_right)
    deleted = residual - times(rows, moved)
    total = (residual ** 2).sum() - (residual ** 2).sum(1) - 2 * (moved * others_right).sum(1) + (moved * times(others, moved)).sum(1)
    columns = np.concatenate([rows, residual[..., None]], -1).reshape(len(rows), -1)
    size = unknowns + 1
    products = (columns.T @ columns).reshape(coordinates, size, coordinates, size).transpose(1, 3, 0, 2).reshape(size * size, -1)
    mix = np.concatenate([-moved, np.ones((len(rows), 1))], 1)
    moments = ((mix[:, :, None] * mix[:, None, :]).reshape(len(rows), -1) @ products).reshape(-1, coordinates, coordinates)
    moments = moments - deleted[:, :, None] * deleted[:, None, :]
    per_posture = np.maximum(1.0, np.trace(moments, axis1=1, axis2=2) ** 2 / (moments ** 2).sum((1, 2)))
    spread = np.eye(coordinates) + rows @ inverse @ back
    studentised = (deleted * np.linalg.solve(spread, deleted[..., None])[..., 0]).sum(1)
    left = (len(rows) - 1) * coordinates - unknowns
    f = studentised / coordinates / (total / left)
    return f, outlier_tail(f, per_posture, left, coordinates, len(rows))


def subsets(step, seen, seed=1):
    """Compliances of random subsets, and the share of the deflection compensated on those used, held out, all."""
    n, unknowns = len(step.right), int(seen.sum())
    size, count = subset_plan(n)
    rows, random = step.rows[:, :, seen], np.random.default_rng(seed)
    back = np.swapaxes(rows, -1, -2)
    normal, right = (back @ rows).reshape(n, -1), times(back, step.right)
    whole = np.linalg.norm(step.right.reshape(n, -1, 3), axis=2).sum(1)
    stacked, compliances, shares = rows.reshape(-1, unknowns), [], []
    for first in range(0, count, max(1, 200000 // n)):
        some = min(count - first, max(1, 200000 // n))
        used = np.zeros((some, n))
        np.put_along_axis(used, np.argpartition(random.random((some, n)), size, axis=1)[:, :size], 1.0, axis=1)
        solved = np.linalg.solve((used @ normal).reshape(some, unknowns, unknowns), (used @ right)[..., None])[..., 0]
        left = (step.right.reshape(-1, 1) - stacked @ solved.T).reshape(n, -1, 3, some)
        left = np.sqrt((left ** 2).sum(2)).sum(1).T
        left_used, whole_used = (used * left).sum(1), used @ whole
        left_all = left.sum(1)
        shares.append(np.stack([1 - left_used / whole_used, 1 - (left_all - left_used) / (whole.sum() - whole_used),
                                1 - left_all / whole.sum()], 1))
        compliances.append(solved)
    return size, np.concatenate(compliances), np.concatenate(shares)


def cartesian(step, compliance):
    """Stiffness of the flange by posture, with and without K_c: kappas, principal stiffnesses, K_c's shares and cost."""
    base = step.base
    jacobian = base.jacobian(base.origin)
    upper, lower = jacobian[:, :3].reshape(-1, 6), jacobian[:, 3:].reshape(-1, 6)
    linear, angular = [np.einsum("nij,nik->jk", part, part) for part in (jacobian[:, :3], jacobian[:, 3:])]
    scaled = jacobian.copy()
    scaled[:, :3] /= best_length(linear, angular)
    values = np.linalg.svd(scaled, compute_uv=False)
    geometric = base.geometric_stiffness(step.point, step.force, step.moment)
    springs = np.linalg.solve(np.eye(6) - compliance[:, None] * geometric, np.broadcast_to(np.diag(compliance), geometric.shape))
    moving, back = jacobian[:, :3], np.swapaxes(jacobian[:, :3], -1, -2)
    with_kc, without = moving @ springs @ back, (moving * compliance) @ back
    change = spring_torque(step.torque, geometric, compliance)
    cost, whole = [np.linalg.norm(times(base.rows(step.unloaded, one), compliance).reshape(len(jacobian), -1, 3), axis=2)
                   for one in (change - step.torque, change)]
    return {"kappa": np.linalg.norm(values, axis=1) * np.linalg.norm(1 / values, axis=1) / 6,
            "kappa_2_norm": values[:, 0] / values[:, -1], "k_x": principal(with_kc), "k_x_without_kc": principal(without),
            "kc_share": np.linalg.norm(with_kc - without, axis=(1, 2)) / np.linalg.norm(without, axis=(1, 2)),
            "k_c_cost_um": 1e6 * cost.mean(1), "k_c_cost_share": cost.sum(1) / whole.sum(1),
            "torque_change_share": np.sqrt(((change - step.torque) ** 2).sum() / (step.torque ** 2).sum())}


def principal(compliance):
    """Stiffnesses (n, 3), the softest first, and directions (n, 3, 3), the largest component positive."""
    values, vectors = np.linalg.eigh(0.5 * (compliance + np.swapaxes(compliance, -1, -2)))
    directions = np.swapaxes(vectors[:, :, ::-1], -1, -2)
    largest = np.take_along_axis(directions, np.abs(directions).argmax(-1)[..., None], -1)
    return 1 / values[:, ::-1], directions * np.sign(largest)


def estimate_only(about):
    """The heaviest step without K_c: what the shortest script would give."""
    tables = Tables(about)
    force = np.linalg.norm(tables.wrench[:, :, :3], axis=2).mean(1)
    return Step(about, tables, Posture(about.joints, tables.q), int(np.argmax(force)))


def identify(about):
    tables = Tables(about)
    force = np.linalg.norm(tables.wrench[:, :, :3], axis=2).mean(1)
    base, heaviest = Posture(about.joints, tables.q), int(np.argmax(force))
    step = Step(about, tables, base, heaviest)
    seen, joints = judge(step)
    out = outlying(step, seen)
    solved = Estimate(step, seen)
    plain = Step(about, tables, base, heaviest)
    loaded = [s for s in np.argsort(force, kind="stable") if force[s] >= 0.05 * force.max()]
    steps = [solved if s == heaviest else Estimate(Step(about, tables, base, s), seen) for s in loaded]
    influences = np.stack([one.influences for one in steps])
    changes = [load_dependence(np.array([one.compliance[joint] for one in steps]), influences[:, :, j], [one.dof[j] for one in steps])
               for j, joint in enumerate(np.flatnonzero(seen))]
    length = np.linalg.norm(step.moves, axis=2)
    left = np.linalg.norm(solved.residual.reshape(length.shape + (3,)), axis=2)
    return {"poses": tables.poses.tolist(), "step": tables.steps[heaviest], "seen": seen, "joints": joints, "estimate": solved,
            "described": solved.describe(step, seen), "steps": [(tables.steps[s], force[s]) for s in loaded], "by_step": steps,
            "changes": changes, "outlying": out, "subsets": subsets(step, seen), "cartesian": cartesian(plain, solved.compliance),
            "moved": length.mean(1), "left": left.mean(1), "compensated": 1 - left.sum() / length.sum(),
            "servo": np.degrees(np.abs(tables.servo[heaviest]).max())}
