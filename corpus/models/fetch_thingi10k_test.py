#!/usr/bin/env python3
"""Fetching from a local stand-in of Thingi10K's home: redirects, cut-offs, 429, wrong bytes, resumption."""
import csv
import hashlib
import http.server
import os
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

SCRIPT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "fetch_thingi10k")
INDEX = ("ID,Thing ID,License,Link,Closed\n"
         "101,1,Public Domain,https://x/a.stl,TRUE\n"
         "102,1,GNU - GPL,https://x/b.OBJ,TRUE\n"
         "103,2,\"CC, by\",https://x/c.stl,FALSE\n")
FILES = {"101.stl": b"a" * 300_000, "102.obj": b"v 0 0 0\n" * 1000, "103.stl": b"c" * 50_000}


class Home(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"

    def log_message(self, *_):
        pass

    def do_GET(self):
        server = self.server
        server.seen.append((self.path, self.headers.get("Range"), time.monotonic()))
        if self.path == "/metadata/input_summary.csv":
            return self.answer(200, INDEX.encode())
        name = os.path.basename(self.path)
        if name not in FILES:
            return self.answer(404, b"")
        if server.refusals.get(name, 0) > 0:
            server.refusals[name] -= 1
            return self.answer(429, b"slowly", {"Retry-After": "0"})
        digest = hashlib.sha256(FILES[name]).hexdigest()
        if self.path.startswith("/raw_meshes/"):  # as the real one: elsewhere, and the checksum is told here
            return self.answer(302, b"", {"Location": server.elsewhere.get(name, server.base + "/store/" + name), "X-Linked-ETag": '"%s"' % digest})
        body = server.corrupt.get(name, FILES[name])
        start = 0
        wanted = re.fullmatch(r"bytes=(\d+)-", self.headers.get("Range") or "")
        if wanted:
            start = int(wanted.group(1))
            if start >= len(body):
                return self.answer(416, b"")
        if server.cuts.get(name, 0) > 0:
            server.cuts[name] -= 1
            self.send_response(206 if start else 200)
            self.send_header("Content-Length", str(len(body) - start))
            self.end_headers()
            self.wfile.write(body[start:start + 100_000])
            self.wfile.flush()
            self.close_connection = True
            return None
        if server.raw.get(name):
            self.wfile.write(server.raw[name].pop(0))
            self.wfile.flush()
            self.close_connection = True
            return None
        if server.slow:
            time.sleep(server.slow)
        return self.answer(206 if start else 200, body[start:])

    def answer(self, code, body, headers=None):
        try:
            self.send_response(code)
            for key, value in (headers or {}).items():
                self.send_header(key, value)
            self.send_header("Content-Length", str(len(body)))
            self.end_headers()
            self.wfile.write(body)
        except OSError:
            pass  # the other side was killed


class FetchTest(unittest.TestCase):
    def setUp(self):
        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Home)
        self.server.base = "http://127.0.0.1:%d" % self.server.server_address[1]
        self.server.seen, self.server.refusals, self.server.cuts, self.server.corrupt = [], {}, {}, {}
        self.server.raw, self.server.elsewhere = {}, {}
        self.server.slow = 0
        threading.Thread(target=self.server.serve_forever, daemon=True).start()
        self.folder = tempfile.TemporaryDirectory()

    def tearDown(self):
        self.server.shutdown()
        self.server.server_close()
        self.folder.cleanup()

    def command(self, *arguments):
        return [sys.executable, SCRIPT, "-o", self.folder.name, "--home", self.server.base, "--rate", "500",
                "--backoff", "0.01", *arguments]

    def fetch(self, *arguments):
        return subprocess.run(self.command(*arguments), capture_output=True, text=True, timeout=60)

    def bytes_of(self, name):
        with open(os.path.join(self.folder.name, name), "rb") as stream:
            return stream.read()

    def requests_of(self, name):
        return [s for s in self.server.seen if s[0].endswith("/store/" + name)]

    def assert_complete(self):
        for name, body in FILES.items():
            self.assertEqual(self.bytes_of(name), body, name)
        with open(os.path.join(self.folder.name, "fetched.csv"), newline="", encoding="utf-8") as stream:
            rows = {row["file"]: row for row in csv.DictReader(stream)}
        self.assertEqual(set(rows), set(FILES))
        for name, body in FILES.items():
            self.assertEqual(rows[name]["sha256"], hashlib.sha256(body).hexdigest())
        self.assertEqual(rows["103.stl"]["licence"], "CC, by")
        self.assertFalse([f for f in os.listdir(self.folder.name) if f.endswith(".part")])

    def test_all_and_then_nothing_again(self):
        self.assertEqual(self.fetch().returncode, 0)
        self.assert_complete()
        before = len(self.server.seen)
        again = self.fetch()
        self.assertEqual((again.returncode, len(self.server.seen)), (0, before))
        self.assertIn("0 of them new", again.stdout)

    def test_only_those_asked_for(self):
        self.assertEqual(self.fetch("101").returncode, 0)
        self.assertTrue(os.path.exists(os.path.join(self.folder.name, "101.stl")))
        self.assertFalse(os.path.exists(os.path.join(self.folder.name, "102.obj")))

    def test_patience(self):
        self.server.refusals = {"101.stl": 3, "103.stl": 1}
        self.assertEqual(self.fetch().returncode, 0)
        self.assert_complete()

    def test_a_cut_off_file_is_continued(self):
        self.server.cuts = {"101.stl": 2}
        self.assertEqual(self.fetch().returncode, 0)
        self.assert_complete()
        ranges = [r for _, r, _ in self.requests_of("101.stl")]
        self.assertEqual(ranges[0], None)
        self.assertTrue(all(ranges[1:]), ranges)  # never from the start again

    def test_answers_that_are_no_http(self):
        # Each is another exception of http.client: RemoteDisconnected, BadStatusLine, UnknownProtocol, LineTooLong,
        # too many headers, IncompleteRead of a chunk, a chunk without a size, a length that is none.
        chunked = b"HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n"
        answers = [b"", b"nonsense\r\n\r\n", b"HTTP/9.9 200 OK\r\n\r\n", b"HTTP/1.1 200 OK\r\nX: " + b"x" * 70000 + b"\r\n\r\n",
                   b"HTTP/1.1 200 OK\r\n" + b"".join(b"H%d: 1\r\n" % i for i in range(200)) + b"\r\n",
                   chunked + b"100\r\nabc", chunked + b"zz\r\nabc\r\n"]
        for answer in answers:
            with self.subTest(answer=answer[:40]):
                self.tearDown()
                self.setUp()
                self.server.raw = {"101.stl": [answer] * 2}
                run = self.fetch()
                self.assertEqual(run.returncode, 0, run.stderr)
                self.assert_complete()

    def test_a_server_that_never_speaks_http(self):
        self.server.raw = {"102.obj": [b"nonsense\r\n\r\n"] * 100}
        run = self.fetch("--retries", "2")
        self.assertEqual(run.returncode, 1, run.stderr)
        self.assertIn("102.obj: BadStatusLine", run.stderr)
        self.assertNotIn("Traceback", run.stderr)
        self.assertTrue(os.path.exists(os.path.join(self.folder.name, "103.stl")))
        self.server.raw = {}
        self.assertEqual(self.fetch().returncode, 0)
        self.assert_complete()

    def test_redirects_without_https_are_refused(self):
        for place in ("http://localhost.example.invalid/x", "http://127.0.0.1.example.invalid/x", "http://localhost@example.invalid/x",
                      "http://example.invalid/x"):
            self.server.elsewhere = {"101.stl": place}
            run = self.fetch("--retries", "0", "101")
            self.assertEqual(run.returncode, 1)
            self.assertIn("without https", run.stderr)

    def test_wrong_bytes_are_refused(self):
        self.server.corrupt = {"102.obj": b"something else"}
        run = self.fetch()
        self.assertEqual(run.returncode, 1)
        self.assertIn("102.obj: checksum", run.stderr)
        self.assertFalse(os.path.exists(os.path.join(self.folder.name, "102.obj")))
        self.server.corrupt = {}
        self.assertEqual(self.fetch().returncode, 0)
        self.assert_complete()

    def test_pinned_checksums(self):
        pins = os.path.join(self.folder.name, "pins.csv")
        with open(pins, "w", encoding="utf-8") as stream:
            stream.write("id,sha256\n101,%s\n" % ("0" * 64))
        self.assertEqual(self.fetch("--checksums", pins, "101").returncode, 1)

    def test_a_damaged_file_is_fetched_again(self):
        self.assertEqual(self.fetch().returncode, 0)
        with open(os.path.join(self.folder.name, "103.stl"), "wb") as stream:
            stream.write(b"damaged")
        self.assertEqual(self.fetch().returncode, 0)
        self.assert_complete()

    def test_killed_and_resumed(self):
        self.server.slow = 0.3
        child = subprocess.Popen(self.command(), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        for _ in range(500):
            if self.requests_of("102.obj"):
                break
            time.sleep(0.01)
        child.send_signal(signal.SIGKILL)
        child.wait()
        self.assertEqual(len(self.requests_of("101.stl")), 1)
        self.server.slow = 0
        self.assertEqual(self.fetch().returncode, 0)
        self.assert_complete()
        self.assertEqual(len(self.requests_of("101.stl")), 1)

    def test_missing_ids_are_named(self):
        run = self.fetch("999")
        self.assertEqual(run.returncode, 1)
        self.assertIn("999.stl", run.stderr)
        self.assertEqual(self.fetch("x1").returncode, 1)

    def test_the_rate_is_kept(self):
        self.assertEqual(self.fetch("--rate", "5").returncode, 0)
        times = [t for path, _, t in self.server.seen if not path.startswith("/store/")]
        self.assertGreaterEqual(times[-1] - times[0], 0.2 * (len(times) - 1) - 0.05)


if __name__ == "__main__":
    unittest.main()
