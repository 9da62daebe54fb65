"""The AGILO robot and its ball, or two, in MuJoCo, behind the body contract."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import asdict

import mujoco
import numpy as np

from tailor.schemas.messages.soccer import BallTruth, SoccerGroundTruth
from tailor.simnodes.agilo import ball, opponents
from tailor.simnodes.agilo import firmware as fw
from tailor.simnodes.agilo.opponents import NAMES, Opponents
from tailor.simnodes.agilo.physical_parameters import PhysicalParameters
from tailor.simnodes.agilo.scene import load_scene
from tailor.simnodes.agilo.sensing import Sensing, Sensors
from tailor.simnodes.body import Reading
from tailor.simnodes.planar_sensing import POSE_PERIOD_NS

TRUTH_PERIOD_NS = 100_000_000
ROBOT = ("x", "y", "phi", "v", "omega")
BALL, BALL2 = ball.names("ball"), ball.names("ball2")


class AgiloBody:
    """See `Body`. Start values: ROBOT, BALL, opponents.NAMES and BALL2 (SI, field frame).

    A second ball is simulated from when it is placed until the next reset.
    """

    robot = "agilo"
    names: tuple[str, ...] = (*ROBOT, *BALL, *NAMES, *BALL2)

    def __init__(self, parameters: PhysicalParameters | None = None, sensing: Sensing | None = None) -> None:
        self._parameters = parameters or PhysicalParameters()
        self._sensing = sensing or Sensing()
        self._sensors = Sensors(self._sensing)
        self._time_ns = 0
        self._pending: list[Reading] = []
        self._load(second_ball=False)
        self._firmware = fw.Firmware(self._track_m)

    def _load(self, second_ball: bool) -> None:
        """Compile the scene anew, everything at its place in scene.xml."""
        self._model = model = load_scene(self._parameters, second_ball)
        self._data = data = mujoco.MjData(model)
        self._step_ns = round(model.opt.timestep * 1e9)
        self._wheel_radius_m: float = model.geom("left").size.item(0)
        self._track_m: float = 2 * model.body("left").pos.item(1)
        # views into the state, looked up once: a look-up by name costs as much as a physics step
        self._robot_qpos, self._robot_qvel = data.joint("robot").qpos, data.joint("robot").qvel
        self._left_qvel, self._right_qvel = data.joint("left").qvel, data.joint("right").qvel
        self._left_ctrl, self._right_ctrl = data.actuator("left").ctrl, data.actuator("right").ctrl
        self._ball = ball.Ball(model, data)
        self._ball2 = ball.Ball(model, data, "ball2") if second_ball else None
        self._opponents = Opponents(model, data)

    def reset(self, rng: np.random.Generator, start: Mapping[str, float]) -> None:
        """See Body.reset; defaults are 0, a ball far away, no opponents and no second ball."""
        if self._ball2 is not None:
            self._load(second_ball=False)
        mujoco.mj_resetData(self._model, self._data)
        self._opponents.reset()
        self._sensors.reset(rng)
        self._firmware.reset(0.0, 0.0)
        self._time_ns = 0
        self._pending = []
        self.place({**dict.fromkeys((*ROBOT, *BALL), 0.0), "ball_x": ball.FAR_M, "ball_y": ball.FAR_M, **start})

    def place(self, values: Mapping[str, float]) -> None:
        """Move the robot, balls or opponents; values left out stay."""
        if self._ball2 is None and any(name in values for name in BALL2):
            self._add_second_ball()
        if any(name in values for name in ROBOT):
            self._place_robot({**asdict(self.ground_truth()), **values})
        for each in self._balls():
            each.place(values)
        self._opponents.place(values)
        mujoco.mj_forward(self._model, self._data)

    def refusal(self, values: Mapping[str, float]) -> str:
        """See Body: opponents are solid."""
        return opponents.refusal(values)

    def command(self, values: tuple[float, ...]) -> None:
        """Set-point (v m/s, omega rad/s)."""
        self._firmware.accept(values[0], values[1])

    def advance(self, duration_ns: int) -> list[Reading]:
        """See Body.advance; odom 50 Hz, pose, balls and opponents 12.5 Hz, truth 10 Hz."""
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
        """True poses and velocities of robot and first ball, field frame."""
        x, y, phi = self._pose()
        vx, vy, _, _, _, omega = self._robot_qvel.tolist()
        v = vx * math.cos(phi) + vy * math.sin(phi)
        return SoccerGroundTruth(self._time_ns, x, y, phi, v, omega, *self._ball.state())

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
            readings += self._truths(now_ns)
        return readings

    def _truths(self, now_ns: int) -> Iterator[Reading]:
        yield Reading("truth", self.ground_truth(), now_ns)
        opponents = self._opponents.truth(now_ns)
        if opponents is not None:
            yield Reading("opponents_truth", opponents, now_ns)
        if self._ball2 is not None:
            yield Reading("ball2_truth", BallTruth(now_ns, *self._ball2.state()), now_ns)

    def _take_picture(self, now_ns: int) -> None:
        x, y, phi = self._pose()
        c, s = math.cos(phi), math.sin(phi)
        due_ns = now_ns + self._sensing.camera_delay_ns
        pose = self._sensors.pose(now_ns, x, y, phi)
        if pose is not None:
            self._pending.append(Reading("pose", pose, due_ns))
        for each in self._balls():
            ball_x, ball_y, *_ = each.state()
            dx, dy = ball_x - x, ball_y - y
            seen = self._sensors.ball(now_ns, c * dx + s * dy, c * dy - s * dx)
            if seen is not None:
                self._pending.append(Reading(each.name, seen, due_ns))
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

    def _balls(self) -> tuple[ball.Ball, ...]:
        return (self._ball,) if self._ball2 is None else (self._ball, self._ball2)

    def _add_second_ball(self) -> None:
        """Go on in a scene with a second ball, which comes last in its state; everything else stays as it is."""
        old, opponents = self._data, self._opponents
        self._load(second_ball=True)
        for name in ("qpos", "qvel", "ctrl", "qacc_warmstart"):
            values = getattr(old, name)
            getattr(self._data, name)[: len(values)] = values
        self._opponents.take_over(opponents)
