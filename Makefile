# `make` computes the paper's case; `make tools` adds what tests, checks and documentation need.
PYTHON ?= python3
CORES ?= 2
BIN := .venv/bin
LOCKED := $(BIN)/pip install --quiet --require-hashes -r
PYTEST := $(BIN)/python -m pytest -n $(CORES) --dist loadgroup --max-worker-restart=0 # a crash ends the tests
COMPILE := $(BIN)/uv pip compile --quiet --universal --python-version 3.11 --generate-hashes
.PHONY: all env tools kernels sanitize check test random lint docs ci release audit notebooks benchmarks peers ratios verification platforms starters sharing_advice mutation lock clean
all: check
	$(BIN)/snakemake --cores $(CORES)
env: .venv/run
.venv/bin/python .venv/bin/pip: ; $(PYTHON) building/environment.py # makes .venv, or mends the one that is there
.venv/bin/pip: .venv/bin/python
.venv/run: requirements-run.lock requirements-build.lock requirements-zig.lock pyproject.toml .venv/bin/pip # and this repository, editable
	$(BIN)/python building/environment.py --check
	$(LOCKED) requirements-run.lock -r requirements-build.lock
	$(PYTHON) building/kernels.py --has-compiler || $(LOCKED) requirements-zig.lock
	$(BIN)/python building/kernels.py
	$(BIN)/pip install --quiet --no-deps --no-build-isolation --editable .
	touch $@
kernels: env # compiles the C++ sources that have changed
	@$(BIN)/python building/kernels.py
tools: .venv/tools
.venv/tools: requirements.lock .venv/run
.venv/cluster: requirements-cluster.lock .venv/tools # submission to Slurm
.venv/tools .venv/cluster:
	$(LOCKED) $<
	touch $@
check: kernels
	@$(BIN)/python -m facegear.system_check
test: check tools
	$(PYTEST)
random: check tools # properties alone, with fresh examples; what one finds becomes a named case of its test
	$(PYTEST) -m hypothesis --hypothesis-profile=random
lint: kernels tools
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/snakefmt --check workflow/Snakefile workflow paper validation
	$(BIN)/mypy
	$(BIN)/python building/lint.py
docs: tools
	$(BIN)/sphinx-build --jobs $(CORES) --fail-on-warning --keep-going --quiet docs docs/build
ci: lint docs sanitize release .venv/cluster
	FACEGEAR_SLURM=1 $(MAKE) test
sanitize: tools # tests of the kernels while addresses and undefined behaviour are watched
	$(BIN)/python building/sanitize.py -n 0 tests/unit/test_flank_and_small_kernels.py tests/unit/bearings/test_rolling_response.py tests/unit/contact/test_contact_kernels.py tests/unit/motion/test_motion_kernels.py tests/unit/test_kernels_fuzz.py
release: tools # into dist/; the wheel is compiled by zig for an old glibc
	$(LOCKED) requirements-zig.lock
	PATH=$(CURDIR)/$(BIN):$$PATH .ci/release dist
audit: tools # known faults of the locked versions; fails where PyPI's own service does not answer
	$(BIN)/uv tool run pip-audit --strict --requirement requirements-run.lock --disable-pip
notebooks: tools
	$(BIN)/jupyter execute --inplace examples/*.ipynb
benchmarks peers: check tools
	$(BIN)/snakemake --cores $(CORES) $@
ratios: check tools # processor time of the dear jobs against an earlier commit: make ratios SINCE=COMMIT POINTS="contact"
	$(BIN)/python -m validation.ratios.run $(POINTS) $(SINCE:%=--since %)
verification: check tools # the table of what was checked against which reference
	$(PYTEST) -m reference --references=validation/references.csv && $(BIN)/python -m validation.pages
platforms starters sharing_advice: check tools # two threads and lower levels of instructions; 20 machines of `facegear new`; advice of the load-sharing map repeated by configs
	$(BIN)/python -m validation.$@
mutation: check tools # whether the tests notice mutants that survived before
	$(BIN)/uv tool run --from cosmic-ray==8.7.0 python -m validation.mutation.run docs/measured/mutation.csv --survivors
lock: tools
	$(COMPILE) pyproject.toml --extra dev --extra benchmark -o requirements.lock
	$(COMPILE) --group build -c requirements.lock -o requirements-build.lock
	$(COMPILE) --group zig -o requirements-zig.lock
	$(COMPILE) pyproject.toml --extra workflow -c requirements.lock -o requirements-run.lock
	$(COMPILE) pyproject.toml --extra cluster -c requirements.lock -o requirements-cluster.lock
clean: ; rm -rf results/*/ .snakemake
