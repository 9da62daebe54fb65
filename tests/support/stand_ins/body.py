"""A body without physics for tests of the bus: a unicycle that follows commands at once."""

import math

from tailor.schemas.messages import Odometry, PoseEstimate
from tailor.schemas.messages.soccer import BallPercept, SoccerGroundTruth
from tailor.simnodes.body import STEP_NS, Reading

PERIODS_NS = {"odom": 20_000_000, "pose": 80_000_000, "ball": 80_000_000, "truth": 100_000_000}


class FakeBody:
    """See tailor.simnodes.body.Body."""

    robot = "agilo"
    names = ("x", "y", "phi", "ball_x", "ball_y")

    def reset(self, rng, start):
        self.time_ns = 0
        self.v = self.omega = 0.0
        self.noise = rng.normal()
        self.state = {"x": 0.0, "y": 0.0, "phi": 0.0, "ball_x": 1.0, "ball_y": 0.0, **start}

    def place(self, values):
        self.state.update(values)

    def command(self, values):
        self.v, self.omega = values

    def advance(self, duration_ns):
        readings = []
        for _ in range(duration_ns // STEP_NS):
            self.time_ns += STEP_NS
            state, step_s = self.state, STEP_NS / 1e9
            state["phi"] += self.omega * step_s
            state["x"] += self.v * math.cos(state["phi"]) * step_s
            state["y"] += self.v * math.sin(state["phi"]) * step_s
            due = [topic for topic, period in PERIODS_NS.items() if self.time_ns % period == 0]
            readings += [Reading(topic, self._sense(topic), self.time_ns) for topic in due]
        return readings

    def ground_truth(self):
        s = self.state
        return SoccerGroundTruth(
            self.time_ns, s["x"], s["y"], s["phi"], self.v, self.omega, s["ball_x"], s["ball_y"], 0.0, 0.0
        )

    def _sense(self, topic):
        s, now = self.state, self.time_ns
        if topic == "odom":
            return Odometry(now, s["x"], s["y"], s["phi"], self.v, self.omega)
        if topic == "pose":
            return PoseEstimate(now, s["x"], s["y"], s["phi"], 1e-4, 1e-4, 1e-4)
        if topic == "ball":
            return BallPercept(now, s["ball_x"], s["ball_y"], 1e-4, 1e-4, 0.0)
        return self.ground_truth()
