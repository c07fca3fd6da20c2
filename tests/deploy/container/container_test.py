"""The Dockerfile's promises, by the programs that the image holds: container_test.py SOURCE MENISCUSD MENISCUS."""

import array
import json
import os
import random
import re
import subprocess
import sys
import tempfile
import time
import unittest
import urllib.request
from pathlib import Path

from running import Running, Server

SOURCE, MENISCUSD, MENISCUS = (Path(path).resolve() for path in sys.argv[1:4])
del sys.argv[1:4]
DOCKERFILE = (SOURCE / "deploy/container/Dockerfile").read_text()
CONFIGURATION = SOURCE / "deploy/container/meniscus.conf"


def run(*command, **variables):
    done = subprocess.run(
        [str(word) for word in command],
        env={**os.environ, **variables},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        encoding="utf-8",
        timeout=60,
        check=False,
    )
    return done.returncode, done.stdout


class HealthCheck(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def serve(self, *arguments, **variables):
        server = Server(MENISCUSD, *arguments, env={**os.environ, **variables})
        self.addCleanup(server.stop)
        return server

    def check(self, address, **variables):
        program, *arguments = json.loads(re.search(r"^HEALTHCHECK .*CMD (\[.*\])$", DOCKERFILE, re.M)[1])
        self.assertEqual(program, "/usr/bin/meniscus")
        self.assertEqual(arguments[-2:], ["--server", "127.0.0.1:50051"])
        return run(MENISCUS, *arguments[:-1], address, **variables)

    def test_passes_while_the_server_serves(self):
        self.assertEqual(self.check(self.serve().address)[0], 0)

    def test_needs_no_token(self):
        tokens = self.folder / "tokens"
        tokens.write_text(f"admin someone {'0123456789abcdef' * 4}\n")
        tokens.chmod(0o600)
        server = self.serve("--tokens", tokens)
        self.assertEqual(self.check(server.address)[0], 0)
        self.assertNotEqual(run(MENISCUS, "info", "--server", server.address)[0], 0)

    def test_speaks_tls_by_the_servers_own_environment(self):
        certificate, key = self.folder / "server.pem", self.folder / "server.key"
        subprocess.run(
            [
                "openssl",
                "req",
                "-x509",
                "-newkey",
                "ec",
                "-pkeyopt",
                "ec_paramgen_curve:P-256",
                "-nodes",
                "-days",
                "1",
                "-subj",
                "/CN=water.test",
                "-addext",
                "subjectAltName=DNS:water.test",
                "-keyout",
                key,
                "-out",
                certificate,
            ],
            stderr=subprocess.DEVNULL,
            check=True,
        )
        key.chmod(0o600)
        variables = {
            "MENISCUS_TLS_CERT": str(certificate),
            "MENISCUS_TLS_KEY": str(key),
            "MENISCUS_SERVER_CA": str(certificate),
            "MENISCUS_SERVER_NAME": "water.test",
        }
        server = self.serve(**variables)
        self.assertEqual(self.check(server.address, **variables)[0], 0)
        self.assertNotEqual(self.check(server.address, **{**variables, "MENISCUS_SERVER_NAME": "oil.test"})[0], 0)
        self.assertNotEqual(self.check(server.address)[0], 0)

    def test_fails_while_the_server_shuts_down(self):
        server = self.serve("--shutdown-grace", "60")
        source = random.Random(1)
        noise = array.array("f", (source.uniform(0.0, 20.0) for _ in range(3 * 8000)))  # whose surface takes long
        with open(self.folder / "noise.bin", "wb") as file:
            noise.tofile(file)
        client = Running(
            [
                MENISCUS,
                "reconstruct",
                self.folder / "noise.bin",
                "-o",
                self.folder / "noise.bricks",
                "--particle-radius",
                "0.5",
                "--cell-size",
                "0.25",
                "--mode",
                "uniform",
                "--reconnect",
                "0",
                "--server",
                server.address,
            ]
        )
        self.addCleanup(client.stop)
        self.wait_for_upload(server)
        server.process.terminate()
        server.wait_for("finishing the frames in flight")
        code, output = self.check(server.address)
        while code == 0:  # the line comes just before the state
            code, output = self.check(server.address)
        self.assertEqual(code, 1, output)
        self.assertIn("shutting down", output)

    def wait_for_upload(self, server):
        guard = time.monotonic() + 60
        uploaded = 0
        while not uploaded and time.monotonic() < guard:
            with urllib.request.urlopen(f"http://{server.http}/metrics", timeout=30) as answer:
                uploaded = float(re.search(r"^meniscus_upload_bytes_total (\S+)$", answer.read().decode(), re.M)[1])
        self.assertTrue(uploaded)

    def test_fails_without_a_server(self):
        self.assertNotEqual(self.check("127.0.0.1:1")[0], 0)


class Image(unittest.TestCase):
    def test_has_the_projects_version(self):
        project = re.search(r"project\(Meniscus VERSION (\S+)", (SOURCE / "CMakeLists.txt").read_text())[1]
        self.assertEqual(re.search(r"^ARG VERSION=(\S+)$", DOCKERFILE, re.M)[1], project)

    def test_listens_where_it_says(self):
        ports = re.search(r"^EXPOSE (.*)$", DOCKERFILE, re.M)[1].split()
        self.assertEqual(re.findall(r"^(?:listen|http) = 0\.0\.0\.0:(\d+)$", CONFIGURATION.read_text(), re.M), ports)

    def test_opens_to_the_network_only_when_told_how(self):
        code, output = run(MENISCUSD, "--config", CONFIGURATION, "--check-config")
        self.assertEqual(code, 2, output)
        self.assertIn("--listen 0.0.0.0:50051 can be reached from other machines, without TLS", output)
        self.assertEqual(run(MENISCUSD, "--config", CONFIGURATION, "--check-config", MENISCUS_INSECURE="true")[0], 0)

    def test_environment_comes_before_its_file(self):
        _, output = run(MENISCUSD, "--config", CONFIGURATION, "--print-config", MENISCUS_LISTEN="127.0.0.1:1")
        self.assertIn("\nlisten = 127.0.0.1:1\n", output)

    def test_both_targets_end_alike(self):
        for target in ("cpu", "cuda"):
            self.assertRegex(
                DOCKERFILE, rf"(?m)^FROM settings AS {target}\n(?:ENV .*\n)?COPY --from=build-{target} /image/ /$"
            )


class BillOfMaterials(unittest.TestCase):
    def test_names_every_part_with_its_version(self):
        with tempfile.TemporaryDirectory() as folder:
            licenses = Path(folder)
            (licenses / "libc6").mkdir()
            (licenses / "libc6/copyright").touch()
            (licenses / "npm/@some/thing").mkdir(parents=True)
            (licenses / "npm/@some/thing/package.json").write_text(
                '{"name": "@some/thing", "version": "1.2.3", "license": "MIT"}'
            )
            code, output = run(SOURCE / "deploy/sbom", licenses, "9.8.7")
        self.assertEqual(code, 0, output)
        bill = json.loads(output)
        self.assertEqual(
            (bill["spdxVersion"], bill["dataLicense"], bill["SPDXID"]), ("SPDX-2.3", "CC0-1.0", "SPDXRef-DOCUMENT")
        )
        self.assertRegex(bill["creationInfo"]["created"], r"^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ$")
        self.assertTrue(bill["documentNamespace"] and bill["creationInfo"]["creators"])
        packages = {package["name"]: package for package in bill["packages"]}
        self.assertEqual(set(packages), {"meniscus", "libc6", "@some/thing"})
        self.assertEqual(
            (packages["meniscus"]["versionInfo"], packages["@some/thing"]["versionInfo"]), ("9.8.7", "1.2.3")
        )
        installed = subprocess.run(
            ["dpkg-query", "-W", "-f=${Version}\n", "libc6"], stdout=subprocess.PIPE, encoding="utf-8", check=True
        ).stdout
        self.assertEqual(packages["libc6"]["versionInfo"], installed.splitlines()[0])
        self.assertEqual(packages["@some/thing"]["externalRefs"][0]["referenceLocator"], "pkg:npm/%40some/thing@1.2.3")
        for package in bill["packages"]:
            self.assertRegex(package["SPDXID"], r"^SPDXRef-[A-Za-z0-9.-]+$")
            self.assertEqual((package["downloadLocation"], package["filesAnalyzed"]), ("NOASSERTION", False))
        related = {(r["spdxElementId"], r["relationshipType"], r["relatedSpdxElement"]) for r in bill["relationships"]}
        program = packages["meniscus"]["SPDXID"]
        self.assertEqual(
            related,
            {("SPDXRef-DOCUMENT", "DESCRIBES", program)}
            | {(program, "CONTAINS", packages[name]["SPDXID"]) for name in ("libc6", "@some/thing")},
        )


if __name__ == "__main__":
    unittest.main()
