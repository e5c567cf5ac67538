# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel in other languages: Blender translates labels that it knows, and takes ours where it knows none."""

import re

import bpy

from . import french, german

LANGUAGES = {"de_DE": german.WORDS, "fr_FR": french.WORDS}
CONTEXTS = (
    "*",
    "Operator",
    "Holomorph",
)  # of labels and of buttons; of our sentences, which no word of Blender's meets
BETWEEN = re.compile(r"(, |: |; |\. )")
NUMBER = re.compile(r"\d[\d.,]*")


def said(text):
    """A sentence in the user's language, phrase by phrase, with its numbers; phrases without a translation stay."""
    return "".join(part if BETWEEN.fullmatch(part) else _phrase(part) for part in BETWEEN.split(text))


def _phrase(text):
    key = NUMBER.sub("{}", text)
    for known in (key, key[:1].lower() + key[1:]):
        found = bpy.app.translations.pgettext(known, CONTEXTS[-1])
        if found != known:
            made = found.format(*NUMBER.findall(text))
            return made if known == key else made[:1].upper() + made[1:]
    return text


def register():
    tables = {
        language: {(context, key): text for key, text in words.items() for context in CONTEXTS}
        for language, words in LANGUAGES.items()
    }
    bpy.app.translations.register(__name__, tables)


def unregister():
    bpy.app.translations.unregister(__name__)
