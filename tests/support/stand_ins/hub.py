"""A hub on loopback, as the client of the Hugging Face hub expects one: repositories in memory, files in commits."""

import base64
import hashlib
import json
import re
import threading
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

TOKEN = "hf_test"


class Hub:
    """Files of each repository, by kind and name.

    `answers` replaces the content that is sent for a file, `announced` its size in the list of files; `sent` holds the
    files that were sent.
    """

    def __init__(self):
        self.files = {}
        self.visibility = {}
        self.commits = 0
        self.answers = {}
        self.announced = {}
        self.sent = []
        self.url = ""

    def sha(self, key):
        return hashlib.sha1(repr(sorted(self.files[key].items())).encode()).hexdigest()


def handler(hub):
    class Handler(BaseHTTPRequestHandler):
        protocol_version = "HTTP/1.1"

        def log_message(self, *_):
            pass

        def reply(self, code, body=b"", headers=()):
            data = body if isinstance(body, bytes) else json.dumps(body).encode()
            self.send_response(code)
            for name, value in (*headers, ("Content-Length", str(len(data)))):
                self.send_header(name, value)
            self.end_headers()
            if self.command != "HEAD":
                self.wfile.write(data)

        def missing(self):
            self.reply(404, {"error": "Repository not found"}, [("X-Error-Code", "RepoNotFound")])

        def do_POST(self):
            data = self.rfile.read(int(self.headers.get("Content-Length", 0)))
            if self.headers.get("Authorization") != f"Bearer {TOKEN}" and not self.path.endswith("validate-yaml"):
                return self.reply(401, {"error": "Invalid username or password."})
            if self.path.endswith("/validate-yaml"):
                return self.reply(200, {"errors": [], "warnings": []})
            if self.path.endswith("/repos/create"):
                asked = json.loads(data)
                key = (asked.get("type", "model"), f"{asked.get('organization') or 'user'}/{asked['name']}")
                self.files.setdefault(key, {})
                hub.visibility.setdefault(key, asked.get("visibility"))
                return self.reply(200, {"url": f"{hub.url}/{key[1]}", "name": key[1]})
            kind, name, action = re.fullmatch(r"/api/(\w+)s/([^/]+/[^/]+)/(preupload|commit)/main", self.path).groups()
            if action == "preupload":
                files = [each["path"] for each in json.loads(data)["files"]]
                modes = [{"path": path, "uploadMode": "regular", "shouldIgnore": False} for path in files]
                return self.reply(200, {"files": modes})
            for line in map(json.loads, data.splitlines()):
                if line["key"] == "file":
                    self.files[kind, name][line["value"]["path"]] = base64.b64decode(line["value"]["content"])
            hub.commits += 1
            return self.reply(200, {"commitUrl": f"{hub.url}/{name}/commit/{hub.commits}", "commitOid": "0" * 40})

        def do_GET(self):
            path = self.path.partition("?")[0]
            if found := re.fullmatch(r"/api/(\w+)s/([^/]+/[^/]+)/(revision|tree)/(\w+)", path):
                kind, name, what, revision = found.groups()
                if (kind, name) not in self.files:
                    return self.missing()
                sha = hub.sha((kind, name))
                if revision not in ("main", sha):
                    return self.reply(404, {"error": "Revision Not Found"}, [("X-Error-Code", "RevisionNotFound")])
                files = self.files[kind, name]
                if what == "revision":
                    return self.reply(200, {"id": name, "sha": sha, "siblings": [{"rfilename": p} for p in files]})
                sizes = {path: len(content) for path, content in files.items()} | hub.announced
                rows = [{"type": "file", "path": p, "size": sizes[p], "oid": _oid(c)} for p, c in files.items()]
                return self.reply(200, rows)
            found = re.fullmatch(r"/(datasets/)?([^/]+/[^/]+)/resolve/(\w+)/(.+)", path)
            if not found:
                return self.missing()
            dataset, name, _, file = found.groups()
            key = ("dataset" if dataset else "model", name)
            content = hub.answers.get(file, self.files[key][file])
            hub.sent += [file] if self.command == "GET" else []
            headers = [("ETag", f'"{_oid(content)}"'), ("X-Repo-Commit", hub.sha(key))]
            return self.reply(200, content, headers)

        do_HEAD = do_GET  # noqa: N815

        @property
        def files(self):
            return hub.files

    return Handler


def _oid(content):
    return hashlib.sha1(b"blob %d\0" % len(content) + content).hexdigest()


@contextmanager
def running_hub():
    """The hub; `url` is its address."""
    hub = Hub()
    server = ThreadingHTTPServer(("127.0.0.1", 0), handler(hub))
    hub.url = f"http://127.0.0.1:{server.server_port}"
    thread = threading.Thread(target=server.serve_forever, daemon=True)
    thread.start()
    try:
        yield hub
    finally:
        server.shutdown()
        server.server_close()
