"""The examples of the documentation that state what they print."""

import contextlib
import io
import re
from pathlib import Path

import pytest

DOCS = Path(__file__).resolve().parents[2] / "docs"
EXAMPLE = re.compile(r"^```python\n(.*?)^```\n^```\n(.*?)^```$", re.MULTILINE | re.DOTALL)


@pytest.mark.parametrize("page", ["tiling.md"])
def test_example_prints_what_the_page_says(page):
    examples = EXAMPLE.findall((DOCS / page).read_text(encoding="utf-8"))
    assert examples
    for code, printed in examples:
        written = io.StringIO()
        with contextlib.redirect_stdout(written):
            exec(compile(code, page, "exec"), {})
        assert written.getvalue() == printed
