"""Outlying postures, random subsets and Cartesian stiffness, one posture after the other."""
import random
import numpy as np
from arm import spring_torque
from judged import best_length
from student import outlier_tail, subset_plan


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
    with_kc, without_kc = [], []
    for case, jacobian in zip(step.cases, jacobians):
        values = np.linalg.svd(np.vstack([jacobian[:3] / length, jacobian[3:]]), compute_uv=False)
        geometric, moving = case.geometric_stiffness(), jacobian[:3]
        springs = np.linalg.solve(np.eye(6) - compliance[:, None] * geometric, np.diag(compliance))
        one, other = moving @ springs @ moving.T, moving * compliance @ moving.T
        change = spring_torque(case.torque, geometric, compliance)
        cost, whole = [np.linalg.norm((case.base.rows(case.unloaded, t) @ compliance).reshape(-1, 3), axis=1)
                       for t in (change - case.torque, change)]
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
    return found


def torque_change_share(step, compliance):
    """Root mean square change of the joint torques by K_c."""
    changed, whole = 0.0, 0.0
    for case in step.cases:
        changed += ((case.with_geometric_stiffness(compliance) - case.torque) ** 2).sum()
        whole += (case.torque ** 2).sum()
    return np.sqrt(changed / whole)


def principal(compliance):
    """Stiffnesses, the softest first, and directions, the largest component positive."""
    values, vectors = np.linalg.eigh(0.5 * (compliance + compliance.T))
    directions = [d if d[np.argmax(np.abs(d))] > 0 else -d for d in vectors.T[::-1]]
    return 1 / values[::-1], directions
