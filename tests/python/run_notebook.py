# SPDX-License-Identifier: Apache-2.0
"""Runs the cells of a notebook without Jupyter, which is large: `run_notebook.py FILE` keeps the outputs in it."""
import ast
import base64
import contextlib
import io
import json
import pathlib
import sys
import warnings


def shown(value):
    """An output as Jupyter keeps it."""
    data = {"text/plain": repr(value)}
    for kind, name in (("text/html", "_repr_html_"), ("image/svg+xml", "_repr_svg_")):
        if kind not in data and (text := getattr(value, name, lambda: None)()) and "text/html" not in data:
            data[kind] = text
    return {"output_type": "display_data", "metadata": {}, "data": data}


def figures():
    """matplotlib's, which are closed."""
    if "matplotlib.pyplot" not in sys.modules:
        return []
    plt, outputs = sys.modules["matplotlib.pyplot"], []
    for number in plt.get_fignums():
        picture = io.BytesIO()
        plt.figure(number).savefig(picture, format="png", dpi=80, bbox_inches="tight", metadata={"Software": None})
        outputs.append({"output_type": "display_data", "metadata": {},
                        "data": {"image/png": base64.b64encode(picture.getvalue()).decode()}})
    plt.close("all")
    return outputs


def run(file):
    """The outputs of each code cell. A cell that fails ends it."""
    file = pathlib.Path(file)
    notebook = json.loads(file.read_text("utf-8"))
    names, outputs = {"__name__": "__main__"}, []
    with contextlib.chdir(file.parent), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for number, cell in enumerate(cell for cell in notebook["cells"] if cell["cell_type"] == "code"):
            tree, told = ast.parse("".join(cell["source"]), f"{file.name}, cell {number + 1}"), io.StringIO()
            last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
            value = None
            with contextlib.redirect_stdout(told):
                exec(compile(tree, f"{file.name}, cell {number + 1}", "exec"), names)
                if last is not None:
                    value = eval(compile(ast.Expression(last.value), f"{file.name}, cell {number + 1}", "eval"), names)
            drawn = figures()
            is_shown = value is not None and not drawn
            text = [{"output_type": "stream", "name": "stdout", "text": told.getvalue()}] if told.getvalue() else []
            outputs.append(text + ([shown(value)] if is_shown else []) + drawn)
    return outputs


if __name__ == "__main__":
    path = pathlib.Path(sys.argv[1])
    kept, made = json.loads(path.read_text("utf-8")), run(path)
    for number, cell in enumerate(cell for cell in kept["cells"] if cell["cell_type"] == "code"):
        cell["outputs"], cell["execution_count"] = made[number], number + 1
    path.write_text(json.dumps(kept, indent=1, ensure_ascii=False) + "\n", "utf-8")
