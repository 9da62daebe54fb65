"""Goals of soccer that pages, help and the ROS 2 service give as examples are those of scenarios.

One that names less leaves more of it open than its author may have meant.
"""

import re

import numpy as np

from tailor.executive.domains import load_scenario, scenarios
from tailor.schemas.ros2 import service
from tailor.tools.commands.run import goal
from tests.unit.house.arrows import ROOT
from tests.unit.house.documented.test_documented_commands import PAGES

COMMAND = re.compile(r"""tailor goal ["'](\([^"']+)["']""")
CALL = re.compile(r"\{goal: '([^']+)'\}")
GOAL = re.compile(r"\(:goal (.+)\)\)\s*$")
EXAMPLE = re.compile(r"""e\.g\. "?(\([^";\n]+\))""")


def reachable() -> set[str]:
    """Goals of soccer's scenarios."""
    problems = (load_scenario("soccer", name, np.random.default_rng(0))[0].problem for name in scenarios("soccer"))
    return {match[1].strip() for problem in problems if (match := GOAL.search(problem))}


def examples() -> set[str]:
    """Goals of soccer that are given as examples."""
    text = "\n".join(page.read_text() for page in PAGES)
    written = (ROOT / "ros2/tailor_msgs/srv/SetGoal.srv").read_text()
    helped = EXAMPLE.findall("\n".join([service.REQUEST, str(goal.__doc__), written]))
    return {each for each in (*COMMAND.findall(text), *CALL.findall(text), *helped) if "atball" in each}


def test_each_example_of_a_goal_is_one_of_a_scenario() -> None:
    assert examples()
    assert examples() <= reachable()
