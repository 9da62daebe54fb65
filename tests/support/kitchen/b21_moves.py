"""The kitchen without an executive: starts, and a level hand by the closed form of an arm with two links."""

import math

import numpy as np

from tailor.schemas.kitchen.furniture import kitchen, on_table
from tailor.schemas.kitchen.kinematics import FOREARM_M, HAND_M, SHOULDER, UPPER_ARM_M
from tailor.simnodes.b21.profiles import body as of_profile

OPEN_M, SHUT_M = 0.12, 0.0
STEP_NS = 100_000_000


def with_cup(**start):
    """A body that starts with cup1 in its gripper."""
    body = of_profile()
    body.reset(np.random.default_rng(0), {"held": 1.0, "width": 0.05, **start})
    return body


def cup(body, name="cup1"):
    """The truth of a cup."""
    return next(each for each in body.ground_truth().objects if each.name == name)


def cups_on_tables(*names):
    """Start values of cups at their nominal places."""
    start = {}
    for name in names:
        table, slot, handle = kitchen().cups[name]
        x, y, phi = on_table(kitchen().tables[table], *kitchen().table.slots[slot], handle)
        start |= {f"{name}_x": x, f"{name}_y": y, f"{name}_phi": phi}
    return start


def standing_at(table, away_m=0.6):
    """Start values of a robot in front of a table's edge, looking at it."""
    place = kitchen().tables[table]
    x, y, phi = on_table(place, kitchen().edge_m + away_m, 0.0, math.pi)
    return {"x": x, "y": y, "phi": phi}


def level_reach(x, y, z):
    """Angles that bring the grasp point to a place in base_link, the hand level and pointing away from the shoulder."""
    ahead, left = x - SHOULDER[0], y - SHOULDER[1]
    across, up = math.hypot(ahead, left) - HAND_M, z - SHOULDER[2]
    d = math.hypot(across, up)
    elbow = math.acos((UPPER_ARM_M**2 + FOREARM_M**2 - d * d) / (2 * UPPER_ARM_M * FOREARM_M)) - math.pi
    lift = math.atan2(up, across) + math.acos((UPPER_ARM_M**2 + d * d - FOREARM_M**2) / (2 * UPPER_ARM_M * d))
    return (math.atan2(left, ahead), lift, elbow, 0.0, -lift - elbow, 0.0)


def seen_from(truth, name):
    """An object of the truth in base_link."""
    there = next(each for each in truth.objects if each.name == name)
    dx, dy = there.x - truth.x, there.y - truth.y
    c, s = math.cos(truth.phi), math.sin(truth.phi)
    return c * dx + s * dy, c * dy - s * dx, there.z


def move(body, goal, width, seconds=3.0, base=(0.0, 0.0)):
    """Drive the joints to their goal in proportion to what is left; the readings on the way."""
    readings = []
    for _ in range(round(seconds * 1e9) // STEP_NS):
        now = body.ground_truth().angles
        rates = [max(-0.8, min(0.8, 3.0 * (want - is_))) for want, is_ in zip(goal, now, strict=True)]
        body.command((*base, *rates, width))
        readings += body.advance(STEP_NS)
    return readings


def straight(body, goal, width, seconds=3.0):
    """Move the grasp point along a line to a place in base_link, then hold."""
    from tailor.schemas.kitchen.kinematics import tool_pose

    tool = tool_pose(body.ground_truth().angles)
    readings, steps = [], round(seconds * 1e9) // STEP_NS
    for step in range(1, steps + 1):
        share = min(1.0, step / (0.7 * steps))
        at = [a + share * (b - a) for a, b in zip((tool.x, tool.y, tool.z), goal, strict=True)]
        readings += move(body, level_reach(*at), width, 0.1)
    return readings


def fetch(body, name, width=SHUT_M):
    """Reach for a cup from the front, close the gripper, lift the cup by 0.1 m; readings of all."""
    x, y, z = seen_from(body.ground_truth(), name)
    z += kitchen().cup.grasp_height - kitchen().cup.height / 2
    far = math.hypot(x - SHOULDER[0], y)
    short = (SHOULDER[0] + (x - SHOULDER[0]) * (far - 0.12) / far, y * (far - 0.12) / far, z)
    readings = move(body, level_reach(short[0], short[1], short[2] + 0.15), OPEN_M, 4.0)
    readings += straight(body, short, OPEN_M, 1.5)
    readings += straight(body, (x, y, z), OPEN_M, 2.0)
    readings += move(body, level_reach(x, y, z), width, 1.5)
    return readings + straight(body, (x, y, z + 0.1), width, 1.5)
