"""The PowerCube arm in MuJoCo, behind the body contract."""

from __future__ import annotations

from collections.abc import Mapping

import mujoco
import numpy as np

from tailor.schemas.messages import JointState, MotorCurrents
from tailor.simnodes.body import Reading
from tailor.simnodes.powercube.motor import PERIOD_NS, Motor
from tailor.simnodes.powercube.physical_parameters import NAMES, WRITING, PhysicalParameters
from tailor.simnodes.powercube.scene import load_scene

STATE_PERIOD_NS = 20_000_000
CURRENT_PERIOD_NS = 100_000_000
BRAKED = NAMES[len(WRITING) :]


class PowerCubeBody:
    """See `Body`. Start values: a, b (rad), wa, wb (rad/s): pan and lift, as in the paper's Table 6."""

    robot = "powercube"
    names: tuple[str, ...] = ("a", "wa", "b", "wb")

    def __init__(self, parameters: PhysicalParameters | None = None) -> None:
        self._p = parameters or PhysicalParameters()
        self._model = model = load_scene()
        self._data = data = mujoco.MjData(model)
        self._motors = (Motor(self._p), Motor(self._p))
        # views into model and state, looked up once: a look-up by name costs as much as a physics step
        self._joints = tuple(model.joint(name) for name in WRITING)
        self._coulomb_nm, self._viscous_nms = self._joints[0].frictionloss.item(), self._joints[0].damping.item()
        self._rest_rad = {name: model.joint(name).qpos_spring.item() for name in BRAKED}
        self._qpos = tuple(data.joint(name).qpos for name in NAMES)
        self._qvel = tuple(data.joint(name).qvel for name in NAMES)
        self._ctrl = tuple(data.actuator(name).ctrl for name in WRITING)
        self._pen = data.site("pen").xpos
        self._torque_nm_per_a = [self._p.torque_nm_per_a, self._p.torque_nm_per_a]
        self._peaks_a = [0.0, 0.0]
        self._time_ns = 0

    def reset(self, rng: np.random.Generator, start: Mapping[str, float]) -> None:
        """See Body.reset; defaults are 0. Friction and strength of the motors are drawn anew."""
        mujoco.mj_resetData(self._model, self._data)
        p = self._p
        friction = np.clip(1.0 + p.friction_std * rng.standard_normal(2), 0.5, 1.5)
        for joint, factor in zip(self._joints, friction, strict=True):
            joint.frictionloss[0], joint.damping[0] = self._coulomb_nm * factor, self._viscous_nms * factor
        strength = np.clip(1.0 + p.torque_std * rng.standard_normal(2), 0.8, 1.2)
        self._torque_nm_per_a = (p.torque_nm_per_a * strength).tolist()
        for name, rest_rad in self._rest_rad.items():
            self._data.joint(name).qpos[0] = rest_rad
        self._time_ns = 0
        self._place(dict.fromkeys(self.names, 0.0) | dict(start))

    def place(self, values: Mapping[str, float]) -> None:
        """Move the arm (any of a, b, wa, wb); values left out stay."""
        self._place(self._state() | dict(values))

    def command(self, values: tuple[float, ...]) -> None:
        """Velocity set-points (pan, lift) in rad/s."""
        for motor, value in zip(self._motors, values, strict=True):
            motor.accept(value)

    def advance(self, duration_ns: int) -> list[Reading]:
        """See Body.advance; joint_states 50 Hz, currents and joint_truth 10 Hz."""
        end_ns = self._time_ns + duration_ns
        readings: list[Reading] = []
        while self._time_ns < end_ns:
            until_ns = min((self._time_ns // STATE_PERIOD_NS + 1) * STATE_PERIOD_NS, end_ns)
            self._drive((until_ns - self._time_ns) // PERIOD_NS)
            self._time_ns = until_ns
            if until_ns % STATE_PERIOD_NS == 0:
                readings += self._sense()
        return readings

    def ground_truth(self) -> JointState:
        """Exact angles and velocities, and the torques (N·m) of the motors."""
        angles, velocities = (tuple(view.item() for view in views) for views in (self._qpos, self._qvel))
        torques = (*(view.item() for view in self._ctrl), *(0.0 for _ in BRAKED))
        return JointState(self._time_ns, NAMES, angles, velocities, torques)

    def pen_m(self) -> tuple[float, float, float]:
        """Position of the pen's tip in metres: x ahead and y left of the shoulder, z above the floor."""
        x, y, z = self._pen.tolist()
        return x, y, z

    def _drive(self, periods: int) -> None:
        """Step the current loops and the physics together."""
        model, data, count = self._model, self._data, self._p.count_rad
        pan, lift = self._motors
        pan_angle, lift_angle, *_ = self._qpos
        pan_ctrl, lift_ctrl = self._ctrl
        pan_nm, lift_nm = self._torque_nm_per_a
        peak_pan, peak_lift = self._peaks_a
        for _ in range(periods):
            current_a = pan.tick(round(pan_angle.item() / count) * count)
            current_b = lift.tick(round(lift_angle.item() / count) * count)
            pan_ctrl[0], lift_ctrl[0] = current_a * pan_nm, current_b * lift_nm
            mujoco.mj_step(model, data)
            peak_pan, peak_lift = max(peak_pan, abs(current_a)), max(peak_lift, abs(current_b))
        self._peaks_a = [peak_pan, peak_lift]

    def _sense(self) -> list[Reading]:
        now_ns, count = self._time_ns, self._p.count_rad
        angles = tuple(round(angle / count) * count for angle in (view.item() for view in self._qpos))
        still = (0.0,) * len(BRAKED)
        velocities = tuple(motor.tacho for motor in self._motors) + still
        currents = tuple(motor.current_a for motor in self._motors)
        # a driver measures its currents; torques follow from the catalogue's constant
        efforts = tuple(current * self._p.torque_nm_per_a for current in currents) + still
        readings = [Reading("joint_states", JointState(now_ns, NAMES, angles, velocities, efforts), now_ns)]
        if now_ns % CURRENT_PERIOD_NS == 0:
            measured = MotorCurrents(now_ns, WRITING, currents, tuple(self._peaks_a))
            readings += [Reading("currents", measured, now_ns), Reading("joint_truth", self.ground_truth(), now_ns)]
            self._peaks_a = [abs(current) for current in currents]
        return readings

    def _state(self) -> dict[str, float]:
        a, b, wa, wb = (view.item() for view in (*self._qpos[:2], *self._qvel[:2]))
        return {"a": a, "b": b, "wa": wa, "wb": wb}

    def _place(self, state: Mapping[str, float]) -> None:
        """Put the arm, its motors already carrying it."""
        self._data.qvel[:] = 0.0
        for name, angle, velocity in zip(("a", "b"), self._qpos, self._qvel, strict=False):
            angle[0], velocity[0] = state[name], state["w" + name]
        mujoco.mj_forward(self._model, self._data)
        joints = (self._data.joint(name) for name in WRITING)
        loads = [joint.qfrc_bias.item() - joint.qfrc_passive.item() for joint in joints]
        for motor, name, load, strength in zip(self._motors, ("a", "b"), loads, self._torque_nm_per_a, strict=True):
            motor.reset(state[name], state["w" + name], load / strength)
        self._peaks_a = [0.0, 0.0]
