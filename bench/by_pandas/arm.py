"""The arm's kinematics and statics with numpy. Every function takes one posture or n of them: leading dimensions as q's."""
import xml.etree.ElementTree as ElementTree
import numpy as np


def numbers(text):
    return np.array([float(word) for word in text.split()])


def rpy(angles):
    (sr, sp, sy), (cr, cp, cy) = np.sin(angles), np.cos(angles)
    return np.array([[cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
                     [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr], [-sp, cp * sr, cp * cr]])


def chain(urdf, base, tip):
    """Joints from base to tip: rotation and translation of each, its axis (None: fixed)."""
    by_child = {j.find("child").get("link"): j for j in ElementTree.parse(urdf).getroot().iter("joint") if j.find("child") is not None}
    joints = []
    while tip != base:
        joint = by_child[tip]
        origin = joint.find("origin")
        at = {} if origin is None else origin.attrib
        axis = None
        if joint.get("type") != "fixed":
            axis = numbers(joint.find("axis").get("xyz"))
            axis /= np.linalg.norm(axis)
        joints.insert(0, (rpy(numbers(at.get("rpy", "0 0 0"))), numbers(at.get("xyz", "0 0 0")), axis))
        tip = joint.find("parent").get("link")
    return joints


def turned(axis, angle):
    """Rodrigues; angle a number or n of them."""
    angle = np.asarray(angle)[..., None, None]
    k = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * (k @ k)


def times(matrix, vector):
    return (matrix @ vector[..., None])[..., 0]


class Posture:
    """Rotation and origin of the flange, directions and points of the axes (..., 6, 3)."""

    def __init__(self, joints, q):
        self.rotation = np.broadcast_to(np.eye(3), q.shape[:-1] + (3, 3))
        self.origin = np.zeros(q.shape[:-1] + (3,))
        axes, points, i = [], [], 0
        for turn, step, axis in joints:
            self.origin = self.origin + self.rotation @ step
            self.rotation = self.rotation @ turn
            if axis is None:
                continue
            axes.append(self.rotation @ axis)
            points.append(self.origin)
            self.rotation = self.rotation @ turned(axis, q[..., i])
            i += 1
        self.axes, self.points = np.stack(axes, -2), np.stack(points, -2)

    def levers(self, point):
        """Velocity of a point by each joint (..., 6, 3)."""
        return np.cross(self.axes, point[..., None, :] - self.points)

    def jacobian(self, point):
        return np.swapaxes(np.concatenate([self.levers(point), self.axes], -1), -1, -2)

    def places(self, targets):
        """Targets (t, 3) given in the flange: (..., t, 3)."""
        return self.origin[..., None, :] + targets @ np.swapaxes(self.rotation, -1, -2)

    def torque(self, point, force, moment):
        """J_w^T W (..., 6)."""
        return times(self.levers(point), force) + times(self.axes, moment)

    def rows(self, places, torque):
        """A_j = J_m,j torque_j of the positions of `places` (..., t, 3): (..., 3 t, 6)."""
        columns = np.cross(self.axes[..., None, :, :], places[..., :, None, :] - self.points[..., None, :, :])
        rows = np.swapaxes(columns * torque[..., None, :, None], -1, -2)
        return rows.reshape(rows.shape[:-3] + (-1, 6))

    def geometric_stiffness(self, point, force, moment):
        """K_c: z_a . ((z_b x (x - p_b)) x F) for a <= b, symmetric; a moment keeps its direction."""
        by_force = self.axes @ np.swapaxes(np.cross(self.levers(point), force[..., None, :]), -1, -2)
        by_moment = self.axes @ np.swapaxes(np.cross(self.axes, moment[..., None, :]), -1, -2)
        return np.triu(by_force) + np.swapaxes(np.triu(by_force, 1) + np.triu(by_moment, 1), -1, -2)


def spring_torque(torque, geometric, compliance):
    """s = torque + K_c c s."""
    return np.linalg.solve(np.eye(6) - geometric * compliance, torque[..., None])[..., 0]
