"""`tailor gather` tries a robot's package for a moment, and refuses one whose code raises, in one line."""

import pytest

from tailor.tools.main import main
from tests.support.robots.known_robot import known_robot

MISTAKES = {
    "NameError: name 'X' is not defined (sampler.py, line ": ("sampler.py", "hypot(xg - x,", "hypot(xg - X,"),
    "KeyError: 'v' (sampler.py, line ": ("sampler.py", '("x", "y", "phi", "v")', '("x", "y", "phi", "w")'),
    "sample of drive has the shape (7,), expected (8,)": ("sampler.py", "return arguments\n", "return arguments[:7]\n"),
    "arguments_now of drive has the shape (7,), expected (8,)": (
        "sampler.py",
        "pose.phi, max(0.0, belief.v),",
        "pose.phi,",
    ),
    "ValueError: XML parse error": ("scene.xml", "</mujoco>", ""),
    "body = 'cart.body:Body': invalid syntax (body.py, line ": ("body.py", "def _drive(self)", "def _drive(self"),
    "body = 'cart.body:Body': module 'cart.body' has no": ("body.py", "class Body:", "class Chassis:"),
    "KeyError: 'odon' (topics.py, line ": ("body.py", 'Reading("odom"', 'Reading("odon"'),
    "AttributeError: 'Sample' object has no attribute 'text' (belief.py, line ": (
        "belief.py",
        "= sample.message",
        "= sample.text",
    ),
}


@pytest.mark.parametrize("refusal", MISTAKES)
def test_a_package_whose_code_raises_is_refused_in_one_line(refusal, tmp_path, monkeypatch, capsys):
    name, old, new = MISTAKES[refusal]
    monkeypatch.chdir(tmp_path)
    with known_robot("cart", "wheeled", tmp_path) as folder:
        path = folder / "cart" / name
        text = path.read_text(encoding="utf-8")
        assert old in text
        path.write_text(text.replace(old, new), encoding="utf-8")
        assert main(["gather", "cart", "--episodes", "1", "--jobs", "1"]) == 2
    error = capsys.readouterr().err
    assert refusal in error
    assert error.count("\n") == 1
    assert not (tmp_path / "data").exists()
