"""Topics of the soccer robot alone. Those of opponents and of a second ball carry messages only where there are any."""

from __future__ import annotations

from tailor.schemas.messages.soccer import BallPercept, BallTruth, OpponentPercepts, OpponentsTruth, SoccerGroundTruth
from tailor.schemas.packages.topic import Topic

TOPICS = {
    "ball": Topic("{robot}/ball", BallPercept, 12.5, "driver"),
    "ball2": Topic("{robot}/ball2", BallPercept, 12.5, "driver"),
    "opponents": Topic("{robot}/opponents", OpponentPercepts, 12.5, "driver"),
    "truth": Topic("{robot}/sim/truth", SoccerGroundTruth, 10, "simulator"),
    "ball2_truth": Topic("{robot}/sim/ball2", BallTruth, 10, "simulator"),
    "opponents_truth": Topic("{robot}/sim/opponents", OpponentsTruth, 10, "simulator"),
}
