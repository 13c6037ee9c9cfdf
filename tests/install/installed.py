#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Installs a build below a temporary folder, away from the checkout, and uses it as a stranger does.

usage: installed.py BUILD_FOLDER
"""
import gzip
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

BUILD = pathlib.Path(sys.argv.pop(1) if len(sys.argv) > 1 else "build/test").resolve()
HERE = pathlib.Path(__file__).resolve().parent
PORTABLE = {"sin", "cos", "tan", "asin", "acos", "atan", "atan2", "exp", "exp2", "log", "log2", "log10", "cbrt",
            "pow", "hypot", "sincos"}


def run(*words, cwd, code=0, **variables):
    environment = {key: value for key, value in os.environ.items() if not key.startswith("PREHEND_")}
    done = subprocess.run([str(word) for word in words], cwd=cwd, env=environment | variables, text=True,
                          capture_output=True, timeout=300)
    assert done.returncode == code, f"{words}: {done.returncode}\n{done.stdout}\n{done.stderr}"
    return done.stdout


class Installed(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.prefix = pathlib.Path(cls.folder.name) / "prefix"
        cls.elsewhere = pathlib.Path(cls.folder.name) / "elsewhere"
        cls.elsewhere.mkdir()
        run("cmake", "--install", BUILD, "--prefix", cls.prefix, cwd=cls.elsewhere)
        cls.prehend = cls.prefix / "bin/prehend"

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def manual(self):
        return gzip.decompress((self.prefix / "share/man/man1/prehend.1.gz").read_bytes()).decode()

    def test_plays_what_ships(self):
        self.assertIn("picking_up", run(self.prehend, "run", "milk_carton_wrap", cwd=self.elsewhere))

    def test_checks_a_project_of_ones_own(self):
        run(self.prehend, "new", "--project", "kitchen", cwd=self.elsewhere)
        project = self.elsewhere / "kitchen"
        self.assertIn("0 passed, 0 failed", run(self.prehend, "check", cwd=project, code=5))

    def test_pages_and_their_data_are_installed(self):
        share = self.prefix / "share/prehend"
        self.assertTrue((share / "docs/scenario-format.md").is_file())
        run(self.prehend, "import", "docs/motion_capture/poses.csv", "--map", "docs/motion_capture/bodies.yaml", "-o",
            self.elsewhere / "milk.jsonl", cwd=share)
        self.assertIn("transporting", run(self.prehend, "episode", "resegment", "milk.jsonl", cwd=self.elsewhere))

    def test_writes_nothing_into_what_ships(self):
        before = sorted(self.prefix.rglob("*"))
        run(self.prehend, "check", "slide/four_centimetres_are_a_slide", cwd=self.elsewhere)
        self.assertEqual(before, sorted(self.prefix.rglob("*")))

        for words in (["accept", "milk_carton_wrap", "--reason", "x"], ["scenario", "rename", "milk_carton_wrap", "x"]):
            run(self.prehend, *words, cwd=self.elsewhere, code=2, CI="")
        self.assertEqual(before, sorted(self.prefix.rglob("*")))

    def test_answers_questions(self):
        run(self.prehend, "episode", "knowledge", "milk_carton_wrap", "-o", "kb", cwd=self.elsewhere)
        goal = "entity(Act, [an, action, [type, 'Grasping']]), occurs(Act, [Start, End])"
        self.assertIn("Start", run(self.prehend, "episode", "ask", "kb", goal, cwd=self.elsewhere))

    def test_says_its_version_in_all_places(self):
        version = re.match(r"prehend (\d+\.\d+\.\d+)", run(self.prehend, "--version", cwd=self.elsewhere))[1]
        self.assertIn(f'PREHEND_VERSION "{version}"', (self.prefix / "include/prehend/version.h").read_text())
        self.assertIn(f'"prehend {version}"', self.manual())

    def test_completes_commands_and_scenarios(self):
        script = self.prefix / "share/bash-completion/completions/prehend"
        complete = f"""source {script}; PATH={self.prehend.parent}:$PATH
            words() {{ COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _prehend; echo "${{COMPREPLY[*]}}"; }}
            words prehend ch; words prehend episode re; words prehend check --rep"""
        said = run("bash", "-c", complete, cwd=self.elsewhere).splitlines()
        self.assertEqual(said[:3], ["check", "resegment", "--repeat --replay --report"])

    def test_the_manual_names_every_command(self):
        page = self.manual()
        for command in ("check", "episode query", "grammar sweep", "scenario schema"):
            self.assertIn(f".SS prehend {command}\n", page)

    def test_archives_leave_the_c_library_alone(self):
        for archive in self.prefix.rglob("*.a"):
            names = {line.split()[-1] for line in run("nm", archive, cwd=self.elsewhere).splitlines() if line.strip()}
            self.assertFalse(names & PORTABLE, archive)

    def test_a_stranger_links_the_grammar_library(self):
        build = self.elsewhere / "consumer"
        run("cmake", "-S", HERE / "consumer", "-B", build, f"-DCMAKE_PREFIX_PATH={self.prefix}", cwd=self.elsewhere)
        run("cmake", "--build", build, cwd=self.elsewhere)
        said = run(build / "watch", cwd=self.elsewhere)
        self.assertIn("near(hand, cup) 81..120", said)
        self.assertTrue("U sin@GLIBC" in run("nm", "-D", build / "watch", cwd=self.elsewhere))
        # Eigen's types of a consumer that is compiled for newer processors lie as the library's.
        run("cmake", "-S", HERE / "consumer", "-B", build, "-DCMAKE_CXX_FLAGS=-march=haswell", cwd=self.elsewhere)
        run("cmake", "--build", build, cwd=self.elsewhere)
        if "avx2" in pathlib.Path("/proc/cpuinfo").read_text():
            self.assertEqual(said, run(build / "watch", cwd=self.elsewhere))

    def test_headers_include_what_is_installed(self):
        include = self.prefix / "include"
        lines = [f'#include "{header.relative_to(include)}"' for header in sorted(include.rglob("*.h"))]
        self.assertGreater(len(lines), 10)
        subprocess.run(["c++", "-std=c++20", "-fsyntax-only", "-x", "c++", "-I", include, "-I", include / "prehend", "-isystem",
                        "/usr/include/eigen3", "-"], input="\n".join(lines), text=True, check=True, cwd=self.elsewhere)

    def test_a_stranger_links_the_episode_library(self):
        build, node = self.elsewhere / "build", self.elsewhere / "node"
        shutil.copytree(HERE / "node", node)
        run("cmake", "-S", node, "-B", build, f"-DCMAKE_PREFIX_PATH={self.prefix}", cwd=self.elsewhere)
        run("cmake", "--build", build, cwd=self.elsewhere)
        self.assertEqual(run(build / "node", cwd=node), "near(right_hand, cup) 1.50..2.51 s\n")
        (node / "near.grammar").write_text((node / "near.grammar").read_text().replace("distance", "distence"))
        with self.assertRaisesRegex(AssertionError, r"near.grammar:6:9: error(.|\n)*did you mean 'distance'"):
            run(build / "node", cwd=node)

    def test_the_episode_library_has_no_engine_and_exports_its_headers(self):
        library = next(self.prefix.rglob("libprehend_episode.so"))
        self.assertNotRegex(run("ldd", library, cwd=self.elsewhere), "(?i)bullet|box2d|osmesa|libGL")
        exported = run("nm", "-D", "-C", "--defined-only", library, cwd=self.elsewhere)
        self.assertIn("prehend::OpenEpisodes", exported)
        self.assertNotRegex(exported, r" [TWBD] (fmt|YAML|pugi|prehend::[a-z]+)::")

    def test_python_imports_and_plays(self):
        for module in self.prefix.rglob("_prehend.*.so"):  # where it was built
            code = "import prehend; print(prehend.__version__, *prehend.open('milk_carton_wrap').events['event'])"
            said = run("/usr/bin/python3", "-c", code, cwd=self.elsewhere, PYTHONPATH=str(module.parents[1]),
                       PATH=f"{self.prehend.parent}:/usr/bin:/bin")
            self.assertIn("transporting", said)


if __name__ == "__main__":
    unittest.main()
