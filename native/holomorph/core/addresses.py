"""Where the project is found. `scripts/release --number` writes this from pyproject.toml; empty: nowhere yet."""

DOCUMENTATION = ""
ISSUES = ""
