"""The PowerCube arm in MuJoCo, behind the body contract."""

from __future__ import annotations

from collections.abc import Mapping

import mujoco
import numpy as np

from tailor.schemas.messages import JointState, MotorCurrents
from tailor.simnodes.body import Reading
from tailor.simnodes.powercube.motor import PERIOD_NS, Motor
from tailor.simnodes.powercube.physical_parameters import MODULES, NAMES, WRITING, PhysicalParameters
from tailor.simnodes.powercube.scene import PEN, compile_scene

STATE_PERIOD_NS = 20_000_000
CURRENT_PERIOD_NS = 100_000_000
PAN, LIFT = 0, 1  # offsets into qpos, qvel and ctrl
LEGAL = ("a", "wa", "b", "wb")


class PowerCubeBody:
    """See `Body`. Start values: a, b (rad), wa, wb (rad/s): pan and lift, as in the paper's Table 6."""

    robot = "powercube"
    names: tuple[str, ...] = LEGAL

    def __init__(self, physical_parameters: PhysicalParameters | None = None) -> None:
        self._p = physical_parameters or PhysicalParameters()
        self._model = compile_scene(self._p)
        self._data = mujoco.MjData(self._model)
        self._motors = (Motor(self._p), Motor(self._p))
        self._pen = self._model.site(PEN).id
        self._torque_nm_per_a = [self._p.torque_nm_per_a, self._p.torque_nm_per_a]
        self._peaks_a = [0.0, 0.0]
        self._time_ns = 0

    def reset(self, rng: np.random.Generator, start: Mapping[str, float]) -> None:
        """Put the arm; what is not named is 0. How stiff its grease and how strong its magnets are is drawn anew."""
        mujoco.mj_resetData(self._model, self._data)
        p = self._p
        friction = np.clip(1.0 + p.friction_spread * rng.standard_normal(2), 0.5, 1.5)
        self._model.dof_frictionloss[: len(WRITING)] = p.coulomb_nm * friction
        self._model.dof_damping[: len(WRITING)] = p.viscous_nms * friction
        strength = np.clip(1.0 + p.torque_spread * rng.standard_normal(2), 0.8, 1.2)
        self._torque_nm_per_a = (p.torque_nm_per_a * strength).tolist()
        self._data.qpos[:] = [module.rest_rad for module in MODULES]
        self._time_ns = 0
        self._place(dict.fromkeys(LEGAL, 0.0) | dict(start))

    def place(self, values: Mapping[str, float]) -> None:
        """Move the arm, with any of a, b, wa, wb; what is not named stays as it is."""
        self._place(self._state() | dict(values))

    def command(self, values: tuple[float, ...]) -> None:
        """Velocity set-points (pan, lift) in rad/s."""
        self._motors[PAN].accept(values[0])
        self._motors[LIFT].accept(values[1])

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
        torques = (*self._data.ctrl.tolist(), *(0.0 for _ in NAMES[len(WRITING) :]))
        return JointState(
            self._time_ns, NAMES, tuple(self._data.qpos.tolist()), tuple(self._data.qvel.tolist()), torques
        )

    def pen_m(self) -> tuple[float, float, float]:
        """Where the pen's tip is: x ahead, y left, z up of the floor below the shoulder."""
        x, y, z = self._data.site_xpos[self._pen].tolist()
        return x, y, z

    def _drive(self, periods: int) -> None:
        """The current loops and the physics, in step."""
        model, data, count = self._model, self._data, self._p.count_rad
        pan, lift = self._motors
        pan_nm, lift_nm = self._torque_nm_per_a
        peak_pan, peak_lift = self._peaks_a
        for _ in range(periods):
            a, b = data.qpos[: LIFT + 1].tolist()
            current_a, current_b = pan.tick(round(a / count) * count), lift.tick(round(b / count) * count)
            data.ctrl[:] = (current_a * pan_nm, current_b * lift_nm)
            mujoco.mj_step(model, data)
            peak_pan, peak_lift = max(peak_pan, abs(current_a)), max(peak_lift, abs(current_b))
        self._peaks_a = [peak_pan, peak_lift]

    def _sense(self) -> list[Reading]:
        now_ns, count = self._time_ns, self._p.count_rad
        angles = tuple(round(angle / count) * count for angle in self._data.qpos.tolist())
        still = (0.0,) * (len(NAMES) - len(WRITING))
        velocities = tuple(motor.tacho for motor in self._motors) + still
        currents = tuple(motor.current_a for motor in self._motors)
        # the driver knows its currents, and what a newton metre takes by the catalogue
        efforts = tuple(current * self._p.torque_nm_per_a for current in currents) + still
        readings = [Reading("joint_states", JointState(now_ns, NAMES, angles, velocities, efforts), now_ns)]
        if now_ns % CURRENT_PERIOD_NS == 0:
            told = MotorCurrents(now_ns, WRITING, currents, tuple(self._peaks_a))
            readings += [Reading("currents", told, now_ns), Reading("joint_truth", self.ground_truth(), now_ns)]
            self._peaks_a = [abs(current) for current in currents]
        return readings

    def _state(self) -> dict[str, float]:
        a, b = self._data.qpos[: LIFT + 1].tolist()
        wa, wb = self._data.qvel[: LIFT + 1].tolist()
        return {"a": a, "b": b, "wa": wa, "wb": wb}

    def _place(self, state: Mapping[str, float]) -> None:
        """Put the arm, its motors already carrying it."""
        self._data.qpos[: LIFT + 1] = (state["a"], state["b"])
        self._data.qvel[:] = (state["wa"], state["wb"], 0, 0, 0, 0)
        mujoco.mj_forward(self._model, self._data)
        loads = (self._data.qfrc_bias - self._data.qfrc_passive)[: LIFT + 1].tolist()
        for motor, name, load, strength in zip(self._motors, ("a", "b"), loads, self._torque_nm_per_a, strict=True):
            motor.reset(state[name], state["w" + name], load / strength)
        self._peaks_a = [0.0, 0.0]
