"""An arm by the axes of its joints at zero, which a fit may move: a product of exponentials, all postures at once."""
import numpy as np


def rotation(axes, angles):
    """(n, 3, 3) about one axis (3,) by angles (n,)."""
    x, y, z = axes
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angles)[:, None, None] * cross + (1 - np.cos(angles))[:, None, None] * (cross @ cross)


class Arm:
    """Parameters: of axes 2 to 6 two shifts and two tilts across each, without what is a choice of frame (axis 1 all; axis 2
    along and about axis 1); rotation vector and shift of base from tracker; reflectors with all joints at zero."""

    def __init__(self, axes, q):
        self.q, self.points, self.directions = q, [p for p, _ in axes], [d / np.linalg.norm(d) for _, d in axes]
        first = self.directions[0]
        self.across = []
        for d in self.directions:
            u = first - (first @ d) * d
            if np.linalg.norm(u) < 0.1:
                u = np.cross(d, np.eye(3)[np.argmin(abs(d))])
            u = u / np.linalg.norm(u)
            self.across.append((u, np.cross(d, u)))
        # shift u, shift v, tilt to u, tilt to v: u of axis 2 is along axis 1, and a tilt to v turns about it.
        self.free = [k for k in range(24) if k not in (0, 1, 2, 3, 4, 7)]

    def motions(self, p):
        """Rotations (n, 3, 3), translations (n, 3) of each body from where it stands at zero, the axes, the small motions."""
        steps = np.zeros(24)
        steps[self.free] = p[:18]
        count = len(self.q)
        turn, shift = np.broadcast_to(np.eye(3), (count, 3, 3)), np.zeros((count, 3))
        bodies, screws = [(turn, shift)], []
        for j, (u, v) in enumerate(self.across):
            by = steps[4 * j:4 * j + 4]
            point = self.points[j] + by[0] * u + by[1] * v
            whole = self.directions[j] + by[2] * u + by[3] * v
            length = np.linalg.norm(whole)
            direction = whole / length
            own = rotation(direction, self.q[:, j])
            shift = shift + turn @ point - (turn @ own) @ point
            turn = turn @ own
            bodies.append((turn, shift))
            tilts = [np.cross(direction, w) / length for w in (u, v)]
            screws += [(np.zeros(3), u), (np.zeros(3), v)] + [(w, -np.cross(w, point)) for w in tilts]
        return bodies, screws

    def by_axes(self, bodies, screws, places):
        """Derivatives of places (n, t, 3) by the free axis parameters, (n, t, 3, 18)."""
        columns = []
        for k in self.free:
            rotations, shifts = 0.0, 0.0
            for sign, (turn, shift) in ((1, bodies[k // 4]), (-1, bodies[k // 4 + 1])):
                turned = turn @ screws[k][0]
                rotations = rotations + sign * turned
                shifts = shifts + sign * (turn @ screws[k][1] - np.cross(turned, shift))
            columns.append(np.cross(rotations[:, None], places) + shifts[:, None])
        return np.stack(columns, -1)


def registered(points, places):
    """Rotation and translation that bring points onto places."""
    a, b = points.mean(0), places.mean(0)
    left, _, right = np.linalg.svd((places - b).T @ (points - a))
    turn = left @ np.diag([1, 1, np.linalg.det(left @ right)]) @ right
    return turn, b - turn @ a
