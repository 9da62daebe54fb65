"""The ROS 2 action that pursues a goal, `tailor_msgs/action/AchieveGoal`: its definition, names, types and hashes.

ROS 2 makes an action of three services and two topics below its name (design.ros2.org, "Actions"). The types of most
are derived from its definition; a request to cancel and the states of all goals have types of `action_msgs`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

from tailor.schemas.packages.ros_names import PACKAGE
from tailor.schemas.ros2.graph import Named
from tailor.schemas.ros2.service import REQUEST
from tailor.schemas.typesystem import add_message, add_service, hash_of

NAME = "exec/achieve_goal"
ACTION = f"{PACKAGE}/action/AchieveGoal"
CANCEL = "action_msgs/srv/CancelGoal"
STATES = "action_msgs/msg/GoalStatusArray"
MAX_TOPIC_BYTES = 65_536
RESULT = """\
string result  # achieved, failed, cancelled, replaced (by another goal), refused, fault, stopped
string reason  # of a failure or fault, see docs/reasons.md
string detail  # of the reason; the cause of a refusal
float64 duration_s  # since the goal was accepted"""
FEEDBACK = """\
string mode  # DISARMED READY EXECUTING HOLDING FAULT
string reason  # of the mode, see docs/reasons.md
string action  # e.g. goToPose, empty between actions
int32 action_index
float64 action_elapsed_s
float64 action_predicted_s"""
_ID = "unique_identifier_msgs/UUID goal_id"


@dataclass(frozen=True, slots=True)
class ActionParts:
    """The services and topics of the action, as ROS 2 names them."""

    send_goal: Named
    cancel_goal: Named
    get_result: Named
    feedback: Named
    status: Named

    @property
    def services(self) -> tuple[Named, ...]:
        """Those that the executive serves and people call."""
        return self.send_goal, self.cancel_goal, self.get_result

    @property
    def topics(self) -> tuple[Named, ...]:
        """Those that the executive publishes."""
        return self.feedback, self.status


def text() -> str:
    """Content of the `.action` file."""
    return f"# Pursues a goal until it is achieved, or dropped.\n{REQUEST}\n---\n{RESULT}\n---\n{FEEDBACK}\n"


@cache
def achieve_goal() -> ActionParts:
    """The parts of the action; registers their types."""
    add_action(ACTION, REQUEST, RESULT, FEEDBACK)
    add_service(CANCEL, "action_msgs/GoalInfo goal_info", "int8 return_code\naction_msgs/GoalInfo[] goals_canceling")
    types = {
        "send_goal": f"{ACTION}_SendGoal",
        "cancel_goal": CANCEL,
        "get_result": f"{ACTION}_GetResult",
        "feedback": f"{ACTION}_FeedbackMessage",
        "status": STATES,
    }
    return ActionParts(**{part: Named(f"{NAME}/_action/{part}", kind, hash_of(kind)) for part, kind in types.items()})


def add_action(name: str, goal: str, result: str, feedback: str) -> None:
    """Register an action's types, and those that ROS 2 derives from them.

    Args:
      name: ROS name of the action, e.g. "test_msgs/action/Fibonacci".
      goal: ROS 2 definition of the goal, the first part of the .action file.
      result: The part below the first dashes.
      feedback: The part below the second ones.
    """
    for part, definition in (("Goal", goal), ("Result", result), ("Feedback", feedback)):
        add_message(f"{name}_{part}", definition)
    add_service(f"{name}_SendGoal", f"{_ID}\n{name}_Goal goal", "bool accepted\nbuiltin_interfaces/Time stamp")
    add_service(f"{name}_GetResult", _ID, f"int8 status\n{name}_Result result")
    add_message(f"{name}_FeedbackMessage", f"{_ID}\n{name}_Feedback feedback")
