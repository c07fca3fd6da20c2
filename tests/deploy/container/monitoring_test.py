"""The shipped Prometheus and Grafana files against a real server and a real Prometheus.

Usage: monitoring_test.py DEPLOY MENISCUSD MENISCUS"""

import json
import re
import socket
import subprocess
import sys
import tempfile
import time
import unittest
import urllib.error
import urllib.parse
import urllib.request
from pathlib import Path

from running import Running, Server

DEPLOY, MENISCUSD, MENISCUS = (Path(path).resolve() for path in sys.argv[1:4])
del sys.argv[1:4]
CONFIGURATION = DEPLOY / "container/prometheus/prometheus.yml"
DASHBOARD = DEPLOY / "container/grafana/dashboards/meniscus.json"
PROVISIONING = DEPLOY / "container/grafana/provisioning"
NAME = re.compile(r"\b(?:meniscus|process|grpc_server)_[a-z_]+\b|\bup\b")
SELECTOR = re.compile(r"\b((?:meniscus|process|grpc_server)_[a-z_]+)\{([^}]*)\}")


def free_port():
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return listener.getsockname()[1]


def dashboard():
    return json.loads(DASHBOARD.read_text())


def dashboard_queries():
    """By their panel's title, as Grafana would send them."""
    for panel in dashboard()["panels"]:
        for target in panel["targets"]:
            yield panel["title"], target["expr"].replace("$instance", ".*").replace("$__rate_interval", "1m")


class Files(unittest.TestCase):
    def promtool(self, *arguments):
        done = subprocess.run(
            ["promtool", *map(str, arguments)],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            encoding="utf-8",
            check=False,
        )
        self.assertEqual(done.returncode, 0, done.stdout)

    def test_configuration_and_rules_are_valid(self):
        self.promtool("check", "config", CONFIGURATION)

    def test_alerts_fire_where_they_should_and_only_there(self):
        self.promtool("test", "rules", Path(__file__).with_name("alerts_test.yaml"))

    def test_every_alert_is_tested(self):
        alerts = set(re.findall(r"- alert: (\w+)", (CONFIGURATION.with_name("alerts.yaml")).read_text()))
        tested = set(re.findall(r'alertname="(\w+)"', Path(__file__).with_name("alerts_test.yaml").read_text()))
        self.assertEqual(alerts, tested)

    def test_grafana_finds_dashboard_and_source(self):
        source = (PROVISIONING / "datasources/prometheus.yaml").read_text()
        asked = re.findall(r'"datasource": {"type": "prometheus", "uid": "(\w+)"}', DASHBOARD.read_text())
        self.assertEqual(len(asked), len(dashboard()["panels"]) + 1)  # and the choice of the server
        self.assertEqual(set(asked), set(re.findall(r"uid: (\w+)", source)))
        folder = re.search(r"path: (\S+)", (PROVISIONING / "dashboards/meniscus.yaml").read_text())[1]
        compose = (DEPLOY / "container/docker-compose.yaml").read_text()
        self.assertIn(f"./grafana/dashboards:{folder}:ro", compose)
        self.assertIn(f"{folder}/{DASHBOARD.name}", compose)

    def test_panels_have_numbers_of_their_own_and_do_not_overlap(self):
        panels = dashboard()["panels"]
        self.assertEqual(len({panel["id"] for panel in panels}), len(panels))
        cells = [
            (x, y)
            for panel in panels
            for g in [panel["gridPos"]]
            for x in range(g["x"], g["x"] + g["w"])
            for y in range(g["y"], g["y"] + g["h"])
        ]
        self.assertEqual(len(set(cells)), len(cells))
        self.assertLess(max(x for x, _ in cells), 24)


class WithAServer(unittest.TestCase):
    """That records, reconstructs, is watched, and has refused a call."""

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        server = Server(MENISCUSD, "--record", folder.name + "/recordings")
        cls.addClassCleanup(server.stop)
        session = "5d1f0a52-8c1e-4b7e-9a44-2f60c2f6a3d1"
        subprocess.run(
            [MENISCUS, "watch", session, "--server", server.address, "-o", folder.name],
            stderr=subprocess.DEVNULL,
            check=False,
        )
        simulator = Running(
            [
                MENISCUS,
                "simulate",
                "--particles",
                "300",
                "--frames",
                "1000000",
                "--server",
                server.address,
                "--session",
                session,
            ]
        )
        cls.addClassCleanup(simulator.stop)
        simulator.wait_for("^frame 1:")
        watcher = Running([MENISCUS, "watch", session, "--server", server.address, "-o", folder.name + "/watched"])
        cls.addClassCleanup(watcher.stop)
        with urllib.request.urlopen(f"http://{server.http}/metrics", timeout=30) as answer:
            cls.metrics = answer.read().decode()

        port = free_port()
        cls.api = f"http://127.0.0.1:{port}/api/v1/"
        text = CONFIGURATION.read_text()
        text = text.replace("server:9464", server.http).replace("_interval: 5s", "_interval: 100ms")
        text = text.replace("alerts.yaml", str(CONFIGURATION.with_name("alerts.yaml")))
        Path(folder.name, "prometheus.yml").write_text(text)
        prometheus = Running(
            [
                "prometheus",
                f"--config.file={folder.name}/prometheus.yml",
                f"--storage.tsdb.path={folder.name}/data",
                f"--web.listen-address=127.0.0.1:{port}",
                "--log.level=error",
            ]
        )
        cls.addClassCleanup(prometheus.stop)
        guard = time.monotonic() + 60
        while not cls.has_scraped() and time.monotonic() < guard:
            time.sleep(0.05)

    @classmethod
    def ask(cls, path, **query):
        with urllib.request.urlopen(cls.api + path + "?" + urllib.parse.urlencode(query), timeout=30) as answer:
            return json.load(answer)["data"]

    @classmethod
    def has_scraped(cls):
        try:
            return cls.ask("query", query="count_over_time(meniscus_frames_total[1m]) > 2")["result"]
        except urllib.error.URLError:  # it does not listen yet
            return False

    def expressions(self):
        rules = [rule for group in self.ask("rules")["groups"] for rule in group["rules"]]
        self.assertTrue(rules)
        return [(rule["name"], rule["query"]) for rule in rules] + list(dashboard_queries())

    def test_every_metric_that_is_asked_for_is_exported(self):
        exported = set(re.findall(r"^([a-z_]+)[ {]", self.metrics, re.M)) | {"up"}
        for where, expression in self.expressions():
            asked = set(NAME.findall(expression))
            self.assertTrue(asked, where)
            self.assertLessEqual(asked, exported, where)

    def test_every_label_that_is_asked_for_is_exported(self):
        for where, expression in self.expressions():
            for name, matchers in SELECTOR.findall(expression):
                for label, value in re.findall(r'(\w+)="([^"]*)"', matchers):
                    if label not in ("job", "grpc_code"):  # of Prometheus' own; exported once such a call has ended
                        self.assertRegex(self.metrics, rf'(?m)^{name}{{[^}}]*{label}="{value}"', where)

    def test_every_panel_shows_something(self):
        for title, query in dashboard_queries():
            query = query.replace("< +Inf", "")  # without TLS no certificate expires, ever
            self.assertTrue(self.ask("query", query=query)["result"], f"{title}: {query}")

    def test_rules_are_loaded_and_can_be_evaluated(self):
        for group in self.ask("rules")["groups"]:
            for rule in group["rules"]:
                self.assertEqual(rule.get("lastError", ""), "", rule["name"])


if __name__ == "__main__":
    unittest.main()
