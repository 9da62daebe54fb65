"""Packages of robots: found by entry points, refused with all faults in one line, parts loaded when needed."""

import sys
from dataclasses import replace
from importlib.metadata import EntryPoint

import pytest

from tailor.executive import domains
from tailor.schemas import installed
from tailor.schemas.errors import UsageError
from tailor.schemas.packages import discovery
from tailor.schemas.packages.spec import RESERVED, DomainSpec, faults_of
from tailor.schemas.services import SERVICES
from tailor.schemas.topics import TOPICS

GOOD = DomainSpec("courier", "pedelec", "courier_robot.domain:make", draw="courier_robot.domain:draw")
MODULE = """
from tailor.schemas.packages.spec import DomainSpec
GOOD = DomainSpec("courier", "pedelec", "courier_robot.domain:make", draw="courier_robot.domain:draw")
TYPO = DomainSpec("courier", "pedelec", "courier_robot.typo:make", draw="courier_robot.domain:draw")
RIVAL = DomainSpec("rival", "pedelec", "courier_robot.domain:make", draw="courier_robot.domain:draw")
BAD = DomainSpec("Bad", "", "no module", generator="a:b", draw="a:b")
FAILS = DomainSpec("courier", "pedelec", "courier_robot.domain:fail", draw="courier_robot.domain:draw")
RAISES = DomainSpec("courier", "pedelec", "courier_robot.broken:make", draw="courier_robot.ending:draw")
NO_SPEC = 7
"""


@pytest.fixture
def courier(tmp_path, monkeypatch):
    """A package outside Tailor; entry points by their names."""
    folder = tmp_path / "courier_robot"
    folder.mkdir()
    (folder / "__init__.py").write_text(MODULE)
    (folder / "broken.py").write_text("1 / 0\n")
    (folder / "ending.py").write_text("raise SystemExit('no camera')\n")
    (folder / "typo.py").write_text("def make(:\n")
    (folder / "domain.py").write_text("def make():\n    return 'made'\n\n\ndef fail():\n    return {}['wheels']\n")
    (folder / "driver.toml").write_text("robot = 'pedelec'\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    yield lambda **points: discovery.read_packages(
        EntryPoint(name, f"courier_robot{value}", discovery.GROUP) for name, value in points.items()
    )
    for name in [name for name in sys.modules if name.startswith("courier_robot")]:
        del sys.modules[name]


@pytest.fixture
def installs(courier, monkeypatch):
    def install(**points):
        found = courier(**points)
        monkeypatch.setattr(installed, "packages", lambda: found)

    return install


def test_the_robots_that_ship_are_entry_points_without_a_fault():
    ours = {package.name: package for package in discovery.packages() if package.declared_in.startswith("tailor.")}
    assert {name: package.spec.robot for name, package in ours.items()} == {
        "arm": "powercube",
        "kitchen": "b21",
        "soccer": "agilo",
    }
    assert all(package.faults == () for package in ours.values())


def test_a_good_spec_has_no_fault():
    assert faults_of(GOOD) == ()


def test_a_package_is_found_with_the_folder_of_its_files(installs):
    installs(courier=":GOOD")
    spec = installed.spec_of("courier")
    assert (spec.name, spec.robot, spec.package) == ("courier", "pedelec", "courier_robot")
    assert installed.file(spec, "driver").read_text(encoding="utf-8") == "robot = 'pedelec'\n"
    assert installed.spec_of_robot("pedelec") == spec
    assert installed.domain_names() == ("courier",)


def test_a_part_is_imported_only_when_it_is_needed(installs):
    installs(courier=":GOOD")
    spec = installed.spec_of("courier")
    assert "courier_robot.domain" not in sys.modules
    assert installed.part(spec, "domain")() == "made"
    with pytest.raises(UsageError, match="domain courier has no body"):
        installed.part(spec, "body")
    with pytest.raises(UsageError, match=r"draw = 'courier_robot\.domain:draw': .*no attribute 'draw'"):
        installed.part(spec, "draw")


def test_a_part_that_is_no_python_is_refused_with_its_file_and_line(installs):
    installs(courier=":TYPO")
    with pytest.raises(UsageError, match=r"domain = 'courier_robot\.typo:make': invalid syntax \(typo\.py, line 1\)"):
        installed.part(installed.spec_of("courier"), "domain")


def test_a_part_that_raises_or_ends_the_process_is_refused_with_its_line(installs):
    installs(courier=":RAISES")
    spec = installed.spec_of("courier")
    with pytest.raises(UsageError, match=r": ZeroDivisionError: division by zero \(broken\.py, line 1\)"):
        installed.part(spec, "domain")
    with pytest.raises(UsageError, match=r": SystemExit: no camera \(ending\.py, line 1\)"):
        installed.part(spec, "draw")


def test_a_domain_that_cannot_be_made_is_refused_with_its_line(installs):
    installs(courier=":FAILS")
    with pytest.raises(UsageError, match=r"courier_robot\.domain:fail': KeyError: 'wheels' \(domain\.py, line 6\)"):
        domains.load("courier")


def test_scenarios_are_listed_although_the_order_of_one_is_no_number(installs, tmp_path):
    installs(courier=":GOOD")
    folder = tmp_path / "courier_robot" / "scenarios"
    folder.mkdir()
    for name, order in (("tour", "'last'"), ("delivery", "2"), ("charge", "1.5")):
        (folder / f"{name}.toml").write_text(f"order = {order}\n")
    assert domains.scenarios("courier") == ["charge", "delivery", "tour"]


def test_a_spec_in_a_module_of_no_package_has_no_files_beside_it():
    with pytest.raises(UsageError, match=r"driver = 'driver\.toml': its spec lies in a module of no package"):
        installed.file(GOOD, "driver")
    elsewhere = replace(GOOD, driver="tailor.simnodes:agilo/driver.toml")
    assert "agilo" in installed.file(elsewhere, "driver").read_text(encoding="utf-8")


def test_all_faults_of_a_spec_stand_in_one_line_with_file_and_field(installs):
    installs(bad=":BAD")
    with pytest.raises(UsageError) as refused:
        installed.spec_of("bad")
    text = str(refused.value)
    assert "\n" not in text
    assert text.startswith("courier_robot:BAD: ")
    assert "name is 'Bad', expected 'bad'" in text
    assert "name is 'Bad', expected lower-case letters" in text
    assert "robot is ''" in text
    assert "domain is 'no module'" in text
    assert "either draw, for the scenario files, or generator" in text


def test_no_robot_has_a_name_with_which_keys_of_tailor_itself_begin():
    """Its readings would pass for messages of an executive, e.g. on pages, and its topics could take their keys."""
    ours = {topic.key for topic in TOPICS.values()} | {service.pattern for service in SERVICES.values()}
    assert {key.partition("/")[0] for key in ours if key[0] not in "{*"} == set(RESERVED)
    for name in RESERVED:
        assert faults_of(replace(GOOD, robot=name)) == (
            f"robot is '{name}', expected another name: Tailor's own keys begin with it",
        )


def test_a_field_that_is_no_text_is_a_fault():
    assert faults_of(DomainSpec("courier", "pedelec", 7)) == ("domain is 7, expected text",)


@pytest.mark.parametrize(
    ("value", "fault"),
    [
        (".broken:SPEC", "cannot be loaded: ZeroDivisionError: division by zero"),
        (".ending:SPEC", "cannot be loaded: SystemExit: no camera"),
        (".missing:SPEC", "cannot be loaded: ModuleNotFoundError"),
        (":MISSING", "cannot be loaded: AttributeError"),
        (":NO_SPEC", "is a int, expected a DomainSpec"),
    ],
)
def test_a_package_that_cannot_be_loaded_hinders_only_those_who_name_it(installs, value, fault):
    installs(aaa=value, courier=":GOOD")
    assert installed.domain_names() == ("courier",)
    assert installed.spec_of("courier").robot == "pedelec"
    with pytest.raises(UsageError, match=fault):
        installed.spec_of("aaa")


def test_a_robot_whose_package_cannot_be_loaded_is_refused_with_the_cause(installs):
    installs(courier=":MISSING")
    fault = "courier_robot:MISSING: cannot be loaded: AttributeError: "
    with pytest.raises(UsageError, match=f"^{fault}"):
        installed.spec_of_robot("courier")
    with pytest.raises(UsageError, match=f"^no robot 'pedelec', expected one of: ; {fault}"):
        installed.spec_of_robot("pedelec")


def test_one_robot_belongs_to_one_package(installs):
    installs(courier=":GOOD", rival=":RIVAL")
    assert installed.robot_names() == ("pedelec",)
    with pytest.raises(UsageError, match="courier_robot:RIVAL: robot is 'pedelec', which courier_robot:GOOD has"):
        installed.spec_of("rival")
    assert installed.spec_of_robot("pedelec").name == "courier"


def test_a_package_whose_name_comes_before_ours_takes_no_robot_of_ours(monkeypatch):
    rival = DomainSpec("aaa", "agilo", "m:make", draw="m:draw")
    monkeypatch.setattr(sys.modules[__name__], "OFFERED", rival, raising=False)
    points = [
        EntryPoint("aaa", f"{__name__}:OFFERED", discovery.GROUP),
        EntryPoint("soccer", "tailor.robots.soccer:SPEC", discovery.GROUP),
    ]
    ours, theirs = discovery.read_packages(points)
    assert (ours.name, ours.faults) == ("soccer", ())
    assert "robot is 'agilo', which tailor.robots.soccer:SPEC has already" in theirs.faults


def test_unknown_names_are_refused_with_the_known_ones(installs):
    installs(courier=":GOOD")
    with pytest.raises(UsageError, match="no domain 'chess', expected one of: courier"):
        installed.spec_of("chess")
    with pytest.raises(UsageError, match="no robot 'hal', expected one of: pedelec"):
        installed.spec_of_robot("hal")


def test_an_editable_install_reads_the_entry_points_of_its_source_tree(tmp_path):
    file = tmp_path / "pyproject.toml"
    assert discovery._of_source_tree(file) == ()
    file.write_text('[project]\nname = "other"\n')
    assert discovery._of_source_tree(file) == ()
    file.write_text('[project]\nname = "tailor"\n[project.entry-points."tailor.domains"]\na = "b:C"\n')
    assert discovery._of_source_tree(file) == (EntryPoint("a", "b:C", discovery.GROUP),)
