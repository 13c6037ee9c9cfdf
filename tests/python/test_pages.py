# SPDX-License-Identifier: Apache-2.0
"""docs/python.md and the notebook do what they say; docs/cpp-library.md shows what is tested."""
import contextlib
import io
import os
import re
import unittest
import warnings

import run_notebook
import takes


class Pages(unittest.TestCase):
    def test_python_page(self):
        page = (takes.ROOT / "docs/python.md").read_text("utf-8")
        names, told = {"__name__": "page"}, io.StringIO()
        with contextlib.chdir(takes.ROOT), contextlib.redirect_stdout(told), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            for number, block in enumerate(re.findall(r"```python\n(.*?)```", page, re.S)):
                if "help(" not in block:
                    exec(compile(block, f"docs/python.md, block {number}", "exec"), names)
        self.assertEqual((takes.ROOT / "docs/python_events.svg").read_text("utf-8"), names["events"].svg())
        said = told.getvalue()
        for words in ("transporting  right_hand   milk", "contact.grammar:10:17: warning", "s: picking_up of", "lift_rise",
                      "divide milliseconds by 1000"):
            self.assertIn(words, said)
        warned = re.search(r"```text\n(.*?)```", page, re.S)[1].splitlines()  # ".." stands for what is left out
        self.assertEqual(len(warned), said.count("warning:"))
        for line in warned:
            self.assertIn(line.strip("."), said)
        first = re.search(r"```python\n(.*?)```", page, re.S)[1]
        self.assertLessEqual(len([line for line in first.splitlines() if line.strip()]), 12)

    def test_cpp_page_is_the_consumer(self):
        page = (takes.ROOT / "docs/cpp-library.md").read_text("utf-8")
        folder = takes.ROOT / "tests/install/node"
        self.assertIn("```cpp\n" + "\n".join((folder / "node.cc").read_text().split("\n")[2:]) + "```", page)
        self.assertIn("```cmake\n" + (folder / "CMakeLists.txt").read_text() + "```", page)

    def test_notebook(self):
        os.environ["MPLBACKEND"] = "agg"
        outputs = run_notebook.run(takes.ROOT / "examples/segment_my_arrays.ipynb")
        kinds = [kind for cell in outputs for one in cell for kind in one.get("data", {})]
        self.assertIn("text/html", kinds)
        self.assertGreaterEqual(kinds.count("image/png"), 2)


if __name__ == "__main__":
    unittest.main()
