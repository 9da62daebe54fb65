"""The AGILO robot and its ball in MuJoCo, behind the body contract."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict

import mujoco
import numpy as np

from tailor.schemas.messages.soccer import SoccerGroundTruth
from tailor.simnodes.agilo import firmware as fw
from tailor.simnodes.agilo.physical_parameters import PhysicalParameters
from tailor.simnodes.agilo.scene import compile_scene
from tailor.simnodes.agilo.sensing import POSE_PERIOD_NS, Sensing, Sensors
from tailor.simnodes.body import STEP_NS, Reading

TRUTH_PERIOD_NS = 100_000_000
ROBOT, LEFT, BALL = 0, 7, 9  # offsets into qpos
ROBOT_V, LEFT_V, BALL_V = 0, 6, 8  # offsets into qvel


class AgiloBody:
    """See `Body`. Start values: x, y, phi, v, omega, ball_x, ball_y, ball_vx, ball_vy (SI, field frame)."""

    robot = "agilo"
    names: tuple[str, ...] = ("x", "y", "phi", "v", "omega", "ball_x", "ball_y", "ball_vx", "ball_vy")

    def __init__(self, physical_parameters: PhysicalParameters | None = None, sensing: Sensing | None = None) -> None:
        self._p = physical_parameters or PhysicalParameters()
        self._sensing = sensing or Sensing()
        self._model = compile_scene(self._p)
        self._data = mujoco.MjData(self._model)
        self._qpos, self._qvel, self._ctrl = self._data.qpos, self._data.qvel, self._data.ctrl  # looked up once
        self._sensors = Sensors(self._sensing)
        self._firmware = fw.Firmware(self._p.track_m)
        self._time_ns = 0
        self._pending: list[Reading] = []

    def reset(self, rng: np.random.Generator, start: Mapping[str, float]) -> None:
        """Put robot and ball; what is not named is 0, the ball far away."""
        mujoco.mj_resetData(self._model, self._data)
        self._sensors.reset(rng)
        self._firmware.reset(0.0, 0.0)
        self._time_ns = 0
        self._pending = []
        zero = {"x": 0.0, "y": 0.0, "phi": 0.0, "v": 0.0, "omega": 0.0, "ball_x": 50.0, "ball_y": 50.0}
        self.place({**zero, "ball_vx": 0.0, "ball_vy": 0.0, **start})

    def place(self, values: Mapping[str, float]) -> None:
        """Move the robot (with any of x, y, phi, v, omega) or the ball; what is not named stays as it is."""
        now = asdict(self.ground_truth())
        if any(name in values for name in ("x", "y", "phi", "v", "omega")):
            self._place_robot({**now, **values})
        if any(name.startswith("ball_") for name in values):
            self._place_ball({**now, **values})
        mujoco.mj_forward(self._model, self._data)

    def command(self, values: tuple[float, ...]) -> None:
        """Set-point (v m/s, omega rad/s)."""
        self._firmware.accept(values[0], values[1])

    def advance(self, duration_ns: int) -> list[Reading]:
        """See Body.advance; odom 50 Hz, pose and ball 12.5 Hz, truth 10 Hz."""
        end_ns = self._time_ns + duration_ns
        readings: list[Reading] = []
        while self._time_ns < end_ns:
            if self._time_ns % fw.PERIOD_NS == 0:
                self._drive()
            boundary_ns = (self._time_ns // fw.PERIOD_NS + 1) * fw.PERIOD_NS
            until_ns = min(boundary_ns, end_ns)
            mujoco.mj_step(self._model, self._data, nstep=(until_ns - self._time_ns) // STEP_NS)
            self._time_ns = until_ns
            if until_ns == boundary_ns:
                readings += self._sense()
        return readings

    def ground_truth(self) -> SoccerGroundTruth:
        """Pose and velocities of robot and ball, field frame."""
        x, y, phi = self._pose()
        vx, vy, _, _, _, omega, _, _, ball_vx, ball_vy = self._qvel[: BALL_V + 2].tolist()
        ball_x, ball_y = self._qpos[BALL : BALL + 2].tolist()
        v = vx * math.cos(phi) + vy * math.sin(phi)
        return SoccerGroundTruth(self._time_ns, x, y, phi, v, omega, ball_x, ball_y, ball_vx, ball_vy)

    def _drive(self) -> None:
        v, omega = self._firmware.tick()
        rim = omega * self._p.track_m / 2
        self._ctrl[0] = (v - rim) / self._p.wheel_radius_m
        self._ctrl[1] = (v + rim) / self._p.wheel_radius_m

    def _sense(self) -> list[Reading]:
        """All readings of this firmware period; camera readings fall due after the camera's delay."""
        now_ns = self._time_ns
        left, right = self._qvel.item(LEFT_V), self._qvel.item(LEFT_V + 1)
        v = 0.5 * (left + right) * self._p.wheel_radius_m
        omega = (right - left) * self._p.wheel_radius_m / self._p.track_m
        readings = [Reading("odom", self._sensors.odometry(now_ns, v, omega, fw.PERIOD_S), now_ns)]
        if now_ns % POSE_PERIOD_NS == 0:
            self._look(now_ns)
        while self._pending and self._pending[0].time_ns <= now_ns:
            readings.append(self._pending.pop(0))
        if now_ns % TRUTH_PERIOD_NS == 0:
            readings.append(Reading("truth", self.ground_truth(), now_ns))
        return readings

    def _look(self, now_ns: int) -> None:
        x, y, phi = self._pose()
        ball_x, ball_y = self._qpos[BALL : BALL + 2].tolist()
        c, s = math.cos(phi), math.sin(phi)
        dx, dy = ball_x - x, ball_y - y
        due_ns = now_ns + self._sensing.camera_delay_ns
        pose = self._sensors.pose(now_ns, x, y, phi)
        if pose is not None:
            self._pending.append(Reading("pose", pose, due_ns))
        ball = self._sensors.ball(now_ns, c * dx + s * dy, c * dy - s * dx)
        if ball is not None:
            self._pending.append(Reading("ball", ball, due_ns))

    def _pose(self) -> tuple[float, float, float]:
        x, y, _, w, i, j, k = self._qpos[ROBOT : ROBOT + 7].tolist()
        return x, y, math.atan2(2 * (w * k + i * j), 1 - 2 * (j * j + k * k))

    def _place_robot(self, state: Mapping[str, float]) -> None:
        phi, v, omega = state["phi"], state["v"], state["omega"]
        half = 0.5 * phi
        height = self._p.wheel_radius_m
        self._qpos[ROBOT : ROBOT + 7] = (state["x"], state["y"], height, math.cos(half), 0, 0, math.sin(half))
        self._qvel[ROBOT_V : ROBOT_V + 6] = (v * math.cos(phi), v * math.sin(phi), 0, 0, 0, omega)
        rim = omega * self._p.track_m / 2
        self._qvel[LEFT_V : LEFT_V + 2] = ((v - rim) / height, (v + rim) / height)
        self._firmware.reset(v, omega)

    def _place_ball(self, state: Mapping[str, float]) -> None:
        """Put the ball on the floor, rolling without slip."""
        radius, vx, vy = self._p.ball_radius_m, state["ball_vx"], state["ball_vy"]
        self._qpos[BALL : BALL + 7] = (state["ball_x"], state["ball_y"], radius, 1, 0, 0, 0)
        self._qvel[BALL_V : BALL_V + 6] = (vx, vy, 0, -vy / radius, vx / radius, 0)
