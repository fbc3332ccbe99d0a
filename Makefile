# `make reproduce` reproduces the paper, `make test` runs the tests. Each makes .venv and installs
# what it needs there on its first call, and does only its work on a later one.
#
#   make reproduce ARGS=--quick         with further options of `animat reproduce`
#   make test ARGS="tests/world -x"     with further options of pytest
#   make test PYTHON=python3.13         with another Python, 3.11 or later, in a new .venv
#   make lint                           checks format, style and types
#   make instructions                   counts what a step costs

.PHONY: help reproduce test lint instructions

PYTHON := python3 python3.13 python3.12 python3.11
ARGS :=
# What is never imported is never compiled: half the time of an installation.
PIP := .venv/bin/python -m pip --disable-pip-version-check install --quiet --no-compile

help:
	@sed -n '/^#/!q; s/^# \{0,1\}//p' Makefile

# A directory that an earlier call made is replaced; one that the user made is not.
reproduce: .venv/.installed
	@out=results/reproduction; ours=; force=; \
	if [ ! -e $$out ]; then ours=yes; fi; \
	if [ -e $$out/.made-by-make ]; then ours=yes; force=--force; fi; \
	.venv/bin/animat reproduce --out $$out $$force $(ARGS) || exit; \
	if [ "$$ours" ] && [ -d $$out ]; then touch $$out/.made-by-make; fi

test: .venv/.installed-for-tests
	@MPLBACKEND=Agg .venv/bin/python -m pytest --numprocesses auto --dist worksteal $(ARGS)

lint: .venv/.installed-for-tests
	@.venv/bin/ruff check
	@.venv/bin/ruff format --check
	@PYRIGHT_PYTHON_IGNORE_WARNINGS=1 .venv/bin/pyright --warnings

instructions: .venv/.installed
	@.venv/bin/python bench/instructions.py

.venv/.installed: requirements.txt pyproject.toml
	@for python in $(PYTHON); do \
		if $$python -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null; then \
			echo "Installing animat into .venv ($$($$python --version))"; \
			exec $$python -m venv .venv; \
		fi; \
	done; \
	echo "make: animat needs Python 3.11 or later; say where with PYTHON=..." >&2; exit 1
	@$(PIP) --requirement requirements.txt
	@$(PIP) --no-deps --no-build-isolation --editable .
	@touch $@

.venv/.installed-for-tests: .venv/.installed requirements-test.txt
	@echo "Installing the tools of the tests into .venv"
	@$(PIP) --requirement requirements-test.txt
	@touch $@
