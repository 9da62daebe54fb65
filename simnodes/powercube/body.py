"""The PowerCube arm in MuJoCo, behind the body contract."""

from __future__ import annotations

from collections.abc import Mapping

import mujoco
import numpy as np

from tailor.schemas.messages import JointState, MotorCurrents
from tailor.simnodes.body import Reading
from tailor.simnodes.powercube.gear import Gear
from tailor.simnodes.powercube.motor import PERIOD_NS, PERIOD_S, Motor
from tailor.simnodes.powercube.physical_parameters import NAMES, WRITING, PhysicalParameters
from tailor.simnodes.powercube.scene import load_scene

STATE_PERIOD_NS = 20_000_000
STATE_PERIOD_S = STATE_PERIOD_NS * 1e-9
CURRENT_PERIOD_NS = 100_000_000
BRAKED = NAMES[len(WRITING) :]


class PowerCubeBody:
    """See `Body`. Start values of pan and lift: a, b (rad), wa, wb (rad/s), as in the paper's Table 6; ta, tb (°C).

    `gears` hold temperature and backlash of pan and lift.
    """

    robot = "powercube"
    names: tuple[str, ...] = ("a", "wa", "b", "wb", "ta", "tb")

    def __init__(self, parameters: PhysicalParameters | None = None) -> None:
        self._p = parameters or PhysicalParameters()
        self._model = model = load_scene()
        self._data = data = mujoco.MjData(model)
        self._motors = (Motor(self._p), Motor(self._p))
        # views into model and state, looked up once: a look-up by name costs as much as a physics step
        self._joints = tuple(model.joint(name) for name in WRITING)
        self.gears = tuple(Gear(self._p, j.frictionloss.item(), j.damping.item()) for j in self._joints)
        self._rest_rad = {name: model.joint(name).qpos_spring.item() for name in BRAKED}
        self._qpos = tuple(data.joint(name).qpos for name in NAMES)
        self._qvel = tuple(data.joint(name).qvel for name in NAMES)
        self._ctrl = tuple(data.actuator(name).ctrl for name in WRITING)
        self._pen = data.site("pen").xpos
        self._bias = data.qfrc_bias
        self._rng = np.random.default_rng(0)
        self._torque_nm_per_a = [self._p.torque_nm_per_a, self._p.torque_nm_per_a]
        self._peaks_a = [0.0, 0.0]
        self._time_ns = 0

    def reset(self, rng: np.random.Generator, start: Mapping[str, float]) -> None:
        """See Body.reset; defaults are 0. Wear, strength, and temperatures left out are drawn anew."""
        mujoco.mj_resetData(self._model, self._data)
        self._rng = rng
        for gear in self.gears:
            gear.reset(rng)
        strength = np.clip(1.0 + self._p.torque_std * rng.standard_normal(2), 0.8, 1.2)
        self._torque_nm_per_a = (self._p.torque_nm_per_a * strength).tolist()
        for name, rest_rad in self._rest_rad.items():
            self._data.joint(name).qpos[0] = rest_rad
        self._time_ns = 0
        self._place(self._state() | dict.fromkeys(("a", "wa", "b", "wb"), 0.0) | dict(start))

    def place(self, values: Mapping[str, float]) -> None:
        """Move the arm, or warm its gears; values left out stay."""
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
                self._heat()
                self._set_friction()
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
        (pan, lift), (pan_gear, lift_gear) = self._motors, self.gears
        pan_angle, lift_angle, *_ = self._qpos
        pan_ctrl, lift_ctrl = self._ctrl
        pan_nm, lift_nm = self._torque_nm_per_a
        peak_pan, peak_lift = self._peaks_a
        pan_ahead, lift_ahead = pan_gear.ahead_rad, lift_gear.ahead_rad
        gap, slip = pan_gear.half_gap_rad, PERIOD_S / self._p.film_nms
        for _ in range(periods):
            current_a = pan.tick(round((pan_angle.item() + pan_ahead) / count) * count)
            current_b = lift.tick(round((lift_angle.item() + lift_ahead) / count) * count)
            pan_ctrl[0], lift_ctrl[0] = torque_a, torque_b = current_a * pan_nm, current_b * lift_nm
            mujoco.mj_step(model, data)
            # comparisons: calls of min and max would take a tenth of the simulation's time
            pan_ahead += slip * torque_a
            if not -gap <= pan_ahead <= gap:
                pan_ahead = gap if pan_ahead > 0.0 else -gap
            lift_ahead += slip * torque_b
            if not -gap <= lift_ahead <= gap:
                lift_ahead = gap if lift_ahead > 0.0 else -gap
            if not -peak_pan <= current_a <= peak_pan:
                peak_pan = abs(current_a)
            if not -peak_lift <= current_b <= peak_lift:
                peak_lift = abs(current_b)
        pan_gear.ahead_rad, lift_gear.ahead_rad = pan_ahead, lift_ahead
        self._peaks_a = [peak_pan, peak_lift]

    def _heat(self) -> None:
        """Warm the gears by what was lost since the last state."""
        for gear, motor, velocity, load in zip(self.gears, self._motors, self._qvel, self._bias, strict=False):
            speed = abs(velocity.item())
            coulomb_nm, viscous_nms = gear.friction(load)
            copper_w = self._p.winding_ohm * motor.current_a**2
            gear.heat(copper_w + speed * (coulomb_nm + viscous_nms * speed), STATE_PERIOD_S)

    def _set_friction(self) -> None:
        for gear, joint, load in zip(self.gears, self._joints, self._bias, strict=False):
            joint.frictionloss[0], joint.damping[0] = gear.friction(load)

    def _sense(self) -> list[Reading]:
        now_ns, p = self._time_ns, self._p
        angles, velocities, currents = self._measured(), self._velocities(), self._currents()
        # a driver measures its currents; torques follow from the catalogue's constant
        efforts = tuple(current * p.torque_nm_per_a for current in currents) + (0.0,) * len(BRAKED)
        readings = [Reading("joint_states", JointState(now_ns, NAMES, angles, velocities, efforts), now_ns)]
        if now_ns % CURRENT_PERIOD_NS == 0:
            measured = MotorCurrents(now_ns, WRITING, currents, tuple(self._peaks_a))
            readings += [Reading("currents", measured, now_ns), Reading("joint_truth", self.ground_truth(), now_ns)]
            self._peaks_a = [abs(motor.current_a) for motor in self._motors]
        return readings

    def _measured(self) -> tuple[float, ...]:
        """Angles in whole counts of the encoders, which sit on the motors, each read a little early or late."""
        p, angles = self._p, [view.item() for view in self._qpos]
        errors, late_s = self._rng.standard_normal((2, len(WRITING))) * ((p.encoder_std_rad,), (p.read_jitter_s,))
        for k, gear in enumerate(self.gears):
            angles[k] += gear.ahead_rad + errors[k].item() + late_s[k].item() * self._qvel[k].item()
        return tuple(round(angle / p.count_rad) * p.count_rad for angle in angles)

    def _velocities(self) -> tuple[float, ...]:
        errors = (self._p.tacho_std_radps * self._rng.standard_normal(len(WRITING))).tolist()
        moving = (motor.tacho + error for motor, error in zip(self._motors, errors, strict=True))
        return (*moving, *(0.0 for _ in BRAKED))

    def _currents(self) -> tuple[float, ...]:
        errors = (self._p.current_std_a * self._rng.standard_normal(len(WRITING))).tolist()
        return tuple(motor.current_a + error for motor, error in zip(self._motors, errors, strict=True))

    def _state(self) -> dict[str, float]:
        a, b, wa, wb = (view.item() for view in (*self._qpos[:2], *self._qvel[:2]))
        warm_a, warm_b = (gear.temperature_c for gear in self.gears)
        return {"a": a, "b": b, "wa": wa, "wb": wb, "ta": warm_a, "tb": warm_b}

    def _place(self, state: Mapping[str, float]) -> None:
        """Put the arm, its motors already carrying it."""
        self._data.qvel[:] = 0.0
        for name, angle, velocity, gear in zip(("a", "b"), self._qpos, self._qvel, self.gears, strict=False):
            angle[0], velocity[0], gear.temperature_c = state[name], state["w" + name], state["t" + name]
        mujoco.mj_forward(self._model, self._data)
        self._set_friction()
        mujoco.mj_forward(self._model, self._data)  # again, with the friction of the loads
        joints = (self._data.joint(name) for name in WRITING)
        loads = [joint.qfrc_bias.item() - joint.qfrc_passive.item() for joint in joints]
        for k, (motor, gear, name) in enumerate(zip(self._motors, self.gears, ("a", "b"), strict=True)):
            gear.preload(loads[k])
            motor.reset(state[name] + gear.ahead_rad, state["w" + name], loads[k] / self._torque_nm_per_a[k])
        self._peaks_a = [0.0, 0.0]
