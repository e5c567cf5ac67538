"""Where the project is found is named by help and by faults, once its owner has filled it in."""

import pytest
from holomorph.commands.console import Parser
from holomorph.core import addresses, unexpected

PLACE = "https://example.org/place"


def fault():
    return unexpected.told(ZeroDivisionError("planted"))


@pytest.mark.parametrize("name, said", [("DOCUMENTATION", Parser().format_help), ("ISSUES", fault)])
def test_an_address_is_named_only_where_it_is_filled_in(name, said, monkeypatch, tmp_path):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    monkeypatch.setattr(addresses, name, "")
    assert "http" not in said()
    monkeypatch.setattr(addresses, name, PLACE)
    assert said().rstrip().endswith(PLACE)
