"""The B21 in its kitchen in PyBullet, behind the body contract."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from tailor.schemas.kitchen.furniture import Place, kitchen
from tailor.schemas.kitchen.kinematics import GRIPPER_MAX_M, HOME, JOINTS, tool_pose
from tailor.schemas.messages.kitchen import KitchenTruth
from tailor.schemas.packages.pose3 import on_plane
from tailor.simnodes.b21.cups import Cups
from tailor.simnodes.b21.engine import Engine, pybullet
from tailor.simnodes.b21.firmware import PERIOD_S, Firmware
from tailor.simnodes.b21.furnishing import MOVABLE, Furnishing
from tailor.simnodes.b21.grasp import Grasp
from tailor.simnodes.b21.physical_parameters import PhysicalParameters
from tailor.simnodes.b21.robot import Robot
from tailor.simnodes.b21.sensing import Sensing, Sensors
from tailor.simnodes.body import STEP_NS, Reading
from tailor.simnodes.planar_sensing import POSE_PERIOD_NS

GRAVITY_MPS2 = -9.81
STATE_NS, GRIPPER_NS, OBJECTS_NS, TRUTH_NS = 20_000_000, 50_000_000, 100_000_000, 100_000_000
ROBOT = ("x", "y", "phi", "v", "omega", *JOINTS, "width")
FURNITURE = tuple(f"{name}_{quantity}" for name in MOVABLE for quantity in ("x", "y", "phi"))
CUPS = tuple(f"{name}_{quantity}" for name in kitchen().cups for quantity in ("x", "y", "phi", "vx", "vy"))
MISCHIEF = ("held", "slip", "fumble")


class B21Body:
    """See `Body`. Start values, SI, map frame: ROBOT, FURNITURE, CUPS, MISCHIEF.

    Cups that the start does not place are not there. cupN_vx, cupN_vy push a cup; `held` is the number of a cup that
    the gripper holds, 0 for none: it drops what it holds, as at a `slip` of 1; `fumble` is a number of grasps to fail.
    """

    robot = "b21"
    names: tuple[str, ...] = (*ROBOT, *FURNITURE, *CUPS, *MISCHIEF)

    def __init__(self, parameters: PhysicalParameters | None = None, sensing: Sensing | None = None) -> None:
        self._p = parameters or PhysicalParameters()
        self._bullet = pybullet()
        self._sensors = Sensors(sensing or Sensing())
        self._firmware = Firmware()
        self._engine: Engine | None = None
        self.reset(np.random.default_rng(0), {})

    def reset(self, rng: np.random.Generator, start: Mapping[str, float]) -> None:
        """See Body.reset; by default all is where kitchen.toml has it, the arm at home, and there are no cups."""
        if self._engine is not None:
            self._engine.close()
        self._engine = Engine()
        client = self._engine.client
        self._bullet.setGravity(0, 0, GRAVITY_MPS2, physicsClientId=client)
        self._bullet.setPhysicsEngineParameter(
            fixedTimeStep=PERIOD_S,
            numSubSteps=self._p.substeps,
            numSolverIterations=self._p.iterations,
            deterministicOverlappingPairs=1,
            physicsClientId=client,
        )
        self._furniture = Furnishing(client, self._p)
        self._robot = Robot(client, self._p)
        self._cups = Cups(client, self._p)
        self._grasp = Grasp(client, self._p, self._robot, self._cups)
        self._touched: set[str] = set()
        self._sensors.reset(rng)
        self._time_ns = 0
        x, y, phi = kitchen().start
        home = dict(zip(JOINTS, HOME, strict=True))
        self.place({"x": x, "y": y, "phi": phi, "width": GRIPPER_MAX_M, **home, **start})

    @property
    def client(self) -> int:
        """Number of its world in PyBullet; another one after each reset."""
        assert self._engine is not None
        return self._engine.client

    def place(self, values: Mapping[str, float]) -> None:
        """Move robot, furniture or cups; push, drop, or make grasps fail. Values left out stay."""
        for name in MOVABLE:
            place = self._furniture.places[name]
            x, y, phi = (values.get(f"{name}_{q}", old) for q, old in zip(("x", "y", "phi"), place, strict=True))
            if (x, y, phi) != place:
                self._furniture.place(name, (x, y, phi))
        if any(name in values for name in ROBOT):
            self._place_robot(values)
        for name in kitchen().cups:
            self._place_cup(name, values)
        if values.get("slip", 0.0) > 0.0 or values.get("held") == 0.0:
            self._grasp.lose()
        if "fumble" in values:
            self._grasp.fumbles = round(values["fumble"])
        if values.get("held", 0.0) > 0.0:
            self._take(list(kitchen().cups)[round(values["held"]) - 1], values)

    def refusal(self, values: Mapping[str, float]) -> str:
        """See Body: only cups that there are can be held."""
        held, most = values.get("held", 0.0), len(kitchen().cups)
        return "" if held in range(most + 1) else f"held is {held:g}, expected the number of a cup, 1 to {most}, or 0"

    def command(self, values: tuple[float, ...]) -> None:
        """Set-points of base, arm and gripper in the order of driver.toml."""
        self._firmware.accept(values)

    def kept(self) -> tuple[float, ...]:
        """See Body: the gripper's present set-point, so that it goes on pressing what it holds."""
        return (*(0.0,) * (len(JOINTS) + 2), self._firmware.width)

    def advance(self, duration_ns: int) -> list[Reading]:
        """See Body.advance; rates are those of driver.toml, truth 10 Hz."""
        readings, client = list[Reading](), self.client
        for _ in range(duration_ns // STEP_NS):
            self._firmware.tick(self._robot.angles, self._robot.width)
            self._robot.drive(self._firmware, self._grasp.width)
            self._bullet.stepSimulation(physicsClientId=client)
            self._robot.read()
            self._feel()
            self._time_ns += STEP_NS
            readings += self._sense()
        return readings

    def ground_truth(self) -> KitchenTruth:
        """True state of robot, furniture and cups, map frame."""
        robot = self._robot
        return KitchenTruth(
            stamp_ns=self._time_ns,
            x=robot.x,
            y=robot.y,
            phi=robot.phi,
            v=robot.v,
            omega=robot.omega,
            width=robot.width,
            held=self._grasp.held,
            angles=robot.angles,
            touched=tuple(sorted(self._touched)),
            objects=(*self._furniture.objects(), *self._cups.objects()),
        )

    def _feel(self) -> None:
        """Take note of touched furniture and grasped cups."""
        left, right, furniture = set(), set(), self._furniture.names
        cups = {body: name for name, body in self._cups.bodies.items()}
        for contact in self._robot.contacts():
            other, link, force_n = contact[2], contact[3], contact[9]
            if other in furniture and contact[8] <= 0.0:
                self._touched.add(furniture[other])
            elif other in cups and force_n > self._p.pressed_n:
                if link == self._robot.fingers[0]:
                    left.add(cups[other])
                elif link == self._robot.fingers[1]:
                    right.add(cups[other])
        self._grasp.watch(left & right, self._firmware.target_width)

    def _sense(self) -> list[Reading]:
        now_ns, robot, sensors = self._time_ns, self._robot, self._sensors
        pose = (robot.x, robot.y, robot.phi)
        readings: list[Reading] = []
        if now_ns % STATE_NS == 0:
            odometry = sensors.odometry(now_ns, robot.v, robot.omega, STATE_NS * 1e-9)
            readings.append(Reading("odom", odometry, now_ns))
            readings.append(Reading("joint_states", sensors.joints(now_ns, robot.angles, robot.rates), now_ns))
        if now_ns % GRIPPER_NS == 0:
            force_n = self._p.grip_n if self._grasp.held else robot.squeeze_n  # it goes on pressing what it holds
            readings.append(Reading("gripper", sensors.gripper(now_ns, robot.width, force_n), now_ns))
        if now_ns % POSE_PERIOD_NS == 0 and (measured := sensors.pose(now_ns, *pose)) is not None:
            readings.append(Reading("pose", measured, now_ns))
        if now_ns % OBJECTS_NS == 0:
            standing = (*self._furniture.objects(), *self._cups.objects())
            readings.append(Reading("objects", sensors.objects(now_ns, pose, standing), now_ns))
        if now_ns % TRUTH_NS == 0:
            readings.append(Reading("kitchen_truth", self.ground_truth(), now_ns))
            self._touched.clear()
        return readings

    def _place_robot(self, values: Mapping[str, float]) -> None:
        robot = self._robot
        now: Place = (robot.x, robot.y, robot.phi)
        x, y, phi = (values.get(name, old) for name, old in zip(("x", "y", "phi"), now, strict=True))
        v, omega = values.get("v", robot.v), values.get("omega", robot.omega)
        angles = [values.get(name, old) for name, old in zip(JOINTS, robot.angles, strict=True)]
        width = values.get("width", robot.width)
        robot.place((x, y, phi), v, omega, angles, width)
        self._firmware.reset(v, omega, angles, width)
        self._grasp.carry()

    def _place_cup(self, name: str, values: Mapping[str, float]) -> None:
        old = self._cups.object(name) if name in self._cups.bodies else None
        turned = old is not None and f"{name}_phi" in values
        if turned or f"{name}_x" in values or f"{name}_y" in values:
            here = (old.x, old.y, old.phi) if old is not None else (0.0, 0.0, 0.0)
            x, y, phi = (values.get(f"{name}_{q}", at) for q, at in zip(("x", "y", "phi"), here, strict=True))
            if self._grasp.held == name:
                self._grasp.release()
            self._cups.stand(name, x, y, phi, self._furniture.height_at(x, y))
        if name in self._cups.bodies and (f"{name}_vx" in values or f"{name}_vy" in values):
            vx, vy = values.get(f"{name}_vx", 0.0), values.get(f"{name}_vy", 0.0)
            if self._grasp.held == name:
                self._grasp.strike(kitchen().cup.mass_kg * math.hypot(vx, vy) / PERIOD_S)
            self._cups.push(name, vx, vy)

    def _take(self, name: str, values: Mapping[str, float]) -> None:
        """Put a cup into the gripper, upright, its handle ahead unless the values say otherwise."""
        robot, cup = self._robot, kitchen().cup
        tool = on_plane(robot.x, robot.y, robot.phi).then(tool_pose(robot.angles))
        width = 2 * cup.radius
        robot.place((robot.x, robot.y, robot.phi), robot.v, robot.omega, robot.angles, width)
        self._firmware.reset(robot.v, robot.omega, robot.angles, width)
        self._cups.stand(name, tool.x, tool.y, values.get(f"{name}_phi", tool.yaw), tool.z - cup.grasp_height)
        self._grasp.hold(name)
