# SPDX-License-Identifier: GPL-3.0-or-later
"""A Flamenco Manager (https://flamenco.blender.org, its API version 3): whether one answers, and jobs for it.

Its address is that of Flamenco's own add-on, or the environment variable FLAMENCO_MANAGER. It is asked in the
background, so that no panel waits for a network.
"""

import json
import os
import platform
import threading
import time
import urllib.error
import urllib.request

import bpy

ADDRESS = "FLAMENCO_MANAGER"
JOB_TYPE = "holomorph-uv-maps"  # the name of the script that the manager has, without its suffix
PRIORITY = 50  # Flamenco's own default
ASK_SECONDS = 30.0  # between two questions whether it is there
ANSWER_SECONDS = 3.0
_known = {"asked": -ASK_SECONDS, "answers": ""}


class Unreachable(Exception):
    """The manager does not answer, or does not take the job; the text is one sentence."""


def address():
    """The address of the manager, "" where none is set up."""
    for name, entry in bpy.context.preferences.addons.items():
        if name.rpartition(".")[2] == "flamenco" and getattr(entry.preferences, "manager_url", ""):
            return entry.preferences.manager_url.rstrip("/")
    return os.environ.get(ADDRESS, "").rstrip("/")


def reachable():
    """The address of the manager that answered last, "" where none did; asks again now and then, without waiting."""
    if not (address() and getattr(bpy.app, "online_access", True)):
        return ""
    if time.monotonic() - _known["asked"] >= ASK_SECONDS:
        _known["asked"] = time.monotonic()
        threading.Thread(target=_ask, args=[address()], daemon=True).start()
    return _known["answers"] if _known["answers"] == address() else ""


def submit(manager, name, settings):
    """Submits a job of our type, and returns its id. @throws Unreachable"""
    job = {
        "name": name,
        "type": JOB_TYPE,
        "priority": PRIORITY,
        "settings": settings,
        "metadata": {},
        "submitter_platform": platform.system().lower(),
    }
    return _answer(f"{manager}/api/v3/jobs", json.dumps(job).encode())["id"]


def _ask(manager):
    try:
        _answer(f"{manager}/api/v3/version")
        _known["answers"] = manager
    except Unreachable:
        _known["answers"] = ""


def _answer(url, content=None):
    """The answer of the manager, parsed. @throws Unreachable"""
    if not url.startswith(("http://", "https://")):
        raise Unreachable(f"{url} is not the address of a Flamenco Manager")
    request = urllib.request.Request(url, content, {"Content-Type": "application/json"})
    try:
        with urllib.request.urlopen(request, timeout=ANSWER_SECONDS) as response:
            return json.load(response)
    except urllib.error.HTTPError as error:
        said = error.read().decode(errors="replace").strip()
        raise Unreachable(f"the Flamenco Manager refused the job: {said or error.reason}") from error
    except (OSError, ValueError) as error:
        raise Unreachable(f"the Flamenco Manager at {url} does not answer: {error}") from error
