"""Sentences of headers and pages are short. The figures are printed with `pytest -s`."""

import re
import statistics

import pytest
from repository import ROOT

MEDIAN, LONG = 14, 25  # most words a sentence: in the middle, and of nine in ten
HEADERS = [*(ROOT / "native" / "src").rglob("*.h"), *(ROOT / "native" / "include").rglob("*.h")]
PAGES = [*(ROOT / "docs").rglob("*.md"), ROOT / "README.md", ROOT / "CONTRIBUTING.md"]


def comments(path):
    """The paragraphs of a header's comments; tags begin a new one."""
    lines = re.findall(r"^\s*//[/!]? ?(?!<)(.*)$|^()", path.read_text(encoding="utf-8"), re.MULTILINE)
    text = "\n".join(line for line, _ in lines)
    return re.split(r"\n\s*\n|\s(?=@(?:param|return|throw|pre)|Cost:)", text)


def paragraphs(path):
    """The paragraphs and items of a page, without code, tables and headings."""
    text = re.sub(r"^```.*?^```", "", path.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)
    text = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", text)
    found = re.split(r"\n\s*\n|\n\s*(?:[*-]|\d+\.) ", text)
    return [part for part in found if not part.lstrip().startswith(("|", "#", "<", ":"))]


def lengths(texts):
    """Words of each sentence of four words or more; `code` is one word."""
    sentences = [part for text in texts for part in re.split(r"(?<=[.!?])\s+", re.sub(r"`[^`]*`", "code", text))]
    counts = [len(re.findall(r"\S*\w\S*", sentence)) for sentence in sentences]
    return sorted(count for count in counts if count > 3)


@pytest.mark.parametrize(("name", "files", "read"), [("headers", HEADERS, comments), ("pages", PAGES, paragraphs)])
def test_sentences_are_short(name, files, read):
    counts = lengths([text for path in files for text in read(path)])
    median, long = statistics.median(counts), counts[9 * len(counts) // 10]
    print(f"{name}: {len(counts)} sentences, {median} words in the middle, {long} in nine of ten at most")
    assert len(counts) > 1000 and median <= MEDIAN and long <= LONG
