"""Which joints the loads turn and the postures see, from sums over the load cases: the same for both scripts."""
import numpy as np
from scipy import optimize

DIRECTION, PLACE, HANGING_WITHIN, LEAST_RATIO = 2e-3, 0.2e-3, 0.0873, 3.0
TAKES_PART, UNSEEN = 0.05, 1e-8


def torque_variance(about, levers, axes, force, moment):
    """By wrench, direction and place; leading dimensions as levers'."""
    turn = np.cross(force[..., None, :], levers) + np.cross(moment[..., None, :], axes)
    place = np.cross(axes, force[..., None, :])
    return (about.force_sigma ** 2 * (levers ** 2).sum(-1) + about.moment_sigma ** 2
            + DIRECTION ** 2 * (turn ** 2).sum(-1) + PLACE ** 2 * (place ** 2).sum(-1))


def judged_joints(n, hangs, torque, trusted, variance, columns, weights, normal):
    """Sums of squares over n cases, and A^T A: mask and what is reported of each joint."""
    torque, trusted, uncertain = np.sqrt(torque / n), np.sqrt(trusted / n), np.sqrt(variance / n)
    seen = (trusted > 0) & (trusted > LEAST_RATIO * uncertain)
    seen &= np.sqrt(columns / np.where(weights > 0, weights, np.inf)) > LEAST_RATIO * PLACE
    both = np.outer(seen, seen)
    length = np.sqrt(np.diag(normal))
    values, vectors = np.linalg.eigh(np.where(both, normal / np.outer(length, length), np.eye(6)))
    for value, vector in zip(values, vectors.T):
        if value < UNSEEN:
            seen &= np.abs(vector) <= TAKES_PART
    joints = [{"joint": j + 1, "identifiable": bool(seen[j]), "torque_rms_nm": torque[j], "trusted_torque_rms_nm": trusted[j],
               "torque_uncertainty_nm": uncertain[j]} for j in range(6)]
    return seen, {"load_hangs": bool(hangs[0]), "force_to_gravity_rms_deg": np.degrees(hangs[1]), "joints": joints}


def best_length(linear, angular):
    """Characteristic length: the one that makes the stacked Jacobian's condition number least."""
    def condition(log_length):
        values = np.linalg.eigvalsh(linear * np.exp(-2 * log_length) + angular)
        return np.sqrt(values[5] / values[0])

    grid = np.linspace(np.log(0.05), np.log(20.0), 61)
    at = int(np.argmin([condition(x) for x in grid]))
    step = grid[1] - grid[0]
    return np.exp(optimize.minimize_scalar(condition, bounds=(grid[at] - step, grid[at] + step), method="bounded",
                                           options={"xatol": 1e-7}).x)
