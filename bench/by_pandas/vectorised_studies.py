"""Outlying postures, random subsets and Cartesian stiffness, all postures at once."""
import numpy as np
from arm import spring_torque, times
from judged import best_length
from student import outlier_tail, subset_plan


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
            "k_c_cost_um": 1e6 * cost.mean(1), "k_c_cost_share": cost.sum(1) / whole.sum(1)}


def torque_change_share(step, compliance):
    """Root mean square change of the joint torques by K_c."""
    change = step.with_geometric_stiffness(compliance) - step.torque
    return np.sqrt((change ** 2).sum() / (step.torque ** 2).sum())


def principal(compliance):
    """Stiffnesses (n, 3), the softest first, and directions (n, 3, 3), the largest component positive."""
    values, vectors = np.linalg.eigh(0.5 * (compliance + np.swapaxes(compliance, -1, -2)))
    directions = np.swapaxes(vectors[:, :, ::-1], -1, -2)
    largest = np.take_along_axis(directions, np.abs(directions).argmax(-1)[..., None], -1)
    return 1 / values[:, ::-1], directions * np.sign(largest)
