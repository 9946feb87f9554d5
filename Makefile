# make install | site | demo | quick | test | campaigns | test-all | coverage | lint | bench | fuzz SECONDS=60 | interop [LIBIEC61850=TREE]    (PYTHON=python3.11 make install: another interpreter)
# make chaos SEED=1 MINUTES=2 RECORDINGS=300 RELAYS=12 [FAULTS=1] [DATABASE=postgresql] [JSON=FILE] [DATA=DIR]     (faults of all kinds: docs/evidence/track-record.md)
# make bench [QUICK=1] [DATA=FOLDER]     (DATA: measured recordings, for docs/evidence/condition.md)
# make corpus DIR=FOLDER     (how recordings and SCL files of a folder are read: docs/evidence/corpus.md)
# make hostile CASES=10000 SEED=1     (a relay that answers nonsense: docs/evidence/interoperability.md)
# make compose-test COMPOSE="docker compose"     (the demo enterprise in containers, run for real)
# make compose-test-hosts COMPOSE="docker compose"     (the same on PostgreSQL and several hosts; needs the database's image)
PYTHON ?= python3
BIN := .venv/bin
STAMP := .venv/.installed
WARM := .venv/.compiled
SITE := service/web/help/site
# Matrices are small here: threads of the linear algebra library only take cores from the tests' own processes.
export OPENBLAS_NUM_THREADS ?= 1
# Tests start thousands of processes: none of them is to compile our modules anew, which some images ask for.
export PYTHONDONTWRITEBYTECODE :=
# Pages with parts that `make docs` writes from the code.
MADE_PAGES := $(foreach page,architecture command alarm audit role quantity,tests/docs/test_$(page)_page.py)
# docker compose where its engine answers, else nothing; COMPOSE="podman-compose" make compose-test: another one
COMPOSE ?= $(shell docker compose version >/dev/null 2>&1 && docker info >/dev/null 2>&1 && echo docker compose)

.PHONY: install site demo quick test campaigns test-all containers coverage hostile chaos compose-test compose-test-hosts lint docs client bench corpus interop fuzz lock advisories audit clean
.DEFAULT_GOAL := install

install: $(WARM) $(SITE)/index.html

$(BIN)/python:
	sh .ci/make-venv "$(PYTHON)"

$(STAMP): $(BIN)/python pyproject.toml constraints.txt
	@echo "installing into .venv: a minute or two"
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --constraint constraints.txt --editable '.[dev]'
	touch $@

# Cached machine code is checked against a function's own file only, not against those it calls: compile afresh.
$(WARM): $(STAMP) $(wildcard core/machines/*.py core/diagnosis/*.py core/condition/*/*.py ied_sim/motor/*.py)
	@echo "compiling the machine models: half a minute"
	find core ied_sim -name '*.nb[ci]' -delete
	$(BIN)/python -c 'import core.warm_up, ied_sim; core.warm_up.warm_up(); ied_sim.warm_up()'
	touch $@

# The documentation as the service shows it under /help; a link that leads nowhere is an error.
site: $(SITE)/index.html

$(SITE)/index.html: $(STAMP) mkdocs.yml release/help_site.py release/help_hooks.py $(shell find docs -type f)
	$(BIN)/python -m release site

demo: install
	@$(BIN)/mcc demo

# What a change since main can break most directly, within a minute: make quick [SINCE=COMMIT] [SECONDS=60]
quick: install
	$(BIN)/python -m tests.quick $(if $(SINCE),--since $(SINCE)) $(if $(SECONDS),--seconds $(SECONDS))

# What a change can break, within minutes.
test: install
	.ci/pytest -q -m "not campaign"

# Long tests that have limits of time do not share the cores with as many others.
campaigns: install
	.ci/pytest -q -m campaign -n 2

# All of them.
test-all: install
	$(MAKE) test
	$(MAKE) campaigns
	$(MAKE) hostile
	$(MAKE) chaos
	$(MAKE) containers

# compose-test where an engine answers.
containers: install
	$(if $(COMPOSE),$(MAKE) compose-test,@echo "compose-test: not run, no Docker engine answers here and COMPOSE names no other compose command")

# Branch coverage of all tests, at 90 % or more. It takes up to half as long again.
coverage: install
	$(BIN)/python -m pytest -q -n 2 --cov

# A relay that answers nonsense. `python -m tests.hostile` also shows it to a whole service, for five minutes.
hostile: install
	$(BIN)/python -m tests.hostile --clients-only --cases $(or $(CASES),10000) --seed $(or $(SEED),1)

# Needs both cores to itself: it holds a service, its relays and all their faults.
chaos: install
	$(BIN)/python -m tests.chaos --seed $(or $(SEED),1) --minutes $(or $(MINUTES),2) \
		--recordings $(or $(RECORDINGS),300) --relays $(or $(RELAYS),12) \
		$(if $(FAULTS),--faults $(FAULTS)) $(if $(DATABASE),--database $(DATABASE)) $(if $(JSON),--json $(JSON)) $(if $(DATA),--data $(DATA))

compose-test: install
	@test -n "$(COMPOSE)" || { echo "compose-test: no Docker engine answers; name a compose command with COMPOSE" >&2; exit 1; }
	$(BIN)/python -m tests.deployment.enterprise $(COMPOSE)

compose-test-hosts: install
	@test -n "$(COMPOSE)" || { echo "compose-test-hosts: no Docker engine answers; name a compose command with COMPOSE" >&2; exit 1; }
	$(BIN)/python -m tests.deployment.several_hosts $(COMPOSE)

lint: install
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports
	$(BIN)/check-jsonschema --builtin-schema vendor.compose-spec docker-compose.yml examples/several-hosts.yml
	$(BIN)/check-jsonschema --builtin-schema vendor.github-workflows .github/workflows/ci.yml
	$(BIN)/python -m pytest -q $(MADE_PAGES)

# What pages have from the code: the drawings of the architecture, the commands and their options.
docs: install
	$(BIN)/python -m tests.docs

# What the client package has from the OpenAPI document: its types and functions.
client: install
	$(BIN)/python -m tests.client

# The second one ends with 1 where a command answers too slowly, the third one where a page does: it needs 14 GB for five
# million records. The last one writes docs/evidence/condition.md, in the better part of an hour; with QUICK=1 it prints
# what a few motors give, within minutes.
bench: install
	$(BIN)/python -m benchmarks
	$(BIN)/python -m benchmarks.commands
	$(BIN)/python -m benchmarks.web $(if $(QUICK),--records 500 --quick)
	$(BIN)/python -m benchmarks.condition $(if $(QUICK),--quick) $(if $(DATA),--data $(DATA))

# Reads every COMTRADE, CEV and SCL file of a folder, and says of each what became of it.
corpus: install
	@test -n "$(DIR)" || { echo "corpus: name the folder: make corpus DIR=folder" >&2; exit 2; }
	@$(BIN)/python -m benchmarks.corpus "$(DIR)" $(if $(JSON),--json)

# Clients and servers of other stacks; LIBIEC61850: a built source tree of that library, too (docs/evidence/interoperability.md).
interop: install
	$(BIN)/python -m benchmarks.interoperability $(LIBIEC61850)

# What it finds is kept in fuzz-findings/.
fuzz: install
	$(BIN)/python -m benchmarks.recordings.fuzzing --seconds $(or $(SECONDS),60)

lock: install
	$(BIN)/python -m pip freeze --exclude-editable --exclude pip --exclude setuptools > constraints.txt
	$(BIN)/uv pip compile pyproject.toml --extra postgres --extra s3 --extra tables --constraint constraints.txt --python-version 3.11 \
		--generate-hashes --no-header --no-annotate --quiet --output-file requirements.txt

# Known advisories about the pinned packages, into a file. Needs a network; to be made for each release.
advisories: install
	$(BIN)/python -m release advisories

# The pinned packages against that file. Needs none.
audit: install
	$(BIN)/python -m release audit

clean:
	rm -rf .venv $(SITE) build dist *.egg-info .mypy_cache .ruff_cache .pytest_cache .hypothesis
