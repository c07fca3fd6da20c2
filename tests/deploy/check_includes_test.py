"""The findings of check-includes in trees with planted includes: check_includes_test.py CHECK-INCLUDES."""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

CHECK = sys.argv.pop()


def findings(files):
    """Lines that the check prints for a tree of these files; its exit code must agree with them."""
    with tempfile.TemporaryDirectory() as root:
        for path, text in files.items():
            file = Path(root) / path
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text)
        result = subprocess.run([CHECK, root], capture_output=True, text=True)
    lines = result.stdout.splitlines()
    assert result.stderr == "" and result.returncode == (1 if lines else 0), result
    return lines


class CheckIncludes(unittest.TestCase):
    def test_finds_an_include_through_an_include_directory(self):
        files = {
            "client/lib/page.cpp": '#include <array>\n\n#include "web/files.hpp"\n',
            "client/lib/CMakeLists.txt": "target_include_directories(page PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})\n",
            "server/web/files.hpp": "",
            "server/CMakeLists.txt": "target_include_directories(server PUBLIC ${CMAKE_CURRENT_SOURCE_DIR})\n",
        }
        self.assertEqual(
            findings(files),
            ["client/lib/page.cpp:3: #include web/files.hpp (server/web/files.hpp): client lies beside server"],
        )

    def test_finds_a_relative_include(self):
        files = {"proto/conversion/a.hpp": '#include "../../client/b.hpp"\n', "client/b.hpp": ""}
        self.assertEqual(
            findings(files),
            ["proto/conversion/a.hpp:1: #include ../../client/b.hpp (client/b.hpp): proto lies below client"],
        )

    def test_takes_a_generated_header_for_its_proto(self):
        files = {
            "core/mesh.cu": '#include "meniscus/v1/mesh.pb.h"\n#  include <meniscus/v1/mesh.grpc.pb.h>\n',
            "proto/meniscus/v1/mesh.proto": "",
        }
        lines = findings(files)
        self.assertEqual([line.split(": ")[0] for line in lines], ["core/mesh.cu:1", "core/mesh.cu:2"])
        for line in lines:
            self.assertIn("(proto/meniscus/v1/mesh.proto): core lies below proto", line)

    def test_finds_an_engine_that_includes_a_step(self):
        files = {
            "core/engine/cuda/cell.hpp": '#include "steps/place/place.hpp"\n',
            "core/steps/place/place.hpp": '#include "engine/cuda/state.hpp"\n',
            "core/engine/cuda/state.hpp": "",
            "core/CMakeLists.txt": "target_include_directories(core PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})\n",
        }
        self.assertEqual(
            findings(files),
            [
                "core/engine/cuda/cell.hpp:1: #include steps/place/place.hpp (core/steps/place/place.hpp): "
                "core/engine lies below core/steps"
            ],
        )

    def test_finds_an_include_between_the_folders_of_a_room(self):
        files = {
            "server/sessions/session/session.cpp": '#include "metrics/metrics.hpp"\n',
            "server/web/call.cpp": '#include "metrics/metrics.hpp"\n',
            "server/metrics/metrics.hpp": "",
            "server/CMakeLists.txt": "target_include_directories(server\n"
            "  PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/server>)\n",
        }
        (line,) = findings(files)
        self.assertIn("server/sessions/session/session.cpp:1: ", line)
        self.assertIn(": server/sessions lies below server/metrics", line)

    def test_prefers_the_file_of_the_same_room(self):
        files = {
            "client/cli/main.cpp": '#include "web/files.hpp"\n',
            "client/web/files.hpp": "",
            "client/CMakeLists.txt": "target_include_directories(cli PUBLIC ${CMAKE_CURRENT_SOURCE_DIR})\n",
            "server/web/files.hpp": "",
            "server/CMakeLists.txt": "target_include_directories(server PUBLIC ${CMAKE_CURRENT_SOURCE_DIR})\n",
        }
        self.assertEqual(findings(files), [])

    def test_finds_paths_and_targets_of_another_room_in_cmake_files(self):
        files = {
            "client/lib/CMakeLists.txt": "add_library(library page.cpp)\n"
            "target_include_directories(library PRIVATE ${PROJECT_SOURCE_DIR}/server)  # ${PROJECT_SOURCE_DIR}/server\n"
            "target_link_libraries(library PRIVATE sessions)\n"
            "target_sources(library PRIVATE ../../server/process/log.cpp)\n",
            "server/CMakeLists.txt": "add_library(sessions STATIC\n  log.cpp)\n"
            "target_link_libraries(sessions PRIVATE viewer)\n",
        }
        lines = findings(files)
        self.assertEqual([line.split(": ")[0] for line in lines], [f"client/lib/CMakeLists.txt:{i}" for i in (2, 3, 4)])
        for line in lines:
            self.assertIn(": client lies beside server", line)

    def test_lets_tests_include_anything(self):
        files = {"tests/core/a.cpp": '#include "../../server/b.hpp"\n', "server/b.hpp": '#include "c.hpp"\n'}
        self.assertEqual(findings(files), [])


unittest.main()
