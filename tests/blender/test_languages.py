"""The panel's words in other languages."""

import bpy
import pytest
from loaded_addon import module
from scenes import native

words, properties = module("interface.words"), module("operators.properties")
LABELS = [
    *("Make Map", "Update Map", "Drag", "Advanced", "Check", "From This Map", "Tools", "Bake Tiling", "Evenness"),
    *("{} Points", "Ready to tile", "Not ready to tile", "Ready to bake", "Not ready to bake"),
    *(properties.Dials.__annotations__[name].keywords["name"] for name in ("tiles", "size", "turns", "direction")),
    *(label for _, label, _ in properties.TEXTURES if label != "Material"),
]


@pytest.fixture(params=sorted(words.LANGUAGES))
def language(request):
    view = bpy.context.preferences.view
    before = view.language, view.use_translate_interface
    try:
        view.language = request.param
    except TypeError:
        pytest.skip("this Blender has no other languages")
    view.use_translate_interface = True
    yield request.param
    view.language, view.use_translate_interface = before


def test_all_languages_have_the_same_words_and_numbers():
    tables = list(words.LANGUAGES.values())
    assert len(tables) > 1 and all(list(table) == list(tables[0]) for table in tables)
    assert all(key.count("{}") == text.count("{}") for table in tables for key, text in table.items())


def test_what_the_panel_shows_has_words_in_each():
    verdicts, report = native.load().quality.verdicts, native.load().maps.report
    seen = [verdicts.EVENNESS[0], verdicts.EVENNESS[1], *verdicts.SHEAR[1:], *verdicts.LINED.values()]
    seen += [f"{{}} {word}" for word in report.WORDS.values()]
    seen += [f"{part} is slanted" for part in native.load().quality.quality.FRACTIONS]
    for table in words.LANGUAGES.values():
        assert not {*LABELS, *seen} - set(table)


def test_a_sentence_is_said_phrase_by_phrase(language):
    table = words.LANGUAGES[language]
    assert words.said("24 Points") == table["{} Points"].format(24)
    first = table["fairly even"]
    wanted = f"{first[0].upper()}{first[1:]}, {table['seamless']}, {table['a third is slanted']}"
    assert words.said("Fairly even, seamless, a third is slanted") == wanted
    assert words.said("3 parts: 2 in islands") == f"{table['{} parts']}: {table['{} in islands']}".format(3, 2)
    assert words.said("Uneven (squares of 1 to 2.1), of no language").endswith("2.1), of no language")


def test_in_english_nothing_changes():
    for text in ("24 Points", "Even, seamless", "Not ready to bake", "", "a: b, 7 c"):
        assert words.said(text) == text


def test_the_words_go_with_the_add_on(addon, language):
    addon.unregister()
    assert words.said("24 Points") == "24 Points"
    addon.register()
    assert words.said("24 Points") != "24 Points"
