"""The certificates of deploy/dev-certificate, by a server and clients that use them.

Usage: dev_certificate_test.py DEV-CERTIFICATE MENISCUSD MENISCUS"""

import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.append(str(Path(__file__).with_name("container")))
from running import Server  # noqa: E402

SCRIPT, MENISCUSD, MENISCUS = (Path(path).resolve() for path in sys.argv[1:4])
del sys.argv[1:4]


def run(*command):
    done = subprocess.run(
        [str(word) for word in command],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        encoding="utf-8",
        timeout=60,
        check=False,
    )
    return done.returncode, done.stdout


class Certificates(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name, "tls")

    def make(self, *arguments):
        code, text = run(SCRIPT, *arguments)
        self.assertEqual(code, 0, text)
        return text

    def refused(self, *arguments):
        code, text = run(SCRIPT, *arguments)
        self.assertEqual(code, 2, text)
        self.assertEqual(text.count("\n"), 1, text)
        return text

    def file(self, name):
        return self.folder / name

    def contents(self):
        return {path.name: path.read_bytes() for path in self.folder.iterdir()}

    def serve(self, *arguments):
        server = Server(
            MENISCUSD, "--tls-cert", self.file("server.pem"), "--tls-key", self.file("server.key"), *arguments
        )
        self.addCleanup(server.stop)
        return server.address.rpartition(":")[2]

    def info(self, address, *arguments):
        return run(MENISCUS, "info", "--server", address, *arguments)

    def test_connect_clients_that_trust_the_ca_under_each_default_name(self):
        self.make(self.folder)
        port = self.serve()
        for host in ("localhost", "127.0.0.1"):
            code, text = self.info(f"{host}:{port}", "--tls-ca", self.file("ca.pem"))
            self.assertEqual(code, 0, text)
        wrong = self.info(f"127.0.0.1:{port}", "--tls-ca", self.file("ca.pem"), "--tls-server-name", "example.org")
        self.assertNotEqual(wrong[0], 0)

    def test_connect_under_the_names_that_are_given_alone(self):
        self.make(self.folder, "example.org", "*.example.net", "192.0.2.7", "2001:db8::1")
        shown = run("openssl", "x509", "-in", self.file("server.pem"), "-noout", "-ext", "subjectAltName")[1]
        self.assertIn(
            "DNS:example.org, DNS:*.example.net, IP Address:192.0.2.7, IP Address:2001:DB8:0:0:0:0:0:1", shown
        )
        port = self.serve()
        ca = ("--tls-ca", self.file("ca.pem"))
        self.assertEqual(self.info(f"127.0.0.1:{port}", *ca, "--tls-server-name", "example.org")[0], 0)
        self.assertNotEqual(self.info(f"127.0.0.1:{port}", *ca)[0], 0)

    def test_connect_clients_with_their_own_where_the_server_asks_for_one(self):
        self.make("--client", "ada", self.folder)
        self.make("--client", "ben", self.folder)  # by the same CA, later
        port = self.serve("--tls-client-ca", self.file("ca.pem"))
        ca = ("--tls-ca", self.file("ca.pem"))
        for client in ("ada", "ben"):
            own = ("--tls-cert", self.file(client + ".pem"), "--tls-key", self.file(client + ".key"))
            code, text = self.info(f"localhost:{port}", *ca, *own)
            self.assertEqual(code, 0, text)
        self.assertNotEqual(self.info(f"localhost:{port}", *ca)[0], 0)
        server = ("--tls-cert", self.file("server.pem"), "--tls-key", self.file("server.key"))
        self.assertNotEqual(self.info(f"localhost:{port}", *ca, *server)[0], 0, "a server's is no client's")

    def test_have_keys_for_this_user_alone(self):
        self.make("--client", "ada", self.folder)
        modes = {path.name: path.stat().st_mode & 0o777 for path in self.folder.iterdir()}
        names = ("ca", "server", "ada")
        expected = {name + ending: mode for name in names for ending, mode in ((".pem", 0o644), (".key", 0o600))}
        self.assertEqual(modes, expected)
        self.assertEqual(self.folder.stat().st_mode & 0o777, 0o700)

    def test_replace_none_unless_told(self):
        self.make("--client", "ada", self.folder)
        before = self.contents()
        for arguments in ((self.folder,), ("--client", "ada", self.folder), (self.folder, "example.org")):
            text = self.refused(*arguments)
            self.assertRegex(text, r"tls/\w+\.pem is there; --force replaces it, another folder keeps it")
            self.assertEqual(self.contents(), before)
        self.make("--client", "ben", self.folder)
        self.assertEqual({**self.contents(), **before}, self.contents(), "a further client changes nothing")
        self.make("--force", self.folder)
        after = self.contents()
        changed = {name for name in before if before[name] != after[name]}
        self.assertEqual(changed, {"server.pem", "server.key"}, "the CA stays, and clients that trust it")
        self.file("ca.key").unlink()
        self.assertIn("a CA without ca.key", self.refused("--force", self.folder))

    def test_are_valid_for_as_long_as_is_said(self):
        self.make("--days", "3", self.folder)
        for name in ("ca.pem", "server.pem"):
            for seconds, code in ((2 * 86400, 0), (4 * 86400, 1)):
                checked = run("openssl", "x509", "-in", self.file(name), "-noout", "-checkend", seconds)
                self.assertEqual(checked[0], code, name)

    def test_are_not_made_of_wrong_words(self):
        usage = "usage: deploy/dev-certificate "
        self.assertIn(usage, self.refused())
        self.assertIn(f"there is no flag --nonsense; {usage}", self.refused("--nonsense", self.folder))
        self.assertIn("--client needs a value", self.refused(self.folder, "--client"))
        for days in ("0", "-1", "many", "10000", "1.5"):
            self.assertIn(f"--days is '{days}', must be 1 to 9999", self.refused("--days", days, self.folder))
        for host in ("a,DNS:evil.example", "a b", "exa/mple", "", "a\nb", "a.", "x" * 254):
            self.assertEqual(run(SCRIPT, self.folder, host)[0], 2, host)
        for client in ("../evil", "a/b", "", "ca", "server", "a b", ".hidden"):
            self.assertEqual(run(SCRIPT, "--client", client, self.folder)[0], 2, client)
        self.assertNotEqual(run(SCRIPT, self.folder, "999.1.1.1")[0], 0)
        left = [path.name for path in self.folder.iterdir()] if self.folder.exists() else []
        self.assertEqual(left, [], "nothing half done stays")


class Document(unittest.TestCase):
    def test_names_the_files_that_are_made(self):
        text = (SCRIPT.parent.parent / "server/README.md").read_text()
        section = re.search(r"```sh\n(deploy/dev-certificate .*?)```", text, re.DOTALL)[1]
        made = subprocess.run([SCRIPT, "--help"], stdout=subprocess.PIPE, encoding="utf-8", check=True).stdout
        for flag in re.findall(r"--\w+", section.splitlines()[0]):
            self.assertIn(flag, made)
        for name in ("server.pem", "server.key", "ca.pem"):
            self.assertIn("tls/" + name, section)


if __name__ == "__main__":
    unittest.main()
