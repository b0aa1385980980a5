"""Statistics of a few numbers, the same for the vectorised and the plain script: intervals, degrees of freedom, tests."""
import numpy as np
from scipy import optimize, stats

COVERAGE = 0.95
INVERSE_SQUARES = np.sin(0.5 * np.pi * (np.arange(32) + 0.5) / 32) ** -2.0  # midpoint rule of Craig's integral


def log_crossing(falling, low, high):
    return np.exp(optimize.brentq(lambda x: falling(np.exp(x)) - (1 - COVERAGE), np.log(low), np.log(high), xtol=1e-11))


def matched_dof(weights, rest_weight, rest_count):
    """Degrees of freedom of Student's t with the 95 % factor of a sum of squares with these eigenvalues, and
    `rest_count` more of one size."""
    weights = np.maximum(weights, 0.0)
    total = weights.sum() + rest_count * rest_weight

    def tail(factor):
        inside = np.log1p(factor ** 2 * np.outer(weights / total, INVERSE_SQUARES)).sum(axis=0)
        inside += rest_count * np.log1p(factor ** 2 * rest_weight / total * INVERSE_SQUARES)
        return np.exp(-0.5 * inside).mean()

    factor = log_crossing(tail, 0.1, 1e3)
    return log_crossing(lambda dof: np.exp(-0.5 * dof * np.log1p(factor ** 2 / dof * INVERSE_SQUARES)).mean(), 0.3, 1e4)


def influence_dof(own, through, inverse):
    """`own` (n), `through` (n, r): the influences' covariance is diag(own) - through inverse through^T. Its 64 largest
    postures exactly, the rest as equal weights that keep trace and squares."""
    shared = -inverse @ (through.T @ through)
    crossed = -inverse @ (through.T * own @ through)
    trace, squares = own.sum() + np.trace(shared), own @ own + 2 * np.trace(crossed) + np.trace(shared @ shared)
    chosen = np.sort(np.argsort(-own, kind="stable")[:64])
    block = np.diag(own[chosen]) - through[chosen] @ inverse @ through[chosen].T
    left, left_squares = trace - np.trace(block), squares - (block ** 2).sum()
    rest = (left_squares / left, left ** 2 / left_squares) if len(own) > 64 and left > 0 and left_squares > 0 else (0.0, 0.0)
    return matched_dof(np.linalg.eigvalsh(block), *rest)


def interval(compliance, sd, dof):
    reach = stats.t.ppf(0.5 + 0.5 * COVERAGE, dof) * sd
    return [compliance - reach, compliance + reach]


def stiffness_interval(low, high):
    if low > 0 or high < 0:
        return [1 / high, 1 / low]
    return [1 / high if high > 0 else -np.inf, np.inf]


def load_dependence(compliances, influences, dofs):
    """Of one joint over the steps, the lightest first: influences (steps, n). Change, its sd, p of it, p of linearity."""
    contrasts = len(compliances) - 1
    moved = influences[1:] - influences[0]
    covariance, difference, dof = moved @ moved.T, compliances[1:] - compliances[0], min(dofs)
    change, sd = difference[-1] / compliances[0], np.sqrt(covariance[-1, -1]) / abs(compliances[0])
    below = dof - contrasts + 1
    wald = difference @ np.linalg.solve(covariance, difference)
    return (change, sd, stats.f.sf((change / sd) ** 2, 1, dof), stats.f.sf(wald * below / (dof * contrasts), contrasts, below)
            ) if dof > contrasts else (change, sd, 1.0, 1.0)


def spread(compliance):
    """Of a joint over the subsets."""
    k = 1 / compliance
    low, median, high = np.quantile(k, [0.05, 0.5, 0.95])
    return {"mean_nm_per_rad": k.mean(), "sd_nm_per_rad": k.std(ddof=1), "median_nm_per_rad": median, "p5_nm_per_rad": low,
            "p95_nm_per_rad": high, "mean_compliance_rad_per_nm": compliance.mean(),
            "sd_compliance_rad_per_nm": compliance.std(ddof=1), "share_negative": (compliance < 0).mean()}


def outlier_tail(f, per_posture, left, coordinates, postures):
    below = np.maximum(1.0, per_posture * left / coordinates)
    return np.minimum(1.0, postures * stats.f.sf(f, np.maximum(1, np.floor(per_posture)), below))


def subset_plan(n):
    """Postures that identify, number of subsets."""
    return int(n * 10 / 19 + 0.5), min(20000, max(200, 2000000 // n))
