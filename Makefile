PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
LIBRARIES := $(VENV)/.libraries
READY := $(VENV)/.locked
TOOLS := $(VENV)/.tools
CLUSTER := $(VENV)/.cluster
CORES ?= 2
IDLE := tests?|testing|fontTools|lexers|docutils|cuda|distutils|pip
.PHONY: all env tools check test random lint docs release audit ci notebooks benchmarks ratios peers verification platforms mutation lock clean

# A run needs the libraries alone: what else belongs to the environment is made beside it, and while Snakemake starts
# a new environment compiles what its jobs will import.
all: $(LIBRARIES)
	@(test -e $(READY) || $(BIN)/python -m workflow.process.imports; $(finish)) & \
		$(BIN)/python -m facegear.system_check && PYTHONPATH=$(CURDIR) $(BIN)/snakemake --cores $(CORES); \
		ended=$$?; wait $$! && exit $$ended

# By another name, as make works even where it is only to print (-n) if it sees its own.
finish = $(MAKE) -s $(READY)

env: $(READY)

tools: $(TOOLS)

# uv fetches and unpacks in parallel; pip does it where only pip knows the package index.
define install
	$(BIN)/uv pip install --quiet --python $(BIN)/python --require-hashes -r $(1) \
		|| $(call pip,install --quiet --require-hashes -r $(1))
endef

# The pip of the Python that makes .venv: one inside takes longer to install than all that a run needs.
define pip
	if $(PYTHON) -c 'import pip' 2>/dev/null; then $(PYTHON) -m pip --python $(BIN)/python $(1); \
		else $(BIN)/python -m ensurepip && $(BIN)/python -m pip $(1); fi
endef

# Nothing is imported from folders named in IDLE.
define compile
	$(BIN)/python -m compileall -q -j $(CORES) -x '/($(IDLE))/' $(VENV)/lib
endef

# Python keeps what it has compiled, as it does by itself: a first run compiles what it imports and no more.
all: export PYTHONDONTWRITEBYTECODE =

# What a run needs. Where Python may not keep what it compiles (PYTHONDONTWRITEBYTECODE) all is compiled here, else
# every start would compile the libraries anew.
$(LIBRARIES): requirements-run.lock
	$(PYTHON) -m venv --without-pip $(VENV)
	awk '/^[^ ]/ {wanted = /^uv==/} wanted' requirements.lock > $(VENV)/uv.lock
	awk '/^[^ ]/ {wanted = /^(setuptools|setuptools-scm|packaging)==/} wanted' requirements.lock > $(VENV)/installers.lock
	$(call pip,install --quiet --no-compile --require-hashes -r $(VENV)/uv.lock)
	$(call install,requirements-run.lock -r $(VENV)/installers.lock)
	test -z "$$PYTHONDONTWRITEBYTECODE" || $(compile)
	touch $@

# The repository installs itself editable, so that notebooks and scripts find it from any folder.
$(READY): $(LIBRARIES) pyproject.toml
	$(BIN)/uv pip install --quiet --python $(BIN)/python --no-deps --no-build-isolation --editable .
	touch $@

# What tests, checks, documentation and benchmarks need beside it.
$(TOOLS): requirements.lock $(READY)
	$(call install,requirements.lock)
	$(BIN)/python -m ensurepip > $(VENV)/pip.log
	$(compile)
	touch $@

# Submission to Slurm: apart, since Snakemake imports every plugin at each start, this one with pandas.
$(CLUSTER): requirements-cluster.lock $(TOOLS)
	$(call install,requirements-cluster.lock)
	$(compile)
	touch $@

# A crash ends the tests and names its test: with a new worker for each crash, xdist waits for ever after the second.
PYTEST = $(BIN)/python -m pytest -n $(CORES) --dist loadgroup --max-worker-restart=0

check: env
	@$(BIN)/python -m facegear.system_check

test: check tools
	$(PYTEST)

# Properties alone, with fresh random examples each time: what one of them finds becomes a named case of its test.
random: check tools
	$(PYTEST) -m hypothesis --hypothesis-profile=random

lint: tools
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/snakefmt --check Snakefile workflow paper validation
	$(BIN)/mypy

docs: tools
	$(BIN)/sphinx-build --jobs $(CORES) --fail-on-warning --keep-going --quiet docs docs/build

# What CI runs: a complaint of lint, docs or the release stops it before the tests. Here a study is also run on a Slurm of its own.
ci: export FACEGEAR_SLURM = 1
ci: lint docs release $(CLUSTER) test

# dist/: wheel and sdist, the list of all that a run installs, licences and notes of this version.
release: tools
	PATH=$(CURDIR)/$(BIN):$$PATH .ci/release dist

# Known faults of the locked versions. It asks PyPI's own service, which a mirror of packages need not have: without
# --strict the audit would then end well, with every version left out.
audit: tools
	$(BIN)/uv tool run pip-audit --strict --requirement requirements-run.lock --disable-pip

notebooks: tools
	$(BIN)/jupyter execute --inplace examples/*.ipynb

benchmarks: check tools
	$(BIN)/snakemake --cores $(CORES) benchmarks

# Processor time of the dear jobs against an earlier commit, both in turns: make ratios SINCE=COMMIT.
ratios: check tools
	$(BIN)/python -m validation.ratios.run $(SINCE)

peers: check tools
	$(BIN)/snakemake --cores $(CORES) peers

# The table of what was checked against which reference, for docs/verification.md.
verification: check tools
	$(PYTEST) -m reference --references=validation/references.csv

# What moves on two threads and with lower levels of instructions: references, notebooks, stored answers, labels.
platforms: check tools
	$(BIN)/python -m validation.platforms

# Whether the tests of the core modules notice mutants of them; tried anew are those that survived in the table.
mutation: check tools
	$(BIN)/uv tool run --from cosmic-ray==8.7.0 python -m validation.mutation.run docs/measured/mutation.csv --survivors

LOCK := $(BIN)/uv pip compile --quiet --universal --python-version 3.11 --generate-hashes pyproject.toml
lock: env
	$(LOCK) --extra dev --extra benchmark -o requirements.lock
	$(LOCK) --extra workflow -c requirements.lock -o requirements-run.lock
	$(LOCK) --extra cluster -c requirements.lock -o requirements-cluster.lock

clean:
	rm -rf results/*/ .snakemake
