"""One posture after the other, a loop for every sum; numpy for each small matrix."""
import random
import numpy as np
from arm import Posture, spring_torque
from campaign import Rows
from judged import HANGING_WITHIN, best_length, judged_joints, torque_variance
from student import influence_dof, load_dependence, outlier_tail, subset_plan


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


def outlying(step, seen):
    """Leave-one-posture-out: indices, F ratios and p values, the worst first."""
    left, found = list(range(len(step.cases))), []
    while len(left) >= 5 and 2 * len(left) > len(step.cases):
        judged = leave_one_out([(step.cases[p].rows[:, seen], step.cases[p].right) for p in left])
        worst = min(range(len(left)), key=lambda k: judged[k][1])
        if judged[worst][1] >= 0.001:
            break
        found.append((left.pop(worst), *judged[worst]))
    return found


def leave_one_out(equations):
    """F ratio and p value of each posture against the fit to the others."""
    coordinates, unknowns = equations[0][0].shape
    normal, right = sum(a.T @ a for a, _ in equations), sum(a.T @ b for a, b in equations)
    compliance = np.linalg.solve(normal, right)
    residuals = [b - a @ compliance for a, b in equations]
    right = sum(a.T @ r for (a, _), r in zip(equations, residuals))
    whole = sum(r @ r for r in residuals)
    products = np.zeros((coordinates * (unknowns + 1),) * 2)
    for (a, _), r in zip(equations, residuals):
        columns = np.column_stack([a, r]).reshape(-1)
        products += np.outer(columns, columns)
    products = products.reshape(coordinates, unknowns + 1, coordinates, unknowns + 1)
    judged = []
    for (a, _), r in zip(equations, residuals):
        others, others_right = normal - a.T @ a, right - a.T @ r
        inverse = np.linalg.inv(others)
        moved = inverse @ others_right
        deleted = r - a @ moved
        total = whole - r @ r - 2 * moved @ others_right + moved @ others @ moved
        mix = np.append(-moved, 1.0)
        moments = products @ mix
        moments = np.swapaxes(moments, 1, 2) @ mix - np.outer(deleted, deleted)
        per_posture = max(1.0, np.trace(moments) ** 2 / (moments ** 2).sum())
        studentised = deleted @ np.linalg.solve(np.eye(coordinates) + a @ inverse @ a.T, deleted)
        left = (len(equations) - 1) * coordinates - unknowns
        f = studentised / coordinates / (total / left)
        judged.append((f, float(outlier_tail(f, per_posture, left, coordinates, len(equations)))))
    return judged


def subsets(step, seen, seed=1):
    """Compliances of random subsets, and the share of the deflection compensated on those used, held out, all."""
    n, draws = len(step.cases), random.Random(seed)
    size, count = subset_plan(n)
    rows = [case.rows[:, seen] for case in step.cases]
    normals = [(a.T @ a, a.T @ case.right) for a, case in zip(rows, step.cases)]
    moved = [np.sqrt((case.moves ** 2).sum(axis=1)).sum() for case in step.cases]
    compliances, shares = [], []
    for _ in range(count):
        used = set(draws.sample(range(n), size))
        normal, right = np.zeros_like(normals[0][0]), np.zeros_like(normals[0][1])
        for p in used:
            normal += normals[p][0]
            right += normals[p][1]
        compliance = np.linalg.solve(normal, right)
        left, whole = [0.0, 0.0], [0.0, 0.0]
        for p, case in enumerate(step.cases):
            residual = (case.right - rows[p] @ compliance).reshape(-1, 3)
            left[p in used] += np.sqrt((residual ** 2).sum(axis=1)).sum()
            whole[p in used] += moved[p]
        compliances.append(compliance)
        shares.append((1 - left[1] / whole[1], 1 - left[0] / whole[0], 1 - sum(left) / sum(whole)))
    return size, np.array(compliances), np.array(shares)


def cartesian(step, compliance):
    """Stiffness of the flange by posture, with and without K_c: kappas, principal stiffnesses, K_c's shares and cost."""
    jacobians = [case.base.jacobian(case.base.origin) for case in step.cases]
    length = best_length(sum(j[:3].T @ j[:3] for j in jacobians), sum(j[3:].T @ j[3:] for j in jacobians))
    columns = {name: [] for name in ("kappa", "kappa_2_norm", "kc_share", "k_c_cost_um", "k_c_cost_share")}
    with_kc, without_kc, changed, plain_torque = [], [], 0.0, 0.0
    for case, jacobian in zip(step.cases, jacobians):
        values = np.linalg.svd(np.vstack([jacobian[:3] / length, jacobian[3:]]), compute_uv=False)
        geometric, moving = case.geometric_stiffness(), jacobian[:3]
        springs = np.linalg.solve(np.eye(6) - compliance[:, None] * geometric, np.diag(compliance))
        one, other = moving @ springs @ moving.T, moving * compliance @ moving.T
        change = spring_torque(case.torque, geometric, compliance)
        cost, whole = [np.linalg.norm((case.base.rows(case.unloaded, t) @ compliance).reshape(-1, 3), axis=1)
                       for t in (change - case.torque, change)]
        changed += ((change - case.torque) ** 2).sum()
        plain_torque += (case.torque ** 2).sum()
        columns["kappa"].append(np.linalg.norm(values) * np.linalg.norm(1 / values) / 6)
        columns["kappa_2_norm"].append(values[0] / values[-1])
        columns["kc_share"].append(np.linalg.norm(one - other) / np.linalg.norm(other))
        columns["k_c_cost_um"].append(1e6 * cost.mean())
        columns["k_c_cost_share"].append(cost.sum() / whole.sum())
        with_kc.append(principal(one))
        without_kc.append(principal(other))
    found = {name: np.array(values) for name, values in columns.items()}
    for name, values in (("k_x", with_kc), ("k_x_without_kc", without_kc)):
        found[name] = np.array([k for k, _ in values]), np.array([d for _, d in values])
    found["torque_change_share"] = np.sqrt(changed / plain_torque)
    return found


def principal(compliance):
    """Stiffnesses, the softest first, and directions, the largest component positive."""
    values, vectors = np.linalg.eigh(0.5 * (compliance + compliance.T))
    directions = [d if d[np.argmax(np.abs(d))] > 0 else -d for d in vectors.T[::-1]]
    return 1 / values[::-1], directions


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


def identify(about):
    tables = Rows(about)
    force = mean_forces(tables)
    heaviest = max(force, key=force.get)
    bases = {pose: Posture(about.joints, tables.angles[0, pose]) for pose in tables.poses}
    step = Step(about, tables, bases, heaviest)
    seen, joints = judge(step)
    out = outlying(step, seen)
    solved = Estimate(step, seen)
    loaded = sorted((s for s in force if force[s] >= 0.05 * force[heaviest]), key=force.get)
    steps = [solved if s == heaviest else Estimate(Step(about, tables, bases, s), seen) for s in loaded]
    changes = []
    for j, joint in enumerate(np.flatnonzero(seen)):
        influences = np.array([one.influences[:, j] for one in steps])
        changes.append(load_dependence(np.array([one.compliance[joint] for one in steps]), influences, [one.dof[j] for one in steps]))
    moved, left, servo = [], [], 0.0
    for case, residual, pose in zip(step.cases, solved.residual, tables.poses):
        moved.append(np.linalg.norm(case.moves, axis=1).mean())
        left.append(np.linalg.norm(residual.reshape(-1, 3), axis=1).mean())
        servo = max(servo, np.abs(tables.angles[heaviest, pose] - tables.angles[0, pose]).max())
    return {"poses": tables.poses, "step": heaviest, "seen": seen, "joints": joints, "estimate": solved,
            "described": solved.describe(step, seen), "steps": [(s, force[s]) for s in loaded], "by_step": steps, "changes": changes,
            "outlying": out, "subsets": subsets(step, seen),
            "cartesian": cartesian(Step(about, tables, bases, heaviest), solved.compliance), "moved": np.array(moved),
            "left": np.array(left), "compensated": 1 - sum(left) / sum(moved), "servo": np.degrees(servo)}
