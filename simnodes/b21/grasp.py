"""Grasping: a cup that both fingers press is held by a constraint, until the gripper opens or a force breaks it."""

from __future__ import annotations

import math
from collections.abc import Collection
from typing import Any

from tailor.schemas.kitchen.furniture import kitchen
from tailor.simnodes.b21.cups import Cups
from tailor.simnodes.b21.engine import pybullet
from tailor.simnodes.b21.physical_parameters import PhysicalParameters
from tailor.simnodes.b21.robot import Robot

PRESSED_STEPS = 5  # of 10 ms
OPENED_M = 0.004  # a set-point that is so much wider than what is held lets go
STRONGER = 5.0  # the constraint can exert so many times the force that breaks it, or nothing would ever exceed it


class Grasp:
    """What the gripper holds.

    Attributes:
      held: Name of the cup in the gripper, or empty.
      width: Between the fingers, m, as a held cup fixes it; None: nothing is held.
      fumbles: Number of coming grasps that fail on purpose.
    """

    def __init__(self, client: int, parameters: PhysicalParameters, robot: Robot, cups: Cups) -> None:
        """An empty gripper."""
        self._bullet, self._p, self._robot, self._cups = pybullet(), parameters, robot, cups
        self._where: dict[str, Any] = {"physicsClientId": client}
        self._constraint = -1
        self._in_hand: Any = None  # place of what is held, relative to the hand
        self._steps = 0
        self._slipping = ""  # the cup that was not held, or no longer: until the gripper opens
        self.held = ""
        self.width: float | None = None
        self.fumbles = 0

    def watch(self, pressed: Collection[str], wanted_m: float) -> None:
        """Close or release after a step.

        Args:
          pressed: Cups that both fingers press.
          wanted_m: Set-point of the gripper's width.
        """
        opens = wanted_m > self._robot.width + OPENED_M
        if self.held:
            if opens:
                self.release()
            else:
                self.strike(self._force_n())
        elif self._slipping:
            if opens and self._robot.width > 2 * kitchen().cup.radius + OPENED_M:
                self._let_touch(self._slipping, True)
                self._slipping = ""
        else:
            self._steps = self._steps + 1 if len(pressed) == 1 else 0
            if self._steps >= PRESSED_STEPS:
                self._close_on(next(iter(pressed)))

    def strike(self, force_n: float) -> None:
        """Exert a force on the held cup, which breaks it loose or not."""
        if self.held and force_n > self._p.hold_n:
            self.lose()

    def lose(self) -> None:
        """Let what is held slip out; the gripper can hold it again once it has opened."""
        if self.held:
            slipping = self.held
            self.release()
            self._slip(slipping)

    def hold(self, cup: str) -> None:
        """Hold a cup where it is relative to the hand, and nothing else."""
        self.release()
        body, bullet = self._cups.bodies[cup], self._bullet
        at, turned = bullet.multiplyTransforms(
            *bullet.invertTransform(*self._hand()),
            *bullet.getBasePositionAndOrientation(body, **self._where),
            **self._where,
        )
        self._constraint = bullet.createConstraint(
            self._robot.body,
            self._robot.hand,
            body,
            -1,
            bullet.JOINT_FIXED,
            (0, 0, 0),
            at,
            (0, 0, 0),
            turned,
            **self._where,
        )
        bullet.changeConstraint(self._constraint, maxForce=STRONGER * self._p.hold_n, **self._where)
        self.held, self.width, self._steps = cup, self._robot.width, 0
        self._in_hand = at, turned
        self._let_touch(cup, False)

    def carry(self) -> None:
        """Bring what is held to where the hand is now, after the robot was put elsewhere, as fast as its base."""
        if self.held:
            robot, body = self._robot, self._cups.bodies[self.held]
            place = self._bullet.multiplyTransforms(*self._hand(), *self._in_hand, **self._where)
            self._bullet.resetBasePositionAndOrientation(body, *place, **self._where)
            velocity = robot.v * math.cos(robot.phi), robot.v * math.sin(robot.phi), 0.0
            self._bullet.resetBaseVelocity(body, velocity, (0.0, 0.0, 0.0), **self._where)

    def release(self) -> None:
        """Let go of what is held, if anything is."""
        if self.held:
            self._bullet.removeConstraint(self._constraint, **self._where)
            self._let_touch(self.held, True)
        self._constraint, self.held, self.width, self._steps = -1, "", None, 0

    def _hand(self) -> Any:
        """Pose of the hand's centre of mass, to which constraints refer."""
        bullet, robot = self._bullet, self._robot
        return bullet.getLinkState(robot.body, robot.hand, computeForwardKinematics=True, **self._where)[:2]

    def _close_on(self, cup: str) -> None:
        if self.fumbles:
            self.fumbles -= 1
            self._slip(cup)
        else:
            self.hold(cup)

    def _slip(self, cup: str) -> None:
        self._let_touch(cup, False)
        self._slipping, self._steps = cup, 0

    def _let_touch(self, cup: str, touch: bool) -> None:
        """Fingers touch a cup or not: pressing a held one would strain the constraint, and catch a slipping one."""
        body = self._cups.bodies[cup]
        for finger in self._robot.fingers:
            self._bullet.setCollisionFilterPair(self._robot.body, body, finger, -1, int(touch), **self._where)

    def _force_n(self) -> float:
        force = self._bullet.getConstraintState(self._constraint, **self._where)
        return math.sqrt(sum(part * part for part in force[:3]))
