# The project's commands. Each sets everything up first.
PYTHON ?= python3
BIN := .venv/bin
EXTRAS ?= test
OLD := import sys; sys.exit(sys.version_info < (3, 11) and "tailor needs Python 3.11 or newer; set PYTHON=python3.11")

.PHONY: setup demo demo-arm test test-all test-faults test-mutants test-packages test-new-robots test-oldest goldens models ros2 lint types bench docs clean

setup: .venv/.installed

.venv/.installed: pyproject.toml constraints.txt
	@$(PYTHON) -c '$(OLD)'
	$(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --upgrade 'pip>=25'  # the one that Python brings may resolve for a minute
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-compile -c constraints.txt -e '.[$(EXTRAS)]'
	@$(BIN)/python -m compileall -qq -j 0 -x 'site-packages/.*/tests/' .venv/lib || true  # pip would do so on one core; some examples in there are of Python 2
	@$(BIN)/python -m compileall -q -j 0 executive models robots runtime schemas simnodes src tools  # or each start compiles them: 0.3 s
	@touch $@ $(if $(findstring docs,$(EXTRAS)),.venv/.docs)

# A demonstration needs the simulator and plots only; where everything is set up, it takes that.
DEMO := $(if $(wildcard .venv/.installed),.venv/.installed,.venv/.demo)

.venv/.demo: pyproject.toml constraints.txt
	@$(PYTHON) -c '$(OLD)'
	@echo 'Installing Tailor with its simulator into .venv: about 450 MB, one to three minutes, only once.'
	$(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --disable-pip-version-check -c constraints.txt -e '.[sim,plots]'
	@touch $@

demo: $(DEMO)
	$(BIN)/tailor demo

demo-arm: $(DEMO)
	$(BIN)/tailor letters

# Four workers even on two cores: two of them run robots and wait most of the time.
test: setup
	$(BIN)/python -m pytest -m 'not slow' -n 4 --dist loadgroup --durations=30 --durations-min=3

test-all: setup
	$(BIN)/python -m pytest -n 4 --dist loadgroup

test-faults: setup  # the promises of SAFETY.md; one test after another, or they would load the machine
	@mkdir -p out
	$(BIN)/python -m pytest -m promise --promises --promises-json out/promises.json

test-mutants: setup  # hand-made mistakes in safety code, each of which a test must see
	$(BIN)/python -m tests.mutants.runner

test-packages: setup  # new robots, the tutorial and foreign packages, from the wheel to a verified run: 10 minutes
	$(BIN)/python -m pytest tests/e2e/packages

test-new-robots: setup  # of those a new robot of each kind and one foreign package, side by side: 1.5 minutes
	$(BIN)/python -m pytest -n 3 --dist load tests/e2e/packages/test_new_robot.py -k 'no_line_edited or editable'

test-oldest:  # the tests with the oldest versions that pyproject.toml allows, all at once; pip resolves to none but the newest
	$(PYTHON) -m venv out/oldest
	out/oldest/bin/python -m pip install --quiet --disable-pip-version-check uv
	out/oldest/bin/python -m uv pip install --quiet --python out/oldest/bin/python --resolution lowest-direct -e '.[test]'
	out/oldest/bin/python -m pytest -m 'not slow' -n 4 --dist loadgroup

goldens: setup  # renews the golden recordings and prints the differences
	$(BIN)/python -m tailor.tools.goldens.renew

models: setup  # makes every model that ships anew from seeds, by the recipes beside them
	$(BIN)/tailor make-models

ros2: setup  # writes the interface package for ROS 2 workspaces, ros2/tailor_msgs
	$(BIN)/python -m tailor.schemas.ros2.interface_package

lint: setup
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/codespell .

types: setup
	$(BIN)/mypy

bench: setup
	$(BIN)/tailor bench

.venv/.docs: .venv/.installed
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt -e '.[docs]'
	@touch $@

docs: .venv/.docs  # the documentation site in out/site; a broken link is an error, but not with --quiet
	NO_MKDOCS_2_WARNING=1 $(BIN)/python -m mkdocs build

clean:
	rm -rf .venv out build *.egg-info
