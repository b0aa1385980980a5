"""Compares the script's result with ours, number by number: 1e-6 relative where both compute the same, and six standard errors
of the difference where each draws its own subsets."""
import math

RELATIVE = 1e-6
# A factor found to 5e-10 tells thousands of degrees of freedom apart to 4e-6 only: it goes as 1 + 1.2 / dof.
DOF = 1e-5
# By draws of their own: a mean's difference has sd sqrt(2/n) of the spread, an sd's sqrt(1/n), a median's 1.253 sqrt(2/n)
# and a 5 % quantile's 2.11 sqrt(2/n) of a normal spread; six of each.
DRAWN = {"mean_nm_per_rad": 6 * 2 ** 0.5, "sd_nm_per_rad": 6.0, "median_nm_per_rad": 7.52 * 2 ** 0.5,
         "p5_nm_per_rad": 12.7 * 2 ** 0.5, "p95_nm_per_rad": 12.7 * 2 ** 0.5}
DRAWN_COMPLIANCE = {"mean_compliance_rad_per_nm": 6 * 2 ** 0.5, "sd_compliance_rad_per_nm": 6.0}


class Comparison:
    def __init__(self):
        self.numbers, self.drawn, self.wrong = 0, 0, []

    def number(self, ours, theirs, tolerance, place):
        self.numbers += 1
        if not abs(ours - theirs) <= tolerance:
            self.wrong.append(f"{place}: ours {ours!r}, the script's {theirs!r}, borne {tolerance:.2g}")

    def all_of(self, ours, theirs, place=""):
        """Every entry that the script gives. Small numbers of a list count against the list's largest: a component of a
        direction near zero has no relative accuracy."""
        if isinstance(theirs, dict):
            for key, value in theirs.items():
                if key in ("subsets", "compensated_at_targets", "compensated_sd"):
                    continue
                if key not in ours:
                    self.wrong.append(f"{place}/{key}: not in ours")
                    continue
                self.all_of(ours[key], value, f"{place}/{key}")
        elif isinstance(theirs, list):
            if len(ours) != len(theirs):
                self.wrong.append(f"{place}: {len(ours)} entries, the script's {len(theirs)}")
                return
            if theirs and all(isinstance(v, float) for v in theirs):
                scale = max(map(abs, theirs)) if place.endswith(("direction", "]")) else None
                for k, (a, b) in enumerate(zip(ours, theirs)):
                    self.number(a, b, RELATIVE * (scale or max(abs(a), abs(b))), f"{place}[{k}]")
                return
            for k, (a, b) in enumerate(zip(ours, theirs)):
                self.all_of(a, b, f"{place}[{k}]")
        elif isinstance(theirs, float) and "/dof[" in place:
            self.number(ours, theirs, DOF * abs(ours), place)
        elif isinstance(theirs, float):
            # Zeros: servo angles, torques that hang away; below 1e-9 of their units both are rounding.
            self.number(ours, theirs, max(RELATIVE * abs(ours), 1e-9 if abs(ours) < 1e-9 else 0.0), place)
        elif ours != theirs:
            self.wrong.append(f"{place}: ours {ours!r}, the script's {theirs!r}")

    def subsets(self, ours, theirs):
        mine, other = ours["subsets"], theirs["subsets"]
        if (mine["postures_used"], mine["of"], mine["subsets"]) != (other["postures_used"], other["of"], other["subsets"]):
            self.wrong.append("another number of subsets")
        root = math.sqrt(other["subsets"])
        for a, b in zip(mine["joints"], other["joints"]):
            if a is None and b is None:
                continue
            for names, sd in ((DRAWN, b["sd_nm_per_rad"]), (DRAWN_COMPLIANCE, b["sd_compliance_rad_per_nm"])):
                for key, errors in names.items():
                    self.drawn += 1
                    self.number(a[key], b[key], errors * sd / root, f"subsets/{key}")
        shares = "compensated_at_targets"
        for key, sd in theirs["compensated_sd"].items():
            self.drawn += 1
            # The equations of both are the same to RELATIVE; "all" hardly varies between subsets.
            self.number(ours[shares][key], theirs[shares][key], 6 * sd * math.sqrt(2) / root + RELATIVE, f"{shares}/{key}")
        key = "all_postures"
        self.number(ours[shares][key], theirs[shares][key], RELATIVE, f"{shares}/{key}")


def compared(ours, theirs):
    comparison = Comparison()
    comparison.all_of(ours, theirs)
    comparison.subsets(ours["methods"]["pp"], theirs["methods"]["pp"])
    return comparison
