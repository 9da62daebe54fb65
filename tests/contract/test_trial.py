"""`tailor gather` tries a robot's package for a moment, and refuses one whose code raises, in one line."""

import pytest

from tailor.executive import domains
from tailor.schemas.errors import UsageError
from tailor.tools.lockstep.bodies import made_body
from tailor.tools.lockstep.worlds import make_world
from tailor.tools.main import main
from tests.support.robots.known_robot import known_robot

CLASS = "class Sampler(TaskSampler):"
NO_SAMPLER = ("sampler.py", CLASS, f"Sampler = None\n\n\n{CLASS.replace('Sampler', 'Other', 1)}")

MISTAKES = {
    "NameError: name 'X' is not defined (sampler.py, line ": ("sampler.py", "hypot(xg - x,", "hypot(xg - X,"),
    "KeyError: 'v' (sampler.py, line ": ("sampler.py", '("x", "y", "phi", "v")', '("x", "y", "phi", "w")'),
    "sample of drive has the shape (7,), expected (8,)": ("sampler.py", "return arguments\n", "return arguments[:7]\n"),
    "sample of drive returned a list, expected an array": (
        "sampler.py",
        "return arguments\n",
        "return arguments.tolist()\n",
    ),
    "arguments_now of drive has the shape (7,), expected (8,)": (
        "sampler.py",
        "pose.phi, max(0.0, belief.v),",
        "pose.phi,",
    ),
    "sample of drive has x = nan, expected a number": (
        "sampler.py",
        "return arguments\n",
        "return arguments * math.nan\n",
    ),
    "arguments_now of drive has v = nan, expected a number": (
        "sampler.py",
        "max(0.0, belief.v), *",
        "belief.v * math.nan, *",
    ),
    "ValueError: timestep is 0.05 s, expected a part of 0.01 s (body.py, line ": (
        "scene.xml",
        'timestep="0.005"',
        'timestep="0.05"',
    ),
    "ValueError: XML parse error": ("scene.xml", "</mujoco>", ""),
    "body = 'cart.body:Body': invalid syntax (body.py, line ": ("body.py", "def _drive(self)", "def _drive(self"),
    "body = 'cart.body:Body': module 'cart.body' has no": ("body.py", "class Body:", "class Chassis:"),
    "advance of the body of cart returned a Reading of 'odon', expected the name of a topic": (
        "body.py",
        'Reading("odom"',
        'Reading("odon"',
    ),
    "the package of cart does not hold together: cart.domain:make: update returned None, expected a belief": (
        "domain.py",
        "return filtering.update(belief, now_ns, samples)",
        "filtering.update(belief, now_ns, samples)",
    ),
    "domain cart: sampler = 'cart.sampler:Sampler': makes a NoneType without sample, start, belief, arguments_now": (
        "sampler.py",
        CLASS,
        f"def Sampler():\n    pass\n\n\n{CLASS.replace('Sampler', 'Other', 1)}",
    ),
    "domain cart: sampler = 'cart.sampler:Sampler': is None, expected a class of TaskSampler": NO_SAMPLER,
    "AttributeError: 'Sample' object has no attribute 'text' (belief.py, line ": (
        "belief.py",
        "= sample.message",
        "= sample.text",
    ),
}


def change(package, name, old, new):
    text = (package / name).read_text(encoding="utf-8")
    assert old in text
    (package / name).write_text(text.replace(old, new), encoding="utf-8")


BODIES = {
    "cart.body:Body: cannot be simulated: ValueError: XML parse error": MISTAKES["ValueError: XML parse error"],
    "cart.body:Body: robot is 'card', expected 'cart' by the spec": ("body.py", 'robot = "cart"', 'robot = "card"'),
}


@pytest.mark.parametrize("refusal", BODIES)
def test_a_body_that_cannot_be_made_or_is_another_robots_is_not_simulated(refusal, tmp_path, capsys):
    with known_robot("cart", "wheeled", tmp_path) as folder:
        change(folder / "cart", *BODIES[refusal])
        assert main(["sim", "cart"]) == 2
    error = capsys.readouterr().err
    assert error.startswith(f"tailor sim: {refusal}")
    assert error.count("\n") == 1


def test_whatever_makes_a_body_names_one_that_cannot_be_made_in_one_line(tmp_path):
    """Evaluations, goldens and environments of gymnasium ended in the traceback of its constructor."""
    with known_robot("cart", "wheeled", tmp_path) as folder:
        change(folder / "cart", *MISTAKES["ValueError: XML parse error"])
        for make in (lambda: make_world("cart", "", 0), lambda: made_body(domains.load("cart"))):
            with pytest.raises(UsageError, match=r"^cart\.body:Body: cannot be simulated: ValueError: XML parse error"):
                make()


@pytest.mark.parametrize(("old", "new"), [("class Body:", "class Chassis:"), ("def _drive(self)", "def _drive(self")])
def test_nothing_of_a_robot_without_its_body_starts(old, new, tmp_path, capsys):
    with known_robot("cart", "wheeled", tmp_path) as folder:
        change(folder / "cart", "body.py", old, new)
        assert main(["up", "cart", "--scenario", "stand"]) == 2
    error = capsys.readouterr().err
    assert "the package of cart does not hold together: body = 'cart.body:Body': " in error
    assert error.count("\n") == 1


@pytest.mark.parametrize("refusal", MISTAKES)
def test_a_package_whose_code_raises_is_refused_in_one_line(refusal, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    with known_robot("cart", "wheeled", tmp_path) as folder:
        change(folder / "cart", *MISTAKES[refusal])
        assert main(["gather", "cart", "--episodes", "1", "--jobs", "1"]) == 2
    error = capsys.readouterr().err
    assert refusal in error
    assert error.count("\n") == 1
    assert not (tmp_path / "data").exists()


def test_a_sampler_that_is_none_is_named_by_evaluations_too(tmp_path, capsys):
    with known_robot("cart", "wheeled", tmp_path) as folder:
        change(folder / "cart", *NO_SAMPLER)
        assert main(["evaluate", "models", "--domain", "cart"]) == 2
    error = capsys.readouterr().err
    assert error.startswith("tailor evaluate: domain cart: sampler = 'cart.sampler:Sampler': is None, expected a class")
    assert error.count("\n") == 1
