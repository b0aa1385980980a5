#!/usr/bin/env python3
"""fits_by_scipy.py DATA OUT.json: circles and spheres of the points that fit_bench wrote to DATA, by numpy's plane and linear
least squares as start and scipy's Levenberg-Marquardt on the distances in space; 10,000 circles by Gauss-Newton on all of them
at once. Stops where centre or radius is not ours. No uncertainty, no test whether the data determines the fit."""
import json, pathlib, sys
from timing import least_seconds
import numpy as np
from scipy.optimize import least_squares

# m. Both stop where a step is below some 1e-8 of the parameters; the noise is 2e-5.
TOLERANCE = 1e-7


def algebraic(points):
    """Kasa's circle or sphere: centre and radius."""
    rows = np.column_stack([2 * points, np.ones(len(points))])
    found = np.linalg.lstsq(rows, (points ** 2).sum(1), rcond=None)[0]
    return found[:-1], np.sqrt(found[-1] + found[:-1] @ found[:-1])


def sphere(points):
    middle = points.mean(axis=0)
    centred = points - middle
    centre, radius = algebraic(centred)

    def residual(p):
        return np.linalg.norm(centred - p[:3], axis=1) - p[3]

    def jacobian(p):
        away = centred - p[:3]
        return np.column_stack([-away / np.linalg.norm(away, axis=1)[:, None], -np.ones(len(away))])

    found = least_squares(residual, [*centre, radius], jacobian, method="lm", xtol=1e-12, ftol=1e-12).x
    return np.append(found[:3] + middle, found[3])


def frame_of(points):
    """Middle and axes of the plane."""
    middle = points.mean(axis=0)
    centred = points - middle
    return middle, np.linalg.eigh(centred.T @ centred)[1][:, ::-1]


def circle(points):
    """In the plane's own frame: centre (x, y, z), tilts of the normal, radius."""
    middle, axes = frame_of(points)
    flat = (points - middle) @ axes
    centre, radius = algebraic(flat[:, :2])

    def residual(p):
        normal = np.array([p[3], p[4], 1.0]) / np.sqrt(1 + p[3] ** 2 + p[4] ** 2)
        away = flat - p[:3]
        height = away @ normal
        return np.concatenate([np.linalg.norm(away - height[:, None] * normal, axis=1) - p[5], height])

    found = least_squares(residual, [*centre, 0, 0, 0, radius], method="lm", xtol=1e-12, ftol=1e-12).x
    return np.append(middle + axes @ found[:3], found[5])


def circles(points):
    """All of (n, m, 3) at once, Gauss-Newton with the Jacobian written out."""
    middle = points.mean(axis=1)
    centred = points - middle[:, None]
    axes = np.linalg.eigh(np.swapaxes(centred, 1, 2) @ centred)[1][:, :, ::-1]
    flat = centred @ axes
    rows = np.concatenate([2 * flat[:, :, :2], np.ones(flat.shape[:2] + (1,))], 2)
    back = np.swapaxes(rows, 1, 2)
    start = np.linalg.solve(back @ rows, back @ (flat[:, :, :2] ** 2).sum(2)[..., None])[..., 0]
    p = np.zeros((len(points), 6))
    p[:, :2], p[:, 5] = start[:, :2], np.sqrt(start[:, 2] + (start[:, :2] ** 2).sum(1))
    for _ in range(5):
        scale = 1 / np.sqrt(1 + p[:, 3] ** 2 + p[:, 4] ** 2)
        normal = np.stack([p[:, 3], p[:, 4], np.ones(len(p))], 1) * scale[:, None]
        away = flat - p[:, None, :3]
        height = (away @ normal[..., None])[..., 0]
        across = away - height[..., None] * normal[:, None]
        rho = np.linalg.norm(across, axis=2)
        out = across / rho[..., None]
        # d normal / d tilt: e - normal (normal . e), over the length.
        turns = (np.eye(3)[:2] - normal[:, None, :] * normal[:, :2, None]) * scale[:, None, None]
        lever = away @ np.swapaxes(turns, 1, 2)
        radial = np.concatenate([-out, -height[..., None] * (out @ np.swapaxes(turns, 1, 2)), -np.ones(rho.shape + (1,))], 2)
        axial = np.concatenate([-np.broadcast_to(normal[:, None], away.shape), lever, np.zeros(rho.shape + (1,))], 2)
        rows = np.concatenate([radial, axial], 1)
        residual = np.concatenate([rho - p[:, 5:], height], 1)
        back = np.swapaxes(rows, 1, 2)
        p = p - np.linalg.solve(back @ rows, back @ residual[..., None])[..., 0]
    return np.column_stack([middle + (axes @ p[:, :3, None])[..., 0], p[:, 5]])


data, out = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
found = {}
jobs = [(f"{shape}_{n}", shape, n, one, (n, 3)) for shape, one in (("Circle", circle), ("Sphere", sphere)) for n in (20, 1000, 1000000)]
jobs.append(("TenThousandCirclesOf20Points", "TenThousandCirclesOf20Points", "", circles, (10000, 20, 3)))
for file, name, size, fit, shape in jobs:
    points = np.fromfile(data / f"{file}.points").reshape(shape)
    apart = np.abs(fit(points) - np.fromfile(data / f"{file}.fits").reshape(-1, 4)).max()
    if not apart < TOLERANCE:
        sys.exit(f"{file}: {apart:.2g} m from ours")
    found.setdefault(name, {})[str(size)] = least_seconds(lambda: fit(points))
out.write_text(json.dumps(found))
