#!/usr/bin/env python3
"""absolute.py CAMPAIGN RESULT.json: joint stiffnesses of a day of absolute readings by all three methods, as one would write
it with pandas, numpy and scipy, all postures at once: axes, R0 and wrist centre from the sweeps; the own weight's sag taken off
them, in turns with the stiffnesses; the reflectors registered in every posture; for Partial Pose the geometry calibrated on the
unloaded readings; K_c and Jacobians at the middle of the displacement. Stiffnesses, the share of the deflection compensated,
what the calibration leaves; of uncertainties, outlying postures and subsets nothing. For campaigns of three reflectors, all
postures with all steps and reflectors, sweeps with the other joints at zero, a load cell on the flange."""
import json, pathlib, sys
import xml.etree.ElementTree as ElementTree
import numpy as np
import pandas as pd
from arm import Posture, chain, numbers, rpy, spring_torque, times
from calibration import rotation
from judged import HANGING_WITHIN, best_length, judged_joints, torque_variance
from sweeps import axis, noise, spheres
from vectorised import solve_normal, squares

ANGLES = [f"q{i}_deg" for i in range(1, 7)]
POINT, WRENCH = ["x_mm", "y_mm", "z_mm"], ["fx_n", "fy_n", "fz_n", "mx_nm", "my_nm", "mz_nm"]
ROUNDS = 3  # of sag and stiffnesses in turns


def applied(pose, points):
    return points @ pose[0].T + pose[1]


def inverse(pose):
    return pose[0].T, -pose[0].T @ pose[1]


def product(a, b):
    return a[0] @ b[0], a[0] @ b[1] + a[1]


def base_frame(first, second):
    """z along the first line, y by the second; the origin where their common perpendicular meets the first."""
    z = first[1]
    y = second[1] - (z @ second[1]) * z
    y /= np.linalg.norm(y)
    between, cosine = second[0] - first[0], first[1] @ second[1]
    along = (between @ first[1] - cosine * (between @ second[1])) / (1 - cosine ** 2)
    return np.stack([np.cross(y, z), y, z], 1), first[0] + along * z


class Day:
    """What campaign.xml, the URDF and the tables say; the heaviest step. m, rad, N."""

    def __init__(self, folder):
        root = ElementTree.parse(folder / "campaign.xml").getroot()
        robot, cell = root.find("robot"), root.find("load_cell")
        self.names = [t.get("id") for t in root.find("targets")]
        self.tracker = {key: float(value) for key, value in root.find("tracker").items() if key != "model"}
        self.cell = rpy(np.radians(numbers(cell.get("rpy_deg")))), 1e-3 * numbers(cell.get("xyz_mm"))
        self.force_sigma, self.moment_sigma = float(cell.get("force_sigma_n")), float(cell.get("moment_sigma_nm"))
        self.tool = float(root.find("tool").get("mass_kg")), 1e-3 * numbers(root.find("tool").get("com_mm"))
        self.read_urdf(folder / robot.get("urdf"), robot.get("base_link"), robot.get("flange_link"))
        table = lambda name: pd.read_csv(folder / root.find(name).get("file"))
        self.circles, self.wrist, states, loading = table("circle_sweeps"), table("wrist_sweep"), table("states"), table("loading")
        force = np.sqrt((states[WRENCH[:3]] ** 2).sum(axis=1)).groupby(states.step).mean()
        self.step = int(force.idxmax())
        by_step = states.sort_values("pose", kind="stable").set_index("step")
        self.q = np.radians(by_step.loc[0, ANGLES].to_numpy())
        self.wrench = by_step.loc[self.step, WRENCH].to_numpy()
        loading = loading[(loading.step == 0) | (loading.step == self.step)]
        loading = loading.assign(target=pd.Categorical(loading.target, self.names))
        means = loading.groupby(["step", "pose", "target"], observed=True)[POINT].agg("mean")
        counts = loading[loading.step == 0].groupby(["pose", "target"], observed=True).size()
        shape = (2, len(self.q), len(self.names), 3)
        self.unloaded, self.loaded = 1e-3 * means.to_numpy().reshape(shape)
        self.repeats = counts.to_numpy().reshape(shape[1:3])

    def read_urdf(self, urdf, base, flange):
        """Axes, flange and each body's mass and centre with all joints at zero, in base_link."""
        links = {link.get("name"): link.find("inertial") for link in ElementTree.parse(urdf).getroot().iter("link")}
        by_child = {j.find("child").get("link"): j for j in ElementTree.parse(urdf).getroot().iter("joint")}
        path = [flange]
        while path[0] != base:
            path.insert(0, by_child[path[0]].find("parent").get("link"))
        frame, body = (np.eye(3), np.zeros(3)), 0
        self.axes, self.mass, moment = [], np.zeros(7), np.zeros((7, 3))
        for name, (turn, step, along) in zip(path[1:], chain(urdf, base, flange)):
            frame = product(frame, (turn, step))
            if along is not None:
                self.axes.append((frame[1], frame[0] @ along))
                body += 1
            if links[name] is not None:
                mass = float(links[name].find("mass").get("value"))
                self.mass[body] += mass
                moment[body] += mass * applied(frame, numbers(links[name].find("origin").get("xyz")))
        self.flange = frame
        self.centres = moment / np.maximum(self.mass, 1e-30)[:, None]


class Arm:
    """Lines of the axes, flange, masses and reflectors at zero, all in R0; r0_from_points and the springs of the own weight."""

    def __init__(self, axes, flange, day, r0_from_base, r0_from_points, targets, compliance):
        self.axes, self.flange, self.r0, self.targets, self.compliance = axes, flange, r0_from_points, targets, compliance
        tool_mass, tool_centre = day.tool
        self.mass, self.centres = day.mass.copy(), applied(r0_from_base, day.centres)
        both = self.mass[6] + tool_mass
        self.centres[6] = (self.mass[6] * self.centres[6] + tool_mass * applied(flange, tool_centre)) / both
        self.mass[6] = both
        self.gravity = r0_from_base[0] @ np.array([0.0, 0.0, -9.80665])

    def sagged(self, q):
        if not self.compliance.any():
            return q
        now = q
        for _ in range(3):
            now = q + self.compliance * Placed(self, now).weight_torque()
        return now


class Placed(Posture):
    """The arm in n postures."""

    def __init__(self, arm, q):
        self.arm = arm
        turn, shift = np.broadcast_to(np.eye(3), (len(q), 3, 3)), np.zeros((len(q), 3))
        axes, points, self.bodies = [], [], [(turn, shift)]
        for j, (point, direction) in enumerate(arm.axes):
            axes.append(turn @ direction)
            points.append(turn @ point + shift)
            turn = turn @ rotation(direction, q[:, j])
            shift = points[-1] - turn @ point
            self.bodies.append((turn, shift))
        self.axes, self.points, self.rotation, self.origin = np.stack(axes, 1), np.stack(points, 1), turn, shift

    def centre(self, body):
        turn, shift = self.bodies[body]
        return turn @ self.arm.centres[body] + shift

    def weight_torque(self):
        torque, force, moment = np.zeros((len(self.origin), 6)), np.zeros(3), np.zeros((len(self.origin), 3))
        for j in range(5, -1, -1):
            pull = self.arm.mass[j + 1] * self.arm.gravity
            force = force + pull
            moment = moment + np.cross(self.centre(j + 1), pull)
            torque[:, j] = (self.axes[:, j] * (moment - np.cross(self.points[:, j], force))).sum(1)
        return torque

    def weight_stiffness(self):
        total = np.zeros((len(self.origin), 6, 6))
        for body in range(1, 7):
            levers = np.cross(self.axes[:, :body], self.centre(body)[:, None] - self.points[:, :body])
            change = np.cross(levers, self.arm.mass[body] * self.arm.gravity)
            half = np.triu(self.axes[:, :body] @ np.swapaxes(change, 1, 2))
            total[:, :body, :body] += half + np.swapaxes(np.triu(half, 1), 1, 2)
        return total


def registered(at_zero, points):
    """Rotation and translation that bring (t, 3) onto each of (n, t, 3)."""
    a, b = at_zero.mean(0), points.mean(1)
    left, _, right = np.linalg.svd(np.swapaxes(points - b[:, None], 1, 2) @ (at_zero - a))
    left[:, :, 2] *= np.linalg.det(left @ right)[:, None]
    turn = left @ right
    return turn, b - turn @ a


def trilaterated(points, radii, near):
    """P_wrist from three reflectors (n, 3, 3); of the two places the one nearer."""
    side, other = points[:, 1] - points[:, 0], points[:, 2] - points[:, 0]
    d = np.linalg.norm(side, axis=1)
    ex = side / d[:, None]
    i = (ex * other).sum(1)
    ey = other - i[:, None] * ex
    j = np.linalg.norm(ey, axis=1)
    ey /= j[:, None]
    r0, r1, r2 = radii ** 2
    x = (r0 - r1 + d * d) / (2 * d)
    y = (r0 - r2 + i * i + j * j) / (2 * j) - i / j * x
    foot = points[:, 0] + x[:, None] * ex + y[:, None] * ey
    up = np.sqrt(np.maximum(0.0, r0 - x * x - y * y))[:, None] * np.cross(ex, ey)
    nearer = ((foot + up - near) ** 2).sum(1) <= ((foot - up - near) ** 2).sum(1)
    return np.where(nearer[:, None], foot + up, foot - up)


class Loaded:
    """The arm under the heaviest step: unloaded and loaded points, flange poses and P_wrist, the wrench, torques, K_c."""

    def __init__(self, day, arm, wrist):
        self.arm, self.q = arm, arm.sagged(day.q)
        self.base = Placed(arm, self.q)
        self.unloaded, self.loaded = applied(arm.r0, day.unloaded), applied(arm.r0, day.loaded)
        before, after = registered(arm.targets, self.unloaded), registered(arm.targets, self.loaded)
        self.before, self.after = [(turn @ arm.flange[0], turn @ arm.flange[1] + shift) for turn, shift in (before, after)]
        self.point = self.before[1] + self.before[0] @ day.cell[1]
        turn = self.after[0] @ day.cell[0]
        self.force, self.moment = times(turn, day.wrench[:, :3]), times(turn, day.wrench[:, 3:])
        centre, radii = wrist
        turn, shift = self.base.bodies[3]
        near = turn @ centre + shift
        self.wrist = [trilaterated(points, radii, near) for points in (self.unloaded, self.loaded)]
        self.torque = self.base.torque(self.point, self.force, self.moment)
        self.geometric = None
        self.placed, self.middle = self.base, 0.0

    def equations(self, unloaded, loaded):
        """Rows and displacements of points (n, t, 3), Jacobians at the unloaded arm or at the middle."""
        moves = loaded - unloaded
        return self.placed.rows(unloaded + self.middle * moves, self.torque), moves.reshape(len(moves), -1)

    def reflectors(self):
        return self.equations(self.unloaded, self.loaded)

    def wrist_points(self):
        return self.equations(self.wrist[0][:, None], self.wrist[1][:, None])

    def settled(self, solve):
        """K_c, and Jacobians at the middle of the displacement."""
        self.placed, self.middle, self.torque = self.base, 0.0, self.base.torque(self.point, self.force, self.moment)
        plain = self.torque
        if self.geometric is None:
            self.geometric = self.base.geometric_stiffness(self.point, self.force, self.moment) + self.base.weight_stiffness()
        compliance = solve(self)
        for _ in range(2):
            self.torque = spring_torque(plain, self.geometric, compliance)
            self.placed, self.middle = Placed(self.arm, self.q + 0.5 * compliance * self.torque), 0.5
            compliance = solve(self)
        return compliance


def normal(rows, right):
    stacked = rows.reshape(-1, 6)
    return stacked.T @ stacked, stacked.T @ right.reshape(-1)


def partial_pose(seen):
    return lambda loaded: solve_normal(*normal(*loaded.reflectors()), seen)


def decoupled(seen):
    inner = np.arange(6) < 3

    def solve(loaded):
        compliance = solve_normal(*normal(*loaded.wrist_points()), seen & inner)
        matrix, right = normal(*loaded.reflectors())
        return compliance + solve_normal(matrix, right - matrix @ compliance, seen & ~inner)

    return solve


def complete_pose(seen, tcp):
    """The solver and its characteristic length, which is found once."""
    length = []

    def solve(loaded):
        places = [turn @ tcp + shift for turn, shift in (loaded.before, loaded.after)]
        if not length:
            jacobian = loaded.base.jacobian(places[0])
            length.append(best_length(*[np.einsum("nij,nik->jk", part, part) for part in (jacobian[:, :3], jacobian[:, 3:])]))
        moves = places[1] - places[0]
        turn = loaded.after[0] @ np.swapaxes(loaded.before[0], 1, 2)
        vector = 0.5 * np.stack([turn[:, 2, 1] - turn[:, 1, 2], turn[:, 0, 2] - turn[:, 2, 0], turn[:, 1, 0] - turn[:, 0, 1]], 1)
        sine = np.linalg.norm(vector, axis=1)
        vector = vector * (np.arcsin(sine) / sine)[:, None]
        rows = loaded.placed.jacobian(places[0] + loaded.middle * moves) * loaded.torque[:, None, :]
        linear, angular = normal(rows[:, :3], moves), normal(rows[:, 3:], vector)
        return solve_normal(*[a / length[0] ** 2 + b for a, b in zip(linear, angular)], seen)

    return solve, length


def joints_seen(day, loaded):
    base, force = loaded.base, loaded.force
    down = loaded.arm.gravity / np.linalg.norm(loaded.arm.gravity)
    angle = np.arctan2(np.linalg.norm(np.cross(force, down), axis=1), force @ down)
    hangs = np.sqrt((angle ** 2).mean())
    hanging = base.torque(loaded.point, np.outer(force @ down, down), loaded.moment - np.outer(loaded.moment @ down, down))
    variance = torque_variance(day, base.levers(loaded.point), base.axes, force, loaded.moment).sum(axis=0)
    torque, rows = squares(loaded.torque), loaded.reflectors()[0]
    return judged_joints(len(force), (hangs < HANGING_WITHIN, hangs), torque,
                         squares(hanging) if hangs < HANGING_WITHIN else torque, variance, squares(rows.reshape(-1, 6)),
                         len(day.names) * torque, normal(rows, rows[..., 0])[0])[0]


class Frames:
    """Axes, R0, reflectors and wrist centre from the sweeps, the sag of `before` taken off them."""

    def __init__(self, day, compliance, before=None):
        sag = [0.0, 0.0] if before is None else [before.sag_of(day, table, compliance) for table in (day.circles, day.wrist)]
        raw = [1e-3 * table[POINT].to_numpy() for table in (day.circles, day.wrist)]
        rigid = [points - off for points, off in zip(raw, sag)]
        q = [np.radians(table[ANGLES].to_numpy()) for table in (day.circles, day.wrist)]
        which = [pd.Categorical(table.target, day.names).codes for table in (day.circles, day.wrist)]
        lines = []
        for j in range(6):
            own = (day.circles.axis == j + 1).to_numpy()
            place, direction = axis(rigid[0][own], which[0][own], noise(day.tracker, raw[0][own]))[:2]
            scatter = []
            for sense in (1, -1):
                back = times(rotation(direction, -sense * q[0][own, j]), rigid[0][own] - place)
                scatter.append(sum(((back[which[0][own] == t] - back[which[0][own] == t].mean(0)) ** 2).sum() for t in range(len(day.names))))
            lines.append((place, direction if scatter[0] <= scatter[1] else -direction))
        self.base_from_r0, senses = self.nominal(day)
        self.r0 = inverse(base_frame(*[(point, sense * direction) for (point, direction), sense in zip(lines, senses)]))
        self.r0_from_base = inverse(self.base_from_r0)
        self.axes = [(applied(self.r0, point), self.r0[0] @ direction) for point, direction in lines]
        nominal = [(applied(self.r0_from_base, point), self.r0_from_base[0] @ direction) for point, direction in day.axes]
        self.flange = carried(product(self.r0_from_base, day.flange), nominal, self.axes)
        arm = Arm(self.axes, self.flange, day, self.r0_from_base, self.r0, None, np.zeros(6))
        back = []
        for angles, points in zip(q, rigid):
            placed = Placed(arm, angles)
            back.append(times(np.swapaxes(placed.rotation, 1, 2), applied(self.r0, points) - placed.origin))
        back, which_all = np.concatenate(back), np.concatenate(which)
        self.targets = np.array([back[which_all == t].mean(0) for t in range(len(day.names))])
        centre, self.radii, _ = spheres(rigid[1], which[1], noise(day.tracker, raw[1]))
        self.centre = applied(self.r0, centre)
        self.tcp = inverse(self.flange)
        point, direction = applied(self.tcp, self.axes[5][0]), self.tcp[0] @ self.axes[5][1]
        self.tcp = point - point[2] / direction[2] * direction

    @staticmethod
    def nominal(day):
        (first, z), (second, y) = day.axes[0], day.axes[1]
        senses = [-1 if z[2] < 0 else 1, 1]
        frame = base_frame((first, senses[0] * z), (second, y))
        towards = day.flange[1] - first
        if frame[0][:, 0] @ (towards - (towards @ z) * z) < 0:
            senses[1] = -1
            frame = base_frame((first, senses[0] * z), (second, -y))
        return frame, senses

    def arm(self, day, compliance):
        return Arm(self.axes, self.flange, day, self.r0_from_base, self.r0, self.targets, compliance)

    def sag_of(self, day, table, compliance):
        arm, q = self.arm(day, compliance), np.radians(table[ANGLES].to_numpy())
        targets = self.targets[pd.Categorical(table.target, day.names).codes]
        places = [times(placed.rotation, targets) + placed.origin for placed in (Placed(arm, arm.sagged(q)), Placed(arm, q))]
        return (places[0] - places[1]) @ self.r0[0]


def carried(flange, nominal, axes):
    """The flange keeps its place in the frame on axes 6 and 5."""
    return product(base_frame(axes[5], axes[4]), product(inverse(base_frame(nominal[5], nominal[4])), flange))


def calibrated(day, frames, compliance):
    """Axes, base and reflectors by the unloaded readings, weighted by the tracker's noise; Gauss-Newton. What is a choice
    of frame (axis 1; axis 2 along and about it) stays."""
    start = frames.arm(day, compliance)
    q, points = start.sagged(day.q), applied(start.r0, day.unloaded)
    centre = points.reshape(-1, 3).mean(0)
    covariance = noise(day.tracker, day.unloaded.reshape(-1, 3)) / day.repeats.reshape(-1, 1, 1)
    whiten = np.swapaxes(np.linalg.cholesky(np.linalg.inv(covariance)), 1, 2) @ start.r0[0].T
    across = []
    for _, d in start.axes:
        u = np.cross(d, np.eye(3)[np.argmin(abs(d))])
        u /= np.linalg.norm(u)
        across.append((u, np.cross(d, u)))
    z = start.axes[0][1]
    u = z - (z @ start.axes[1][1]) * start.axes[1][1]
    u /= np.linalg.norm(u)
    across[1] = (u, np.cross(start.axes[1][1], u))
    free = [k for k in range(24) if k not in (0, 1, 2, 3, 4, 7)]
    n, t = points.shape[:2]
    axes, targets, base = list(start.axes), start.targets.copy(), (np.eye(3), np.zeros(3))
    for _ in range(20):
        arm = Arm(axes, start.flange, day, frames.r0_from_base, start.r0, targets, compliance)
        placed = Placed(arm, q)
        places = placed.places(targets)
        seen = applied(base, points - centre) + centre
        left = (whiten @ (seen - places).reshape(-1, 3, 1))[..., 0]
        rows = np.zeros((n, t, 3, 24 + 3 * t))
        for column, k in enumerate(free):
            j, (point, direction) = k // 4, axes[k // 4]
            along = across[j][k % 2]
            rotate = np.cross(direction, along) if k % 4 > 1 else np.zeros(3)
            shift = -np.cross(rotate, point) if k % 4 > 1 else along
            total_turn, total_shift = 0.0, 0.0
            for sign, (turn, move) in ((1, placed.bodies[j]), (-1, placed.bodies[j + 1])):
                turned = turn @ rotate
                total_turn = total_turn + sign * turned
                total_shift = total_shift + sign * (turn @ shift - np.cross(turned, move))
            rows[..., column] = np.cross(total_turn[:, None], places) + total_shift[:, None]
        for k in range(3):
            rows[..., 18 + k] = -np.cross(np.eye(3)[k], seen - centre)
            rows[..., k, 21 + k] = -1.0
        for one in range(t):
            rows[:, one, :, 24 + 3 * one:27 + 3 * one] = placed.rotation
        rows = (whiten @ rows.reshape(-1, 3, rows.shape[-1])).reshape(-1, rows.shape[-1])
        matrix, right = rows.T @ rows, rows.T @ left.reshape(-1)
        scale = 1 / np.sqrt(np.diag(matrix))
        step = scale * np.linalg.solve(matrix * np.outer(scale, scale), scale * right)
        for column, k in enumerate(free):
            j, by = k // 4, step[column]
            point, direction = axes[j]
            along = across[j][k % 2]
            axes[j] = (point, direction + by * along) if k % 4 > 1 else (point + by * along, direction)
        for j in range(6):
            direction = axes[j][1] / np.linalg.norm(axes[j][1])
            u = across[j][0] - (across[j][0] @ direction) * direction
            axes[j], across[j] = (axes[j][0], direction), (u / np.linalg.norm(u), np.cross(direction, u / np.linalg.norm(u)))
        angle = np.linalg.norm(step[18:21])
        turn = rotation(step[18:21] / angle, np.array([angle]))[0] if angle > 0 else np.eye(3)
        base = turn @ base[0], turn @ base[1] + step[21:24]
        targets = targets + step[24:].reshape(-1, 3)
        if np.abs(step / scale).max() < 1e-6:
            break
    r0 = product((base[0], base[1] + centre - base[0] @ centre), start.r0)
    found = Arm(axes, carried(start.flange, start.axes, axes), day, frames.r0_from_base, r0, targets, compliance)
    found.mass, found.centres = start.mass, start.centres
    placed = Placed(found, q)
    return found, np.sqrt(((applied(r0, day.unloaded) - placed.places(targets)) ** 2).mean())


def share(rows, right, compliance):
    lengths = [np.linalg.norm(one.reshape(-1, 3), axis=1).sum() for one in (right - times(rows, compliance), right)]
    return 1 - lengths[0] / lengths[1]


def main(folder, file):
    day = Day(folder)
    compliance, frames = np.zeros(6), Frames(day, np.zeros(6))
    for _ in range(ROUNDS):
        loaded = Loaded(day, frames.arm(day, compliance), (frames.centre, frames.radii))
        compliance = np.maximum(loaded.settled(decoupled(joints_seen(day, loaded))), 0.0)
        frames = Frames(day, compliance, frames)
    loaded = Loaded(day, frames.arm(day, compliance), (frames.centre, frames.radii))
    seen = joints_seen(day, loaded)
    solve, length = complete_pose(seen, frames.tcp)
    methods, shown = {}, lambda c: [float(1 / one) if use else None for one, use in zip(c, seen)]

    def add(name, arm, how):
        found = arm.settled(how)
        methods[name] = {"stiffness_nm_per_rad": shown(found), "compensated_at_targets": share(*arm.reflectors(), found),
                         "compensated_at_wrist": share(*arm.wrist_points(), found)}

    add("cp", loaded, solve)
    geometry, rms = calibrated(day, frames, compliance)
    add("pp", Loaded(day, geometry, (frames.centre, frames.radii)), partial_pose(seen))
    add("dpp", loaded, decoupled(seen))
    file.write_text(json.dumps({"step": day.step, "postures": len(day.q), "methods": methods, "characteristic_length_m": length[0],
                                "calibration_rms_mm": 1e3 * rms, "sag_compliance": compliance.tolist()}))


if __name__ == "__main__":
    main(*map(pathlib.Path, sys.argv[1:3]))
