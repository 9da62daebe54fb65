"""What the ground truth of a soccer run shows: failures, contacts, errors at the end, work."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence

import numpy as np

from tailor.executive.actions.planar import PHIG, VG, XG, YG
from tailor.executive.belief.angles import difference
from tailor.executive.domains.soccer.action_library import TOUCHED
from tailor.executive.interfaces.action import Action
from tailor.executive.interfaces.values import Array
from tailor.schemas.messages import ActionFinished, Message, Odometry
from tailor.schemas.messages.soccer import BallTruth, OpponentsTruth, SoccerGroundTruth
from tailor.tools.lockstep.samplers.drive_work import wheel_work_j

COLLIDED_M = 0.05  # an approach that displaces the ball by more has failed


class SoccerOutcomes:
    """Those methods of a task sampler that read runs; see task_sampler.TaskSampler."""

    def work_j(self, before: Message, after: Message) -> float:
        """Work of the wheels between two states, joules."""
        return wheel_work_j(before, after)

    def failure(self, action: Action, start: Mapping[str, float], truth: Message) -> str:
        """Return what the truth shows: the robot touched an opponent, or an approach displaced the ball."""
        if isinstance(truth, OpponentsTruth):
            return TOUCHED if truth.touched else ""
        if action.name != "approachBall" or not isinstance(truth, SoccerGroundTruth):
            return ""
        moved = math.hypot(truth.ball_x - start["ball_x"], truth.ball_y - start["ball_y"])
        return "collision" if moved > COLLIDED_M else ""

    def start_names(self, action: Action, parameters: Array) -> Mapping[str, str]:
        """The ball's position, for actions whose start parameters name the ball instead of the robot."""
        half = len(parameters) // 2
        at_robot = np.allclose(action.arguments(parameters[None, :])[0, :half], parameters[:half])
        return {} if at_robot else {"x": "ball_x", "y": "ball_y"}

    def motion(self, message: Message, newest: Message | None) -> Message | None:
        """The newest ground truth; odometry until there is any."""
        if isinstance(message, SoccerGroundTruth) or (
            isinstance(message, Odometry) and not isinstance(newest, SoccerGroundTruth)
        ):
            return message
        return newest

    def observed_start(self, message: Message) -> dict[str, float] | None:
        """The ball's position in a ground truth, metres; opponents that are touched need nothing to compare with."""
        if isinstance(message, OpponentsTruth):
            return {}
        return {"ball_x": message.ball_x, "ball_y": message.ball_y} if isinstance(message, SoccerGroundTruth) else None

    def contacts(self, finished: Sequence[ActionFinished], truth: Sequence[Message]) -> int:
        """1 if a ball was displaced before the end of the first approach, and one for each opponent touched anew."""
        touching = [message.touched for message in truth if isinstance(message, OpponentsTruth)]
        anew = sum(now and not before for before, now in itertools.pairwise([False, *touching]))
        return int(self.disturbance_m(finished, truth) > COLLIDED_M) + anew

    def arrival_errors(self, action: Action, arguments: Array, truth: Message) -> Mapping[str, float]:
        """Errors of the axle's position (m) and heading (rad), and of the speed (m/s)."""
        if not isinstance(truth, SoccerGroundTruth):
            return {}
        return {
            "position_m": math.hypot(truth.x - arguments[XG], truth.y - arguments[YG]),
            "heading_rad": difference(truth.phi, float(arguments[PHIG])),
            "speed_mps": truth.v - float(arguments[VG]),
        }

    def disturbance_m(self, finished: Sequence[ActionFinished], truth: Sequence[Message]) -> float:
        """Largest displacement of any ball before the end of the first approach, metres; 0 without an approach."""
        ended_ns = next((action.stamp_ns for action in finished if action.action == "approachBall"), -1)
        own = (each for each in truth if isinstance(each, SoccerGroundTruth) and each.stamp_ns <= ended_ns)
        other = (each for each in truth if isinstance(each, BallTruth) and each.stamp_ns <= ended_ns)
        first, second = [(each.ball_x, each.ball_y) for each in own], [(each.x, each.y) for each in other]
        return max(_moved_m(first), _moved_m(second))


def _moved_m(places: Sequence[tuple[float, float]]) -> float:
    """Largest distance from the first place, metres."""
    return max((math.dist(places[0], place) for place in places), default=0.0)
