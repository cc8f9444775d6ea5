PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
READY := $(VENV)/.locked
CORES ?= 2

.PHONY: all env check test lint docs ci notebooks benchmarks peers identify lock clean

all: check
	$(BIN)/snakemake --cores $(CORES)

env: $(READY)

# uv fetches, unpacks and compiles in parallel; pip does it where only pip knows the package index. Without compiled
# modules every job would compile the libraries anew where Python may not write them (PYTHONDONTWRITEBYTECODE).
# The repository installs itself editable, so that notebooks and scripts find it from any folder.
$(READY): requirements.lock pyproject.toml
	$(PYTHON) -m venv $(VENV)
	awk '/^[^ ]/ {wanted = /^uv==/} wanted' requirements.lock > $(VENV)/uv.lock
	$(BIN)/python -m pip install --quiet --require-hashes -r $(VENV)/uv.lock
	$(BIN)/uv pip install --quiet --compile-bytecode --python $(BIN)/python --require-hashes -r requirements.lock \
		|| $(BIN)/python -m pip install --quiet --require-hashes -r requirements.lock
	$(BIN)/uv pip install --quiet --python $(BIN)/python --no-deps --no-build-isolation --editable .
	touch $@

check: env
	@$(BIN)/python -m facegear.system_check

test: check
	$(BIN)/python -m pytest -n $(CORES) --dist loadgroup

lint: env
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/snakefmt --check Snakefile workflow
	$(BIN)/mypy

docs: env
	$(BIN)/sphinx-build --jobs $(CORES) --fail-on-warning --keep-going --quiet docs docs/build

# What CI runs: a complaint of lint or docs stops it before the tests. Here a study is also run on a Slurm of its own.
ci: export FACEGEAR_SLURM = 1
ci: lint docs test

notebooks: env
	$(BIN)/jupyter execute --inplace examples/*.ipynb

benchmarks: check
	$(BIN)/snakemake --cores $(CORES) benchmarks

peers: check
	$(BIN)/snakemake --cores $(CORES) peers

identify: check
	$(BIN)/snakemake --cores $(CORES) identify

lock: env
	$(BIN)/uv pip compile --quiet --universal --python-version 3.11 --generate-hashes --extra dev --extra benchmark pyproject.toml -o requirements.lock

clean:
	rm -rf results/*/ .snakemake
