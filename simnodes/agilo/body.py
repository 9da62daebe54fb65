"""The AGILO robot and its ball in MuJoCo, behind the body contract."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict

import mujoco
import numpy as np

from tailor.schemas.messages.soccer import SoccerGroundTruth
from tailor.simnodes.agilo import firmware as fw
from tailor.simnodes.agilo.opponents import NAMES, Opponents
from tailor.simnodes.agilo.physical_parameters import PhysicalParameters
from tailor.simnodes.agilo.scene import load_scene
from tailor.simnodes.agilo.sensing import Sensing, Sensors
from tailor.simnodes.body import Reading
from tailor.simnodes.planar_sensing import POSE_PERIOD_NS

TRUTH_PERIOD_NS = 100_000_000
FAR_M = 50.0  # a ball that the start does not place
ROBOT = ("x", "y", "phi", "v", "omega")
BALL = ("ball_x", "ball_y", "ball_vx", "ball_vy")


class AgiloBody:
    """See `Body`. Start values: ROBOT, BALL and opponents.NAMES (SI, field frame)."""

    robot = "agilo"
    names: tuple[str, ...] = (*ROBOT, *BALL, *NAMES)

    def __init__(self, parameters: PhysicalParameters | None = None, sensing: Sensing | None = None) -> None:
        self._sensing = sensing or Sensing()
        self._model = model = load_scene(parameters or PhysicalParameters())
        self._data = data = mujoco.MjData(model)
        self._step_ns = round(model.opt.timestep * 1e9)
        self._wheel_radius_m: float = model.geom("left").size.item(0)
        self._track_m: float = 2 * model.body("left").pos.item(1)
        self._ball_radius_m: float = model.geom("ball").size.item(0)
        # views into the state, looked up once: a look-up by name costs as much as a physics step
        self._robot_qpos, self._robot_qvel = data.joint("robot").qpos, data.joint("robot").qvel
        self._ball_qpos, self._ball_qvel = data.joint("ball").qpos, data.joint("ball").qvel
        self._left_qvel, self._right_qvel = data.joint("left").qvel, data.joint("right").qvel
        self._left_ctrl, self._right_ctrl = data.actuator("left").ctrl, data.actuator("right").ctrl
        self._sensors = Sensors(self._sensing)
        self._firmware = fw.Firmware(self._track_m)
        self._opponents = Opponents(model, data)
        self._time_ns = 0
        self._pending: list[Reading] = []

    def reset(self, rng: np.random.Generator, start: Mapping[str, float]) -> None:
        """See Body.reset; defaults are 0, a ball far away, and no opponents."""
        mujoco.mj_resetData(self._model, self._data)
        self._opponents.reset()
        self._sensors.reset(rng)
        self._firmware.reset(0.0, 0.0)
        self._time_ns = 0
        self._pending = []
        self.place({**dict.fromkeys((*ROBOT, *BALL), 0.0), "ball_x": FAR_M, "ball_y": FAR_M, **start})

    def place(self, values: Mapping[str, float]) -> None:
        """Move the robot, the ball or opponents; values left out stay."""
        current = asdict(self.ground_truth())
        if any(name in values for name in ROBOT):
            self._place_robot({**current, **values})
        if any(name.startswith("ball_") for name in values):
            self._place_ball({**current, **values})
        self._opponents.place(values)
        mujoco.mj_forward(self._model, self._data)

    def command(self, values: tuple[float, ...]) -> None:
        """Set-point (v m/s, omega rad/s)."""
        self._firmware.accept(values[0], values[1])

    def advance(self, duration_ns: int) -> list[Reading]:
        """See Body.advance; odom 50 Hz, pose, ball and opponents 12.5 Hz, truth 10 Hz."""
        end_ns = self._time_ns + duration_ns
        readings: list[Reading] = []
        while self._time_ns < end_ns:
            if self._time_ns % fw.PERIOD_NS == 0:
                self._drive()
            boundary_ns = (self._time_ns // fw.PERIOD_NS + 1) * fw.PERIOD_NS
            until_ns = min(boundary_ns, end_ns)
            self._step((until_ns - self._time_ns) // self._step_ns)
            self._time_ns = until_ns
            if until_ns == boundary_ns:
                readings += self._sense()
        return readings

    def _step(self, count: int) -> None:
        """Step the physics; among opponents one by one, since a graze may last for one step alone."""
        if not self._opponents.standing:
            mujoco.mj_step(self._model, self._data, nstep=count)
            return
        for _ in range(count):
            mujoco.mj_step(self._model, self._data)
            self._opponents.watch()

    def ground_truth(self) -> SoccerGroundTruth:
        """True poses and velocities of robot and ball, field frame."""
        x, y, phi = self._pose()
        vx, vy, _, _, _, omega = self._robot_qvel.tolist()
        ball_x, ball_y, *_ = self._ball_qpos.tolist()
        ball_vx, ball_vy, *_ = self._ball_qvel.tolist()
        v = vx * math.cos(phi) + vy * math.sin(phi)
        return SoccerGroundTruth(self._time_ns, x, y, phi, v, omega, ball_x, ball_y, ball_vx, ball_vy)

    def _drive(self) -> None:
        v, omega = self._firmware.tick()
        rim = omega * self._track_m / 2
        self._left_ctrl[0] = (v - rim) / self._wheel_radius_m
        self._right_ctrl[0] = (v + rim) / self._wheel_radius_m

    def _sense(self) -> list[Reading]:
        """All readings of this firmware period; camera readings fall due after the camera's delay."""
        now_ns = self._time_ns
        left, right = self._left_qvel.item(), self._right_qvel.item()
        v = 0.5 * (left + right) * self._wheel_radius_m
        omega = (right - left) * self._wheel_radius_m / self._track_m
        readings = [Reading("odom", self._sensors.odometry(now_ns, v, omega, fw.PERIOD_S), now_ns)]
        if now_ns % POSE_PERIOD_NS == 0:
            self._take_picture(now_ns)
        while self._pending and self._pending[0].time_ns <= now_ns:
            readings.append(self._pending.pop(0))
        if now_ns % TRUTH_PERIOD_NS == 0:
            readings.append(Reading("truth", self.ground_truth(), now_ns))
            opponents = self._opponents.truth(now_ns)
            readings += [] if opponents is None else [Reading("opponents_truth", opponents, now_ns)]
        return readings

    def _take_picture(self, now_ns: int) -> None:
        x, y, phi = self._pose()
        ball_x, ball_y, *_ = self._ball_qpos.tolist()
        c, s = math.cos(phi), math.sin(phi)
        dx, dy = ball_x - x, ball_y - y
        due_ns = now_ns + self._sensing.camera_delay_ns
        pose = self._sensors.pose(now_ns, x, y, phi)
        if pose is not None:
            self._pending.append(Reading("pose", pose, due_ns))
        ball = self._sensors.ball(now_ns, c * dx + s * dy, c * dy - s * dx)
        if ball is not None:
            self._pending.append(Reading("ball", ball, due_ns))
        if self._opponents.standing:
            opponents = self._sensors.opponents(now_ns, (x, y, phi), self._opponents.standing.values())
            self._pending.append(Reading("opponents", opponents, due_ns))

    def _pose(self) -> tuple[float, float, float]:
        x, y, _, w, i, j, k = self._robot_qpos.tolist()
        return x, y, math.atan2(2 * (w * k + i * j), 1 - 2 * (j * j + k * k))

    def _place_robot(self, state: Mapping[str, float]) -> None:
        phi, v, omega = state["phi"], state["v"], state["omega"]
        half = 0.5 * phi
        height = self._wheel_radius_m
        self._robot_qpos[:] = (state["x"], state["y"], height, math.cos(half), 0, 0, math.sin(half))
        self._robot_qvel[:] = (v * math.cos(phi), v * math.sin(phi), 0, 0, 0, omega)
        rim = omega * self._track_m / 2
        self._left_qvel[0], self._right_qvel[0] = (v - rim) / height, (v + rim) / height
        self._firmware.reset(v, omega)

    def _place_ball(self, state: Mapping[str, float]) -> None:
        """Put the ball on the floor, rolling without slip."""
        radius, vx, vy = self._ball_radius_m, state["ball_vx"], state["ball_vy"]
        self._ball_qpos[:] = (state["ball_x"], state["ball_y"], radius, 1, 0, 0, 0)
        self._ball_qvel[:] = (vx, vy, 0, -vy / radius, vx / radius, 0)
