# Everything CI runs.
check: format-check lint types imports test

format:
    uv run ruff format .

format-check:
    uv run ruff format --check .

lint:
    uv run ruff check .

types:
    uv run mypy

imports:
    uv run lint-imports

test:
    uv run pytest

# The long runs that the ordinary ones leave out.
nightly:
    uv run pytest -m nightly

# Against other programs, which the group installs.
compare:
    uv run --group compare pytest -m compare

# Redraw every picture of the README and the docs.
figures:
    uv run python docs/make_figures.py

# Measure everything, beside other programs, and fill docs/performance.md; wants an idle machine.
bench:
    uv run --group bench python -m bench.speed --write
    uv run python -m bench.scaling
