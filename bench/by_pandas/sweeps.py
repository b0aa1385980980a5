"""Axes by circle-point and concentric spheres by scipy, weighted by the tracker's noise."""
import numpy as np
from scipy.optimize import least_squares


def noise(tracker, points):
    """Covariances (n, 3, 3) in the tracker's own frame."""
    distance = np.linalg.norm(points, axis=1)
    along = tracker["range_fixed_um"] + tracker["range_per_m_um"] * distance
    across = tracker["angle_fixed_um"] + tracker["angle_per_m_um"] * distance
    beam = points / distance[:, None]
    isotropic, beams = (across ** 2)[:, None, None] * np.eye(3), beam[:, :, None] * beam[:, None, :]
    return 1e-12 * (isotropic + (along ** 2 - across ** 2)[:, None, None] * beams)


def solve(residual, start):
    found = least_squares(residual, start, method="lm", x_scale="jac", xtol=1e-13, ftol=1e-13)
    return found.x, np.sqrt(np.diag(np.linalg.inv(found.jac.T @ found.jac)))


def axis(points, which, covariances):
    """Line (point, direction), radii and their uncertainties of circles about one axis."""
    count = which.max() + 1
    middles = np.array([points[which == k].mean(axis=0) for k in range(count)])
    flat = points - middles[which]
    frame = np.linalg.eigh(flat.T @ flat)[1]  # the axis first
    local = (points - middles[0]) @ frame
    rows = np.column_stack([2 * local[:, 1:], *(which == k for k in range(count))])
    start = np.linalg.lstsq(rows, (local[:, 1:] ** 2).sum(1), rcond=None)[0]
    radii = np.sqrt(start[2:] + start[:2] @ start[:2])
    heights = [local[which == k, 0].mean() for k in range(count)]
    p = np.concatenate([[0, 0], start[:2], radii, heights])

    def parts(p):
        """Direction of the axis; height and the vector from the axis of every point."""
        direction = np.array([1.0, p[0], p[1]]) / np.sqrt(1 + p[0] ** 2 + p[1] ** 2)
        away = local - np.array([0.0, p[2], p[3]])
        height = away @ direction
        return direction, height, away - height[:, None] * direction

    def residual(p):
        _, height, across = parts(p)
        plain = np.stack([np.linalg.norm(across, axis=1) - p[4:4 + count][which], height - p[4 + count:][which]], 1)
        return (whiten @ plain[..., None]).reshape(-1)

    direction, _, across = parts(p)
    out = across / np.linalg.norm(across, axis=1)[:, None]
    basis = np.stack([out, np.broadcast_to(direction, out.shape)], 1) @ frame.T
    whiten = np.linalg.inv(np.linalg.cholesky(basis @ covariances @ np.swapaxes(basis, 1, 2)))
    p, sd = solve(residual, p)
    place = middles[0] + frame @ np.array([0.0, p[2], p[3]])
    return place, frame @ parts(p)[0], p[4:4 + count], sd[4:4 + count]


def spheres(points, which, covariances):
    count = which.max() + 1
    middle = points.mean(axis=0)
    local = points - middle
    rows = np.column_stack([2 * local, *(which == k for k in range(count))])
    start = np.linalg.lstsq(rows, (local ** 2).sum(1), rcond=None)[0]
    out = local - start[:3]
    out /= np.linalg.norm(out, axis=1)[:, None]
    sigma = np.sqrt(np.einsum("ni,nij,nj->n", out, covariances, out))

    def residual(p):
        return (np.linalg.norm(local - p[:3], axis=1) - p[3:][which]) / sigma

    p, sd = solve(residual, np.concatenate([start[:3], np.sqrt(start[3:] + start[:3] @ start[:3])]))
    return middle + p[:3], p[3:], sd
