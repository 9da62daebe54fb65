"""What the porter looks like."""

from porter.messages import PorterState
from tailor.schemas.packages.pose3 import Pose3, on_plane
from tailor.schemas.packages.scene import BASE, DARK, Scene, box, frame, line

RAIL = line("rail", [(-4.0, 0.0, 0.0), (4.0, 0.0, 0.0)], 0.05)


def of_belief(values):
    return _drawn(values["along"], values["rate"], values["width"])


def of_truth(message):
    return _drawn(message.along, message.rate, message.width) if isinstance(message, PorterState) else Scene()


def of_subgoal(values):
    return on_plane(values["along"], 0.0) if "along" in values else Pose3(z=0.5)


def _drawn(along, rate, width):
    fingers = (
        box(f"{side} finger", (0.02, 0.02, 0.1), Pose3(0.2, sign * (width / 2 + 0.01), 0.3), DARK)
        for side, sign in (("left", 1.0), ("right", -1.0))
    )
    body = box("cart", (0.4, 0.3, 0.3), Pose3(z=0.15))
    return Scene((frame(BASE, on_plane(along, 0.0)),), (body, *fingers, RAIL), BASE, rate)
