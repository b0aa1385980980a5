"""The result as the JSON of `stiffscope identify --json`, as far as numbers go."""
import json
import numpy as np
from student import COVERAGE, interval, spread, stiffness_interval


def by_joint(seen, values):
    values = iter(values)
    return [next(values) if one else None for one in seen]


def uncertainty(estimate, seen):
    c = estimate.compliance[seen]
    intervals = [interval(*one) for one in zip(c, estimate.sd, estimate.dof)]
    correlation = estimate.covariance / np.outer(estimate.sd, estimate.sd)
    return {"stiffness_nm_per_rad": by_joint(seen, 1 / c), "sd_nm_per_rad": by_joint(seen, estimate.sd / c ** 2),
            "compliance_rad_per_nm": by_joint(seen, c), "identifiable": seen.tolist(), "coverage": COVERAGE,
            "mark": by_joint(seen, ["negative" if k < 0 else "imprecise" if s > abs(k) else "" for k, s in zip(c, estimate.sd)]),
            "interval_nm_per_rad": by_joint(seen, [stiffness_interval(*one) for one in intervals]),
            "dof": by_joint(seen, estimate.dof), "sd_compliance_rad_per_nm": by_joint(seen, estimate.sd),
            "interval_compliance_rad_per_nm": by_joint(seen, intervals),
            "correlation": by_joint(seen, [by_joint(seen, row) for row in correlation.tolist()])}


def step_json(number, force, estimate, seen):
    c = estimate.compliance[seen]
    intervals = [stiffness_interval(*interval(*one)) for one in zip(c, estimate.sd, estimate.dof)]
    return {"step": number, "mean_force_n": force, "stiffness_nm_per_rad": by_joint(seen, 1 / c),
            "sd_nm_per_rad": by_joint(seen, estimate.sd / c ** 2), "interval_nm_per_rad": by_joint(seen, intervals)}


def principal_json(principal):
    return [[{"stiffness_n_per_m": k, "direction": d} for k, d in zip(*one)] for one in zip(*(part.tolist() for part in principal))]


def stiffness_json(poses, seen, cartesian):
    rigid = [j + 1 for j, one in enumerate(seen) if not one]
    columns = [cartesian[name].tolist() for name in ("kappa", "kappa_2_norm", "kc_share", "k_c_cost_um", "k_c_cost_share")]
    with_kc = cartesian["k_x"][0]
    return [{"pose": str(pose), "kappa": kappa, "kappa_2_norm": two, "k_x": one, "k_x_without_kc": other, "anisotropy": ratio,
             "kc_share": share, "joints_taken_as_rigid": rigid, "k_c_cost_um": cost, "k_c_cost_share": cost_share}
            for pose, kappa, two, share, cost, cost_share, one, other, ratio in zip(
                poses, *columns, principal_json(cartesian["k_x"]), principal_json(cartesian["k_x_without_kc"]),
                (with_kc[:, 2] / with_kc[:, 0]).tolist())]


def write(about, folder, found, file):
    seen, estimate = found["seen"], found["estimate"]
    size, compliances, shares = found["subsets"]
    pp = uncertainty(estimate, seen)
    pp.update(zip(("condition", "rms_residual_mm", "sigma_mm"), np.array(found["described"]) * (1, 1e3, 1e3)))
    pp["compensated_at_targets"] = dict(zip(("used", "held_out", "all"), shares.mean(0)), all_postures=found["compensated"])
    pp["compensated_sd"] = dict(zip(("used", "held_out", "all"), shares.std(0, ddof=1)))
    pp["subsets"] = {"postures_used": size, "of": len(found["poses"]), "subsets": len(compliances),
                     "joints": by_joint(seen, [spread(one) for one in compliances.T])}
    result = {"campaign": {"inputs": about.hashes(folder)}, "step": found["step"], "postures": len(found["poses"]),
              "outlying": [{"pose": str(found["poses"][p]), "f_ratio": f, "p_value": tail} for p, f, tail in found["outlying"]],
              "methods": {"pp": pp}, "identifiability": found["joints"], "servo_change_deg": found["servo"],
              "geometric_stiffness": {"torque_change_share": found["torque_change_share"]}}
    if "steps" in found:
        steps = [step_json(*one, of, seen) for one, of in zip(found["steps"], found["by_step"])]
        words = ("compliance_change", "compliance_change_sd", "p_change", "p_linear")
        result["by_step"] = {"pp": dict(zip(words, (by_joint(seen, one) for one in zip(*found["changes"]))), steps=steps)}
        result["per_posture"] = [{"pose": str(p), "targets_mean_mm": m, "targets_mean_after_pp_mm": r} for p, m, r in zip(
            found["poses"], (1e3 * found["moved"]).tolist(), (1e3 * found["left"]).tolist())]
        result["posture_stiffness"] = {"rows": stiffness_json(found["poses"], seen, found["cartesian"])}
    file.write_text(json.dumps(result, default=lambda value: value.item() if value.ndim == 0 else value.tolist()))
