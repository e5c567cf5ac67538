"""Jobs for a Flamenco Manager: a server that speaks the part of its interface that is used."""

import json
import threading
import time
from http.server import BaseHTTPRequestHandler, HTTPServer

import bpy
import pytest
from loaded_addon import module
from repository import ROOT

flamenco = module("operators.flamenco")
SECONDS = 60


class Manager(BaseHTTPRequestHandler):
    """https://flamenco.blender.org/development/openapi/: getVersion and submitJob."""

    def do_GET(self):
        self._say(200 if self.path == "/api/v3/version" else 404, {"name": "Flamenco", "version": "3.7"})

    def do_POST(self):
        job = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
        self.server.jobs.append((self.path, job))
        known = job["type"] == "holomorph-uv-maps" and self.server.has_type
        self._say(200 if known else 400, {"id": "42"} if known else {"code": 400, "message": "job type unknown"})

    def _say(self, status, content):
        self.send_response(status)
        self.end_headers()
        self.wfile.write(json.dumps(content).encode())

    def log_message(self, *_):
        pass


@pytest.fixture
def manager(monkeypatch):
    if not getattr(bpy.app, "online_access", True):
        pytest.skip("this Blender is offline")
    server = HTTPServer(("127.0.0.1", 0), Manager)
    server.jobs, server.has_type = [], True
    threading.Thread(target=server.serve_forever, daemon=True).start()
    monkeypatch.setenv(flamenco.ADDRESS, f"http://127.0.0.1:{server.server_port}/")
    monkeypatch.setattr(flamenco, "_known", {"asked": -flamenco.ASK_SECONDS, "answers": ""})
    yield server
    server.shutdown()
    server.server_close()


def wait_for_answer():
    end = time.monotonic() + SECONDS
    while not flamenco.reachable():
        assert time.monotonic() < end
        time.sleep(0.01)


def test_nothing_is_offered_without_a_manager(monkeypatch):
    monkeypatch.delenv(flamenco.ADDRESS, raising=False)
    assert flamenco.reachable() == ""
    assert not bpy.ops.wm.holomorphic_submit.poll()


def test_a_job_is_submitted(manager, tmp_path):
    wait_for_answer()
    done = bpy.ops.wm.holomorphic_submit(sources=str(tmp_path), output=str(tmp_path / "maps"), shares=3)
    assert done == {"FINISHED"}
    ((path, job),) = manager.jobs
    assert path == "/api/v3/jobs"
    assert job["settings"] == {"sources": str(tmp_path), "output": str(tmp_path / "maps"), "recipe": "", "shares": 3}
    script = (ROOT / "addon" / f"{job['type']}.js").read_text(encoding="utf-8")
    assert all(f'key: "{name}"' in script for name in job["settings"])
    assert {"name", "type", "priority", "submitter_platform"} <= job.keys()


def test_what_the_manager_refuses_is_said(manager, tmp_path):
    wait_for_answer()
    manager.has_type = False
    with pytest.raises(RuntimeError, match="refused the job.*job type unknown"):
        bpy.ops.wm.holomorphic_submit(sources=str(tmp_path), output=str(tmp_path / "maps"))
    with pytest.raises(RuntimeError, match="Save the file first"):
        bpy.ops.wm.holomorphic_submit(output=str(tmp_path / "maps"))
